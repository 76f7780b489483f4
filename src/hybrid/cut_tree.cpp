#include "hybrid/cut_tree.hpp"

#include <algorithm>

#include "host/vector_operations.hpp"

namespace flaunay::hybrid {

using host::Arena;
using host::Buffer;

CutTrees::CutTrees(host::Runtime& runtime, const std::vector<SetToCut>& sets, std::size_t samples_per_leaf)
    : runtime_(runtime) {
  std::size_t leaves = 0;
  for (const SetToCut& set : sets) leaves += std::size_t{1} << set.depth;
  int chunk_depth = 0;
  while (samples_per_leaf << (chunk_depth + 1) <= runtime.tuning().chunk(leaves * samples_per_leaf)) {
    ++chunk_depth;
  }
  std::vector<SampledTree> trees;
  std::vector<cl_int> first_chunks;
  for (const SetToCut& set : sets) {
    const std::size_t samples = samples_per_leaf << set.depth;
    const int above = std::max(0, set.depth - chunk_depth);
    trees.push_back({static_cast<cl_int>(samples_), static_cast<cl_int>(samples),
                     static_cast<cl_int>(samples_per_leaf), static_cast<cl_int>(samples >> above),
                     static_cast<cl_int>(nodes_), static_cast<cl_int>(set.first_point),
                     static_cast<cl_int>(set.points)});
    first_chunks.push_back(static_cast<cl_int>(chunks_));
    samples_ += samples;
    nodes_ += std::size_t{1} << set.depth;
    chunks_ += std::size_t{1} << above;
    levels_above_chunks_ = std::max(levels_above_chunks_, above);
  }
  trees_ = runtime.arena().allocate<SampledTree>(trees.size());
  first_chunks_ = runtime.arena().allocate<cl_int>(first_chunks.size());
  runtime.write_kept(trees_, std::move(trees));
  runtime.write_kept(first_chunks_, std::move(first_chunks));
}

std::size_t CutTrees::bytes(std::size_t trees, std::size_t leaves, std::size_t samples_per_leaf) {
  // A sample, its index, its places in the orders of both axes, and what these are sorted in, which is more
  // than what follows takes.
  constexpr std::size_t kBySample = sizeof(cl_double2) + 3 * sizeof(cl_int) + 4 * sizeof(cl_uint2);
  // The counts of chunks, which have a leaf at least, with the sums of their scan.
  constexpr std::size_t kByLeaf = 2 * sizeof(cl_uint);
  return trees * (sizeof(SampledTree) + sizeof(cl_int)) + leaves * (samples_per_leaf * kBySample + kByLeaf);
}

// A kernel of chunks, with so many work-items for each. blocks.cl includes cut_tree.cl: a program of its own
// would take a CPU's compiler longer than all trees of a million points.
template <typename... Arguments>
void CutTrees::launch(const char* kernel, std::size_t items_per_chunk, const Arguments&... arguments) const {
  const std::size_t items = items_per_chunk * chunks_;
  runtime_.launch("blocks", kernel, items, runtime_.tuning().chunk_group, static_cast<cl_int>(items),
                  static_cast<cl_int>(trees_.size()), first_chunks_, trees_, arguments...);
}

CutTrees::Samples CutTrees::draw(const Buffer<cl_double>& input) const {
  const Samples samples{runtime_.arena().allocate<cl_double2>(samples_),
                        runtime_.arena().allocate<cl_int>(samples_)};
  launch("draw_samples", 1, input, samples.points, samples.indices);
  return samples;
}

// Sorts each chunk along both axes, into order.
void CutTrees::sort_chunks(const Buffer<cl_double2>& samples, const Buffer<cl_int>& order) const {
  Arena::Scope scope(runtime_.arena());
  const auto elements = runtime_.arena().allocate<cl_uint2>(2 * samples_);
  const auto spare = runtime_.arena().allocate<cl_uint2>(2 * samples_);
  launch("sort_chunks", 2, static_cast<cl_int>(samples_), samples, elements, spare, order);
}

Buffer<cl_int> CutTrees::cut(const Buffer<cl_double2>& samples, const Buffer<CutNode>& nodes) const {
  const auto all = static_cast<cl_int>(samples_);
  auto order = runtime_.arena().allocate<cl_int>(2 * samples_);
  Arena::Scope scope(runtime_.arena());
  sort_chunks(samples, order);
  auto other = runtime_.arena().allocate<cl_int>(2 * samples_);
  for (cl_int doublings = 0; doublings < levels_above_chunks_; ++doublings) {
    launch("merge_runs", 2, all, doublings, samples, order, other);
    std::swap(order, other);
  }
  const auto counts = runtime_.arena().allocate<cl_uint>(chunks_ + 1);
  for (cl_int level = 0; level < levels_above_chunks_; ++level) {
    launch("count_low", 1, all, level, samples, order, nodes, counts);
    host::exclusive_scan(runtime_, counts, chunks_, counts);
    launch("split_chunks", 1, all, level, samples, counts, order, other);
    std::swap(order, other);
  }
  // As many merges as levels: order is what was allocated outside of the scope.
  launch("cut_chunks", 1, all, samples, order, other, nodes);
  return order;
}

}  // namespace flaunay::hybrid
