#include <algorithm>

#include "blocks/stages.hpp"
#include "launchers/blocks/halve.cl.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
namespace {

// A work-item has about so many points of its block.
constexpr std::size_t kPointsPerItem = 8;

std::size_t group_for(const Tuning& tuning, const PointBlocks& blocks) {
  // Not less than a warp, which would be there for less, too.
  std::size_t group = std::min(tuning.block_group, tuning.halve_group);
  while (group * kPointsPerItem * blocks.count < blocks.points) group *= 2;
  return std::min(group, tuning.halve_group);
}

}  // namespace

HalvedBlocks halve(Workspace& work, const PointBlocks& blocks, const Buffer<cl_int>& representatives,
                   const Rings& rings) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  const HalvedBlocks halved{scratch.allocate<cl_int>(blocks.points),
                            scratch.allocate<cl_uchar>(blocks.points)};
  Arena::Scope scope(scratch);
  runtime.map(blocks.points, kernels::name_blocks{.blocks = blocks.count,
                                                  .offsets = blocks.offsets,
                                                  .block_of_place = halved.block_of_place});
  const std::size_t group = group_for(tuning_of(runtime), blocks);
  runtime.launch(group * blocks.count, group,
                 kernels::halve_blocks{.blocks = blocks.count,
                                       .offsets = blocks.offsets,
                                       .points = blocks.vertices,
                                       .source = blocks.source,
                                       .representatives = representatives,
                                       .solved = rings.solved,
                                       .distinct_counts = rings.device_distinct,
                                       .axes = halved.axes,
                                       .scratch_points = scratch.allocate<cl_double2>(blocks.points),
                                       .scratch_source = scratch.allocate<cl_int>(blocks.points),
                                       .scratch_ranks = scratch.allocate<cl_int2>(3 * blocks.points),
                                       .scratch_lows = scratch.allocate<cl_int>(blocks.points)});
  return halved;
}

}  // namespace flaunay::blocks
