// Launches over blocks and the parts of halved blocks, and over merges of blocks, on devices with many lanes
// (kernels/blocks/halves.h).
#pragma once

#include <algorithm>
#include <cstddef>

#include "blocks/pipeline.hpp"
#include "launchers/blocks/merge.cl.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {

/// One of this many consecutive work-items of a launch has a merge.
inline std::size_t spread_of(const Tuning& tuning, std::size_t merges) {
  return std::clamp<std::size_t>(tuning.merge_items / merges, 1, tuning.block_group);
}

/// The size of groups, one per block, that together have at least this many work-items, as far as the largest
/// group that halves a block allows. At least a warp: smaller groups would occupy one, too.
inline std::size_t group_for(const Tuning& tuning, std::size_t groups, std::size_t work_items) {
  std::size_t group = tuning.block_group;
  while (group < tuning.halve_group && group * groups < work_items) group *= 2;
  return std::min(group, tuning.halve_group);
}

/// Spreads the work-items of these merges over warps.
template <typename Kernel>
void launch_spread(points::Workspace& work, std::size_t spread, std::size_t merges, const Kernel& kernel) {
  work.runtime.note_spread(spread);
  work.runtime.launch(spread * merges, tuning_of(work.runtime).block_group, merges, kernel);
}

/// The least number of vertices of a part of this height.
inline std::size_t least_vertices(int height) { return std::size_t{2} << height; }

/// The cells of that size, in which at most one part of this height begins.
inline std::size_t cells_of(const PointBlocks& blocks, int height) {
  return (blocks.points + least_vertices(height) - 1) / least_vertices(height);
}

/// As spread_of, for the parts of a height.
inline std::size_t spread_of_parts(const Tuning& tuning, const PointBlocks& blocks, int height) {
  return std::max(spread_of(tuning, cells_of(blocks, height)),
                  height == 0 ? std::min(tuning.leaf_spread, tuning.block_group) : 1);
}

inline kernels::places_of_parts places_of_parts(const PointBlocks& blocks, const HalvedBlocks& halved,
                                                const points::Rings& rings, int height, Depths depths = {}) {
  return {.height = height,
          .least_depth = depths.least,
          .end_depth = depths.end,
          .places = blocks.points,
          .offsets = blocks.offsets,
          .distinct = rings.device_distinct,
          .block_of_place = halved.block_of_place,
          .axes = halved.axes};
}

}  // namespace flaunay::blocks
