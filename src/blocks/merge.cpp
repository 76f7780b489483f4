#include <algorithm>

#include "blocks/stages.hpp"
#include "launchers/blocks/merge.cl.hpp"
#include "launchers/blocks/merge_exact.cl.hpp"
#include "shared/halving.h"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
namespace {

// Every so many-th work-item of a launch has a merge.
std::size_t spread_of(const Tuning& tuning, std::size_t merges) {
  return std::clamp<std::size_t>(tuning.merge_items / merges, 1, tuning.block_group);
}

// Without undecided predicates, no merge stops.
bool may_stop(const Workspace& work) { return work.bounds.orient != 0 || work.bounds.circle != 0; }

// The places of a cell in which at most one part of this height begins.
std::size_t cells_of(const PointBlocks& blocks, int height) {
  const std::size_t size = std::size_t{2} << height;
  return (blocks.points + size - 1) / size;
}

}  // namespace

void merge_halves(Workspace& work, const PointBlocks& blocks, const HalvedBlocks& halved,
                  const Rings& rings) {
  host::Runtime& runtime = work.runtime;
  const Tuning& tuning = tuning_of(runtime);
  Arena::Scope scope(work.scratch());
  const auto parts = work.scratch().allocate<kernel::solved_block>(cells_of(blocks, 0));
  const auto states = work.scratch().allocate<cl_int>(cells_of(blocks, 0));
  const int heights = kernel::halving_depth(static_cast<int>(blocks.largest));
  for (int height = 0; height <= heights; ++height) {
    const std::size_t cells = cells_of(blocks, height);
    const std::size_t spread = spread_of(tuning, cells);
    runtime.launch(spread * cells, tuning.block_group, cells,
                   kernels::merge_parts{.spread = spread,
                                        .height = height,
                                        .places = blocks.points,
                                        .offsets = blocks.offsets,
                                        .distinct = rings.device_distinct,
                                        .block_of_place = halved.block_of_place,
                                        .axes = halved.axes,
                                        .bounds = work.bounds,
                                        .points = blocks.vertices,
                                        .edges = rings.edges,
                                        .vertex_edge = rings.vertex_edge,
                                        .parts = parts,
                                        .solved = rings.solved,
                                        .states = states});
    if (!may_stop(work)) continue;
    runtime.launch(cells, tuning.block_group, cells,
                   kernels::finish_parts{.height = height,
                                         .places = blocks.points,
                                         .offsets = blocks.offsets,
                                         .distinct = rings.device_distinct,
                                         .block_of_place = halved.block_of_place,
                                         .axes = halved.axes,
                                         .bounds = work.bounds,
                                         .points = blocks.vertices,
                                         .edges = rings.edges,
                                         .vertex_edge = rings.vertex_edge,
                                         .parts = parts,
                                         .solved = rings.solved,
                                         .states = states,
                                         .account = rings.device_account});
  }
}

void solve_in_parallel(Workspace& work, const PointBlocks& blocks, const Buffer<cl_int>& representatives,
                       const Rings& rings) {
  Arena::Scope scope(work.scratch());
  merge_halves(work, blocks, halve(work, blocks, representatives, rings), rings);
}

void merge_trees(Workspace& work, const Blocks& blocks, std::size_t first, std::size_t end,
                 const Rings& rings) {
  host::Runtime& runtime = work.runtime;
  const Tuning& tuning = tuning_of(runtime);
  Arena::Scope scope(work.scratch());
  const std::size_t merges = end - first;
  const auto states = work.scratch().allocate<cl_int>(merges);
  const std::size_t spread = spread_of(tuning, merges);
  runtime.launch(spread * merges, tuning.block_group, merges,
                 kernels::merge_trees{.spread = spread,
                                      .first_merge = first,
                                      .merges = blocks.device_merges,
                                      .nodes = blocks.device_nodes,
                                      .bounds = work.bounds,
                                      .points = blocks.vertices,
                                      .edges = rings.edges,
                                      .vertex_edge = rings.vertex_edge,
                                      .solved = rings.solved,
                                      .states = states});
  if (!may_stop(work)) return;
  runtime.launch(merges, tuning.block_group, merges,
                 kernels::finish_trees{.first_merge = first,
                                       .merges = blocks.device_merges,
                                       .nodes = blocks.device_nodes,
                                       .bounds = work.bounds,
                                       .points = blocks.vertices,
                                       .edges = rings.edges,
                                       .vertex_edge = rings.vertex_edge,
                                       .solved = rings.solved,
                                       .states = states,
                                       .account = rings.device_account});
}

}  // namespace flaunay::blocks
