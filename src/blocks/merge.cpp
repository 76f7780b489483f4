#include <algorithm>

#include "blocks/halving.h"
#include "blocks/limits.h"
#include "blocks/parts.hpp"
#include "blocks/pipeline.hpp"
#include "blocks/records.h"
#include "launchers/blocks/merge.cl.hpp"
#include "launchers/blocks/merge_exact.cl.hpp"
#include "launchers/blocks/seams.cl.hpp"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
using namespace points;

namespace {

// Without undecided predicates, no merge stops.
bool may_stop(const Workspace& work) {
  return work.bounds.coarse == 0 && (work.bounds.orient != 0 || work.bounds.circle != 0);
}
// In fixed point, walks decide all predicates themselves (blocks/seams.cl).
bool walks_may_stop(const Workspace& work) {
  return !work.runtime.capabilities().fixed_point && may_stop(work);
}

// Of n vertices, some 4 sqrt(n) edges cross a seam, as a rule. A warp is there in any case.
std::size_t sewing_group_of(const Tuning& tuning, int height) {
  return std::min(tuning.sewing_group, std::max(tuning.block_group, std::size_t{4} << (height + 1) / 2));
}

// The arrays of merges from both ends of their seam that all heights share.
struct Seams {
  Buffer<cl_int2> crossings{};
  Buffer<kernel::seam_walk> walks{};
  Buffer<cl_int> removals{};
  Buffer<cl_uchar> is_removed{};  // 0, all of them, between heights
};

// Two walks and the sewing are more work than one merge, but a shorter chain of steps, and lanes diverge
// less.
int first_height_of_seams(const Tuning& tuning) {
  int height = 1;
  while (least_vertices(height) < tuning.seam_points) ++height;
  return height;
}

Seams seams_of(Workspace& work, const PointBlocks& blocks, int first_height) {
  Arena& scratch = work.scratch();
  const std::size_t room = 2 * kernel::CROSSINGS_PER_VERTEX * blocks.points;
  const std::size_t marks = 2 * kernel::PAIRS_PER_VERTEX * blocks.points;
  const Seams seams{scratch.allocate<cl_int2>(room),
                    scratch.allocate<kernel::seam_walk>(2 * cells_of(blocks, first_height)),
                    scratch.allocate<cl_int>(room), scratch.allocate<cl_uchar>(marks)};
  work.runtime.fill<cl_uchar>(seams.is_removed, marks, 0);
  return seams;
}

// The data of merges of halves that all heights share.
struct Halves {
  Workspace& work;
  const PointBlocks& blocks;
  const HalvedBlocks& halved;
  const Rings& rings;
  Buffer<kernel::solved_block> parts{};
  Buffer<cl_int> states{};
  Seams seams{};
};

// kernels::merge_parts or kernels::finish_parts.
template <typename Kernel>
void launch_on_parts(const Halves& halves, int height) {
  const auto& [work, blocks, halved, rings, parts, states, seams] = halves;
  const std::size_t cells = cells_of(blocks, height);
  const std::size_t spread = spread_of_parts(tuning_of(work.runtime), blocks, height);
  launch_spread(work, spread, cells,
                Kernel{.spread = spread,
                       .places_of_parts = places_of_parts(blocks, halved, rings, height),
                       .bounds = work.bounds,
                       .points = blocks.vertices,
                       .edges = rings.edges,
                       .vertex_edge = rings.vertex_edge,
                       .parts = parts,
                       .solved = rings.solved,
                       .states = states,
                       .account = rings.device_account});
}

// kernels::walk_seams or kernels::finish_walks.
template <typename Kernel>
void launch_on_walks(const Halves& halves, int height) {
  const auto& [work, blocks, halved, rings, parts, states, seams] = halves;
  const std::size_t walks = 2 * cells_of(blocks, height);
  const std::size_t spread = spread_of(tuning_of(work.runtime), walks);
  launch_spread(work, spread, walks,
                Kernel{.spread = spread,
                       .places_of_parts = places_of_parts(blocks, halved, rings, height),
                       .bounds = work.bounds,
                       .points = blocks.vertices,
                       .edges = rings.edges,
                       .vertex_edge = rings.vertex_edge,
                       .parts = parts,
                       .solved = rings.solved,
                       .crossings = seams.crossings,
                       .removals = seams.removals,
                       .is_removed = seams.is_removed,
                       .walks = seams.walks,
                       .account = rings.device_account});
}

// kernels::merge_trees or kernels::finish_trees.
template <typename Kernel>
void launch_on_trees(Workspace& work, const Blocks& blocks, std::size_t first, std::size_t merges,
                     const Rings& rings, const Buffer<cl_int>& states) {
  const std::size_t spread = spread_of(tuning_of(work.runtime), merges);
  launch_spread(work, spread, merges,
                Kernel{.spread = spread,
                       .first_merge = first,
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

void sew_seams(const Halves& halves, int height) {
  const auto& [work, blocks, halved, rings, parts, states, seams] = halves;
  host::Runtime& runtime = work.runtime;
  const std::size_t group = sewing_group_of(tuning_of(runtime), height);
  runtime.launch(group * cells_of(blocks, height), group,
                 kernels::sew_seams{.places_of_parts = places_of_parts(blocks, halved, rings, height),
                                    .points = blocks.vertices,
                                    .crossings = seams.crossings,
                                    .walks = seams.walks,
                                    .edges = rings.edges,
                                    .vertex_edge = rings.vertex_edge,
                                    .parts = parts,
                                    .solved = rings.solved,
                                    .removals = seams.removals,
                                    .is_removed = seams.is_removed,
                                    .account = rings.device_account});
}

}  // namespace

void merge_halves(Workspace& work, const PointBlocks& blocks, const HalvedBlocks& halved,
                  const Rings& rings) {
  Arena::Scope scope(work.scratch());
  Halves halves{work, blocks, halved, rings};
  halves.parts = work.scratch().allocate<kernel::solved_block>(cells_of(blocks, 0));
  halves.states = work.scratch().allocate<cl_int>(cells_of(blocks, 0));
  const int heights = kernel::halving_depth(static_cast<int>(blocks.largest));
  const int first_seams = first_height_of_seams(tuning_of(work.runtime));
  for (int height = 0; height < first_seams && height <= heights; ++height) {
    launch_on_parts<kernels::merge_parts>(halves, height);
    if (may_stop(work)) launch_on_parts<kernels::finish_parts>(halves, height);
  }
  if (first_seams <= heights) halves.seams = seams_of(work, blocks, first_seams);
  for (int height = first_seams; height <= heights; ++height) {
    launch_on_walks<kernels::walk_seams>(halves, height);
    if (walks_may_stop(work)) launch_on_walks<kernels::finish_walks>(halves, height);
    sew_seams(halves, height);
  }
}

void solve_in_parallel(Workspace& work, const PointBlocks& blocks, const Buffer<cl_int>& representatives,
                       const Rings& rings) {
  Arena::Scope scope(work.scratch());
  const HalvedBlocks halved = halve(work, blocks, representatives, rings);
  if (work.weights != nullptr)
    return work.weights->solver->merge_halves(work, blocks, halved, representatives, rings);
  merge_halves(work, blocks, halved, rings);
}

void merge_trees(Workspace& work, const Blocks& blocks, std::size_t first, std::size_t end,
                 const Rings& rings) {
  Arena::Scope scope(work.scratch());
  const auto states = work.scratch().allocate<cl_int>(end - first);
  launch_on_trees<kernels::merge_trees>(work, blocks, first, end - first, rings, states);
  if (may_stop(work)) launch_on_trees<kernels::finish_trees>(work, blocks, first, end - first, rings, states);
}

}  // namespace flaunay::blocks
