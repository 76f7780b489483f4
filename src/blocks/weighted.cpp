#include "blocks/weighted.hpp"

#include "launchers/blocks/weighted.cl.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
using namespace points;

namespace {

void solve_weighted(Workspace& work, const Blocks& blocks, const Rings& rings, const BlocksLaunch& launch) {
  work.runtime.launch(launch.workers, tuning_of(work.runtime).block_group,
                      kernels::solve_weighted_blocks{.workers = launch.workers,
                                                     .blocks = launch.blocks,
                                                     .capacity = launch.capacity,
                                                     .larger = launch.larger,
                                                     .offsets = blocks.device_offsets,
                                                     .bounds = work.bounds,
                                                     .weights = work.weights->by_point,
                                                     .weight_range = work.weights->range,
                                                     .vertex_weights = rings.vertex_weights,
                                                     .links = rings.links,
                                                     .next = launch.next,
                                                     .block_points = launch.points,
                                                     .edges = rings.edges,
                                                     .vertex_edge = rings.vertex_edge,
                                                     .account = rings.device_account,
                                                     .block_scratch = launch.scratch,
                                                     .scratch_axes = launch.scratch_axes});
}

void merge_weighted(Workspace& work, const Blocks& blocks, std::size_t first, std::size_t end,
                    const Rings& rings) {
  work.runtime.launch(end - first, tuning_of(work.runtime).block_group, end - first,
                      kernels::merge_weighted_blocks{.first_merge = first,
                                                     .merges = blocks.device_merges,
                                                     .nodes = blocks.device_nodes,
                                                     .offsets = blocks.device_offsets,
                                                     .bounds = work.bounds,
                                                     .vertex_weights = rings.vertex_weights,
                                                     .weight_range = work.weights->range,
                                                     .links = rings.links,
                                                     .points = blocks.vertices,
                                                     .edges = rings.edges,
                                                     .vertex_edge = rings.vertex_edge,
                                                     .solved = rings.solved,
                                                     .account = rings.device_account});
}

}  // namespace

const WeightedSolver kWeightedSolver = {solve_weighted, merge_weighted};

}  // namespace flaunay::blocks
