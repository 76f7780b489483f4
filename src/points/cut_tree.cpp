#include "points/cut_tree.hpp"

#include <algorithm>

#include "host/launch/vector_operations.hpp"
#include "points/limits.h"
#include "points/records.h"
#include "tuning/tuning.hpp"

namespace flaunay::points {

using host::Arena;
using host::Buffer;

CutTrees::CutTrees(host::Runtime& runtime, const std::vector<SetToCut>& sets, std::size_t samples_per_leaf)
    : runtime_(runtime),
      samples_per_leaf_(samples_per_leaf),
      by_tiles_(runtime.sizes().tile_group != 0 &&
                samples_per_leaf <= runtime.sizes().local_bytes / kernel::LOCAL_BYTES_PER_SAMPLE) {
  std::size_t leaves = 0;
  for (const SetToCut& set : sets) leaves += std::size_t{1} << set.depth;
  const std::size_t most =
      by_tiles_ ? tuning_of(runtime).sample_tile : runtime.sizes().chunk(leaves * samples_per_leaf);
  int chunk_depth = 0;
  while (samples_per_leaf << (chunk_depth + 1) <= most) ++chunk_depth;
  std::vector<kernel::sampled_tree> trees;
  std::vector<cl_int> first_chunks, first_samples;
  for (const SetToCut& set : sets) {
    const std::size_t samples = samples_per_leaf << set.depth;
    const int above = std::max(0, set.depth - chunk_depth);
    trees.push_back({static_cast<cl_int>(samples_), static_cast<cl_int>(samples),
                     static_cast<cl_int>(samples_per_leaf), static_cast<cl_int>(samples >> above),
                     static_cast<cl_int>(nodes_), static_cast<cl_int>(set.first_point),
                     static_cast<cl_int>(set.points)});
    depths_.push_back(set.depth);
    first_chunks.push_back(static_cast<cl_int>(chunks_));
    if (by_tiles_) first_samples.push_back(static_cast<cl_int>(samples_));
    samples_ += samples;
    nodes_ += std::size_t{1} << set.depth;
    chunks_ += std::size_t{1} << above;
    levels_above_chunks_ = std::max(levels_above_chunks_, above);
  }
  trees_ = runtime.arena().allocate<kernel::sampled_tree>(trees.size());
  first_chunks_ = runtime.arena().allocate<cl_int>(first_chunks.size());
  runtime.write_kept(trees_, std::move(trees));
  runtime.write_kept(first_chunks_, std::move(first_chunks));
  first_samples_ = runtime.upload(runtime.arena(), std::move(first_samples));
}

// Launches a kernel with this many work-items per chunk.
template <typename Kernel>
void CutTrees::launch(std::size_t items_per_chunk, const Kernel& kernel) const {
  const std::size_t items = items_per_chunk * chunks_;
  runtime_.note_elements(samples_ / chunks_);
  runtime_.launch(items, runtime_.sizes().chunk_group, items, kernel);
}

CutTrees::Samples CutTrees::draw(const Buffer<cl_double>& input) const {
  const Samples samples{runtime_.arena().allocate<cl_double2>(samples_),
                        runtime_.arena().allocate<cl_int>(samples_)};
  if (by_tiles_) {
    draw_each(input, samples);
    return samples;
  }
  launch(1, kernels::draw_samples{.tree_count = trees_.size(),
                                  .first_chunks = first_chunks_,
                                  .trees = trees_,
                                  .input = input,
                                  .samples = samples.points,
                                  .indices = samples.indices});
  return samples;
}

// Sorts the samples of each chunk along both axes, into `order`.
void CutTrees::sort_chunks(const Buffer<cl_double2>& samples, const Buffer<cl_int>& order) const {
  Arena::Scope scope(runtime_.arena());
  const auto elements = runtime_.arena().allocate<cl_ulong>(2 * samples_);
  const auto spare = runtime_.arena().allocate<cl_ulong>(2 * samples_);
  launch(2, kernels::sort_chunks{
                .sampled_chunks = chunks_of(samples), .elements = elements, .spare = spare, .order = order});
}

kernels::sampled_chunks CutTrees::chunks_of(const Buffer<cl_double2>& samples) const {
  return {.tree_count = trees_.size(),
          .first_chunks = first_chunks_,
          .trees = trees_,
          .all_samples = samples_,
          .samples = samples};
}

Buffer<cl_int> CutTrees::cut(const Buffer<cl_double2>& samples, const Buffer<kernel::cut_node>& nodes) const {
  if (by_tiles_) return cut_tiles(samples, nodes);
  auto order = runtime_.arena().allocate<cl_int>(2 * samples_);
  Arena::Scope scope(runtime_.arena());
  sort_chunks(samples, order);
  auto other = runtime_.arena().allocate<cl_int>(2 * samples_);
  for (int doublings = 0; doublings < levels_above_chunks_; ++doublings) {
    launch(2, kernels::merge_runs{
                  .sampled_chunks = chunks_of(samples), .doublings = doublings, .from = order, .to = other});
    std::swap(order, other);
  }
  const auto counts = runtime_.arena().allocate<cl_uint>(chunks_ + 1);
  for (int level = 0; level < levels_above_chunks_; ++level) {
    launch(1, kernels::count_low{.sampled_chunks = chunks_of(samples),
                                 .level = level,
                                 .order = order,
                                 .nodes = nodes,
                                 .counts = counts});
    host::exclusive_scan(runtime_, counts, chunks_, counts);
    launch(1, kernels::split_chunks{.sampled_chunks = chunks_of(samples),
                                    .level = level,
                                    .scanned = counts,
                                    .from = order,
                                    .to = other});
    std::swap(order, other);
  }
  // There were as many merges as splits, so `order` is the array that was allocated outside of the scope.
  launch(1, kernels::cut_chunks{
                .sampled_chunks = chunks_of(samples), .order = order, .spare = other, .nodes = nodes});
  return order;
}

}  // namespace flaunay::points
