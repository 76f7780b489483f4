// Cut trees on devices with many lanes: a work-group per tile of samples, few launches.
#include <algorithm>

#include "host/runtime.hpp"
#include "launchers/points/cut_tree_tiles.cl.hpp"
#include "launchers/points/gaps.cl.hpp"
#include "operations/limits.h"
#include "points/cut_tree.hpp"
#include "points/limits.h"
#include "points/records.h"
#include "tuning/tuning.hpp"

namespace flaunay::points {

using host::Arena;
using host::Buffer;

// Launches a kernel with this many work-groups per tile.
template <typename Kernel>
void CutTrees::launch_tiles(std::size_t groups_per_tile, const Kernel& kernel) const {
  const std::size_t group = runtime_.sizes().tile_group;
  runtime_.launch(groups_per_tile * chunks_ * group, group, kernel);
}

void CutTrees::draw_each(const Buffer<cl_double>& input, const Samples& samples) const {
  runtime_.map(samples_, kernels::draw_each_sample{.tree_count = trees_.size(),
                                                   .first_samples = first_samples_,
                                                   .trees = trees_,
                                                   .input = input,
                                                   .samples = samples.points,
                                                   .indices = samples.indices});
}

CutTrees::Sorted CutTrees::sort_tiles(const Buffer<cl_double2>& samples) const {
  Arena& arena = runtime_.arena();
  Sorted all{arena.allocate<cl_int>(2 * samples_), arena.allocate<cl_int>(2 * samples_),
             arena.allocate<cl_int>(2 * samples_)};
  launch_tiles(
      2, kernels::sort_tiles{
             .tiles = chunks_, .sampled_chunks = chunks_of(samples), .order = all.order, .ranks = all.ranks});
  for (int widenings = 0; widenings * kernel::MERGED_RUNS_BITS < levels_above_chunks_; ++widenings) {
    runtime_.map(2 * samples_, kernels::merge_tiles{.tree_count = trees_.size(),
                                                    .first_samples = first_samples_,
                                                    .trees = trees_,
                                                    .all_samples = samples_,
                                                    .widenings = widenings,
                                                    .samples = samples,
                                                    .from = all.order,
                                                    .to = all.spare,
                                                    .ranks = all.ranks});
    std::swap(all.order, all.spare);
  }
  return all;
}

Buffer<cl_int> CutTrees::cut_tiles(const Buffer<cl_double2>& samples,
                                   const Buffer<kernel::cut_node>& nodes) const {
  Arena& arena = runtime_.arena();
  auto order = arena.allocate<cl_int>(2 * samples_);
  Arena::Scope scope(arena);
  const auto [sorted, spare, ranks] = sort_tiles(samples);
  const auto counts = arena.allocate<cl_uint>(chunks_);
  auto from = sorted, to = spare, other = order;
  for (int level = 0; level < levels_above_chunks_; ++level) {
    launch_tiles(1, kernels::count_tiles{.tiles = chunks_,
                                         .sampled_chunks = chunks_of(samples),
                                         .level = level,
                                         .order = from,
                                         .ranks = ranks,
                                         .nodes = nodes,
                                         .counts = counts});
    launch_tiles(1, kernels::split_tiles{.tiles = chunks_,
                                         .sampled_chunks = chunks_of(samples),
                                         .level = level,
                                         .counts = counts,
                                         .from = from,
                                         .ranks = ranks,
                                         .to = to});
    from = to;
    std::swap(to, other);
  }
  launch_tiles(1, kernels::cut_tiles{.tiles = chunks_,
                                     .sampled_chunks = chunks_of(samples),
                                     .sorted = sorted,
                                     .ranks = ranks,
                                     .from = from,
                                     .nodes = nodes,
                                     .order = order});
  return order;
}

void CutTrees::cut_at_gaps(const Buffer<cl_double2>& samples, const Buffer<kernel::cut_node>& nodes) const {
  Arena& arena = runtime_.arena();
  Arena::Scope scope(arena);
  const std::size_t capacity = tuning_of(runtime_).sample_tile, group = runtime_.sizes().tile_group;
  int levels = 1;
  while (levels < kernel::GAP_LEVELS && samples_per_leaf_ << (levels + 1) <= capacity) ++levels;
  const auto ranges = arena.allocate<cl_int2>(nodes_);
  auto to = arena.allocate<cl_double2>(samples_), other = arena.allocate<cl_double2>(samples_),
       from = samples;
  const int depth = *std::max_element(depths_.begin(), depths_.end());
  for (int level = 0; level < depth; level += levels) {
    std::vector<cl_int> first_groups;
    std::size_t groups = 0;
    for (const int tree_depth : depths_) {
      first_groups.push_back(static_cast<cl_int>(groups));
      if (tree_depth > level) groups += std::size_t{1} << level;
    }
    const auto device_first_groups = runtime_.upload(arena, std::move(first_groups));
    runtime_.launch(groups * group, group,
                    kernels::cut_at_gaps{.groups = groups,
                                         .level = level,
                                         .levels = levels,
                                         .capacity = capacity,
                                         .tree_count = trees_.size(),
                                         .first_groups = device_first_groups,
                                         .trees = trees_,
                                         .from = from,
                                         .to = to,
                                         .ranges = ranges,
                                         .nodes = nodes});
    if (level == 0) continue;
    from = to;
    std::swap(to, other);
  }
}

}  // namespace flaunay::points
