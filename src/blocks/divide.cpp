#include <fmt/format.h>

#include <algorithm>

#include "blocks/codes.h"
#include "blocks/limits.h"
#include "blocks/pipeline.hpp"
#include "blocks/weighted.hpp"
#include "launchers/blocks/divide.cl.hpp"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
using namespace points;

namespace {

cl_uint most_ties(const Workspace& work) { return work.ties_are_left ? 0 : kernel::MOST_TIES; }

void solve_unweighted(Workspace& work, const Blocks& blocks, const Rings& rings, const BlocksLaunch& launch) {
  work.runtime.launch(launch.workers, tuning_of(work.runtime).block_group,
                      kernels::solve_blocks{.workers = launch.workers,
                                            .blocks = launch.blocks,
                                            .capacity = launch.capacity,
                                            .larger = launch.larger,
                                            .offsets = blocks.device_offsets,
                                            .bounds = work.bounds,
                                            .most_ties = most_ties(work),
                                            .next = launch.next,
                                            .block_points = launch.points,
                                            .edges = rings.edges,
                                            .vertex_edge = rings.vertex_edge,
                                            .account = rings.device_account,
                                            .block_scratch = launch.scratch,
                                            .scratch_axes = launch.scratch_axes});
}

// If the caller wants progress, blocks are solved in several launches. Each has many blocks per work-item,
// because work-items end at different times, and then wait for the last one.
constexpr std::size_t kMostLaunches = 32;
constexpr std::size_t kLeastBlocksPerWorker = 64;

// Triangulates the blocks that have more than `larger` and at most `capacity` points. places: of all workers'
// scratch memory. milestones: null for none.
void solve_sizes(Workspace& work, const Blocks& blocks, std::size_t workers, std::size_t capacity,
                 std::size_t places, std::ptrdiff_t larger, const Rings& rings,
                 const Buffer<cl_int>& representatives, Milestones* milestones) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const auto next = scratch.allocate<cl_int>(1);
  const auto points = scratch.allocate<cl_double2>(places);
  const auto source = scratch.allocate<cl_int>(places);
  const auto ranks = scratch.allocate<cl_ulong>(3 * places);
  const auto axes = scratch.allocate<cl_uchar>(places);
  const bool is_watched = milestones != nullptr && milestones->are_wanted();
  const std::size_t per_launch =
      is_watched ? std::max(kLeastBlocksPerWorker * workers, blocks.count / kMostLaunches + 1) : blocks.count;
  for (std::size_t first = 0; first < blocks.count; first += per_launch) {
    const std::size_t last = std::min(first + per_launch, blocks.count);
    runtime.fill(next, 1, static_cast<cl_int>(first));
    const BlocksLaunch launch{
        .workers = workers,
        .blocks = last,
        .capacity = capacity,
        .larger = larger,
        .next = next,
        .points = {.points = blocks.vertices,
                   .source = blocks.source,
                   .representatives = representatives,
                   .solved = rings.solved,
                   .distinct_counts = rings.device_distinct},
        .scratch = {.scratch_points = points, .scratch_source = source, .scratch_ranks = ranks},
        .scratch_axes = axes};
    (work.weights != nullptr ? work.weights->solver->solve : solve_unweighted)(work, blocks, rings, launch);
    if (is_watched) {
      milestones->set("triangulate", kBlocksMade + (kBlocksSolved - kBlocksMade) * static_cast<double>(last) /
                                                       static_cast<double>(blocks.count));
    }
  }
}

// Each work-item triangulates one block after the other.
void solve_one_by_one(Workspace& work, const Blocks& blocks, std::size_t largest,
                      const Buffer<cl_int>& representatives, const Rings& rings, Milestones* milestones) {
  const Tuning& tuning = tuning_of(work.runtime);
  const std::size_t most = std::max<std::size_t>(1, tuning.large_blocks * tuning.block_points),
                    capacity = std::min(largest, most);
  const std::size_t in_all = tuning.scratch_per_point * blocks.points;
  const std::size_t affordable = std::max<std::size_t>(1, in_all / capacity);
  const std::size_t workers = std::min({blocks.count, tuning.block_workers, affordable});
  // If blocks are smaller, more workers can be affordable, and together need more places.
  const std::size_t places = work.runtime.at_most(
      workers * capacity,
      std::min(in_all, std::min(blocks.count, tuning.block_workers) * std::min(blocks.points, most)));
  solve_sizes(work, blocks, workers, capacity, places, -1, rings, representatives, milestones);
  if (largest > capacity) {
    solve_sizes(work, blocks, 1, largest, largest, static_cast<std::ptrdiff_t>(capacity), rings,
                representatives, nullptr);
  }
}

void merge_one_by_one(Workspace& work, const Blocks& blocks, std::size_t first, std::size_t end,
                      const Rings& rings) {
  work.runtime.launch(end - first, tuning_of(work.runtime).block_group, end - first,
                      kernels::merge_blocks{.first_merge = first,
                                            .merges = blocks.device_merges,
                                            .nodes = blocks.device_nodes,
                                            .bounds = work.bounds,
                                            .most_ties = most_ties(work),
                                            .points = blocks.vertices,
                                            .edges = rings.edges,
                                            .vertex_edge = rings.vertex_edge,
                                            .solved = rings.solved,
                                            .account = rings.device_account});
}

