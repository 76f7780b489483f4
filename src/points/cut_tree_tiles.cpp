// Cut trees on devices with many lanes: a work-group per tile of samples, few launches.
#include <algorithm>

#include "host/runtime.hpp"
#include "launchers/points/cut_tree_tiles.cl.hpp"
#include "points/cut_tree.hpp"
#include "shared/limits.h"

namespace flaunay::points {

using host::Arena;
using host::Buffer;

// Launches a kernel with so many work-groups per tile.
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

Buffer<cl_int> CutTrees::cut_tiles(const Buffer<cl_double2>& samples,
                                   const Buffer<kernel::cut_node>& nodes) const {
  Arena& arena = runtime_.arena();
  auto order = arena.allocate<cl_int>(2 * samples_);
  Arena::Scope scope(arena);
  auto sorted = arena.allocate<cl_int>(2 * samples_);
  auto spare = arena.allocate<cl_int>(2 * samples_);
  const auto ranks = arena.allocate<cl_int>(2 * samples_);
  launch_tiles(2, kernels::sort_tiles{.tiles = chunks_,
                                      .tree_count = trees_.size(),
                                      .first_chunks = first_chunks_,
                                      .trees = trees_,
                                      .all_samples = samples_,
                                      .samples = samples,
                                      .order = sorted,
                                      .ranks = ranks});
  for (int widenings = 0; widenings * kernel::MERGED_RUNS_BITS < levels_above_chunks_; ++widenings) {
    runtime_.map(2 * samples_, kernels::merge_tiles{.tree_count = trees_.size(),
                                                    .first_samples = first_samples_,
                                                    .trees = trees_,
                                                    .all_samples = samples_,
                                                    .widenings = widenings,
                                                    .samples = samples,
                                                    .from = sorted,
                                                    .to = spare,
                                                    .ranks = ranks});
    std::swap(sorted, spare);
  }
  const auto counts = arena.allocate<cl_uint>(chunks_);
  auto from = sorted, to = spare, other = order;
  for (int level = 0; level < levels_above_chunks_; ++level) {
    launch_tiles(1, kernels::count_tiles{.tiles = chunks_,
                                         .tree_count = trees_.size(),
                                         .first_chunks = first_chunks_,
                                         .trees = trees_,
                                         .all_samples = samples_,
                                         .level = level,
                                         .samples = samples,
                                         .order = from,
                                         .ranks = ranks,
                                         .nodes = nodes,
                                         .counts = counts});
    launch_tiles(1, kernels::split_tiles{.tiles = chunks_,
                                         .tree_count = trees_.size(),
                                         .first_chunks = first_chunks_,
                                         .trees = trees_,
                                         .all_samples = samples_,
                                         .level = level,
                                         .samples = samples,
                                         .counts = counts,
                                         .from = from,
                                         .ranks = ranks,
                                         .to = to});
    from = to;
    std::swap(to, other);
  }
  launch_tiles(1, kernels::cut_tiles{.tiles = chunks_,
                                     .tree_count = trees_.size(),
                                     .first_chunks = first_chunks_,
                                     .trees = trees_,
                                     .all_samples = samples_,
                                     .samples = samples,
                                     .sorted = sorted,
                                     .ranks = ranks,
                                     .from = from,
                                     .nodes = nodes,
                                     .order = order});
  return order;
}

}  // namespace flaunay::points