bool are_in_parallel(const Workspace& work) {
  return !work.runtime.is_native() && tuning_of(work.runtime).blocks_in_parallel != 0;
}

PointBlocks points_of(const Blocks& blocks, std::size_t largest) {
  return {blocks.count, blocks.points, largest, blocks.device_offsets, blocks.vertices, blocks.source};
}

std::size_t largest_of(const Blocks& blocks) {
  if (blocks.offsets.empty()) return blocks.largest;
  std::size_t largest = 1;
  for (std::size_t b = 0; b < blocks.count; ++b) {
    largest = std::max<std::size_t>(largest, blocks.offsets[b + 1] - blocks.offsets[b]);
  }
  return largest;
}

}  // namespace

Buffer<cl_uint> make_account(Workspace& work) {
  const auto account = work.persistent.allocate<cl_uint>(kernel::RINGS_NUMBERS);
  work.runtime.fill(account, kernel::RINGS_NUMBERS, cl_uint{0});
  return account;
}

Rings solve(Workspace& work, const Blocks& blocks, const Buffer<cl_int>& representatives,
            const Buffer<cl_uint>& account, Milestones* milestones, PartsOfBlocks* parts) {
  Rings rings;
  rings.edges = work.persistent.allocate<kernel::ring_edge>(kernel::EDGES_PER_VERTEX * blocks.points);
  rings.vertex_edge = work.persistent.allocate<cl_int>(blocks.points);
  rings.solved = work.persistent.allocate<kernel::solved_block>(blocks.count);
  rings.device_distinct = work.persistent.allocate<cl_int>(blocks.count);
  rings.device_account = account;
  if (work.weights != nullptr) {
    rings.vertex_weights = work.persistent.allocate<cl_double>(blocks.points);
    rings.links = work.persistent.allocate<cl_int>(blocks.points);
  }

  const std::size_t largest = largest_of(blocks);
  if (are_in_parallel(work)) {
    solve_in_parallel(work, points_of(blocks, largest), representatives, rings, parts);
    if (milestones != nullptr) milestones->set("triangulate", kBlocksSolved);
  } else {
    solve_one_by_one(work, blocks, largest, representatives, rings, milestones);
  }
  return rings;
}

void merge_parts(Workspace& work, const Blocks& blocks, const Rings& rings, PartsOfBlocks& parts) {
  // Of one-by-one solutions there are none; said so, programs that are always native leave merges out.
  if (!are_in_parallel(work) || parts.depth == 0) return;
  const PointBlocks whole = points_of(blocks, largest_of(blocks));
  merge_halves(work, whole, parts, rings, parts.height + 1, whole.height(), {0, parts.depth});
  parts = {};
}

void merge(Workspace& work, const Blocks& blocks, const Rings& rings, Milestones* milestones) {
  const auto merge_level = work.weights != nullptr ? work.weights->solver->merge
                           : are_in_parallel(work) ? merge_trees
                                                   : merge_one_by_one;
  std::size_t first = 0;
  for (const std::size_t end : blocks.level_ends) {
    merge_level(work, blocks, first, end, rings);
    first = end;
    if (milestones != nullptr)
      milestones->set("triangulate", kBlocksSolved + (kBlocksMerged - kBlocksSolved) *
                                                         static_cast<double>(end) /
                                                         static_cast<double>(blocks.merges.size()));
  }
  work.runtime.flush();
}

Rings divide(Workspace& work, const Blocks& blocks, const Buffer<cl_int>& representatives,
             Milestones* milestones) {
  const Rings rings = solve(work, blocks, representatives, make_account(work), milestones);
  merge(work, blocks, rings, milestones);
  return rings;
}

void check_account(const cl_uint* account) {
  if (account[kernel::RINGS_BROKEN] == 0) return;
  throw Error(ErrorKind::internal,
              fmt::format("the two walks along a seam, or the stars of an edge's vertices, "
                          "do not meet, in {} parts; please report the input",
                          account[kernel::RINGS_BROKEN]));
}

void await_rings(Workspace& work, const Blocks& blocks, Rings& rings) {
  rings.distinct.resize(blocks.count);
  const host::Runtime::Settled settled(work.runtime);
  work.runtime.read_later(rings.device_distinct, 0, blocks.count, rings.distinct.data());
  cl_uint account[kernel::RINGS_NUMBERS] = {};
  work.runtime.read(rings.device_account, 0, kernel::RINGS_NUMBERS, account);
  check_account(account);
  rings.undecided = account[kernel::RINGS_UNDECIDED];
  rings.ties = account[kernel::RINGS_TIES];
  rings.ties_left = account[kernel::RINGS_TIES_LEFT];
}

}  // namespace flaunay::blocks
