#include <algorithm>

#include "hybrid/stages.hpp"

namespace flaunay::hybrid {
namespace {

// Blocks so many times larger than they should be are left to one work-item, with scratch of its own: points
// that all are the same cannot be cut.
constexpr std::size_t kLargeBlocks = 4;
// Work-items have scratch for so many times the points at most, together, whatever the sizes of blocks.
constexpr std::size_t kScratchPerPoint = 2;

// Solves the blocks of more than `larger` points and at most `capacity`.
void solve(Workspace& work, const Blocks& blocks, std::size_t workers, std::size_t capacity,
           std::ptrdiff_t larger, const Rings& rings, const Buffer<cl_int2>& free_lists,
           const Buffer<cl_int>& representatives) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  Arena::Scope scope(scratch);
  const auto next = scratch.allocate<cl_int>(1);
  runtime.fill(next, 1, cl_int{0});
  const auto points = scratch.allocate<cl_double2>(workers * capacity);
  const auto source = scratch.allocate<cl_int>(workers * capacity);
  const auto ranks = scratch.allocate<cl_int2>(3 * workers * capacity);
  const auto axes = scratch.allocate<cl_uchar>(workers * capacity);
  runtime.launch("divide", "solve_blocks", workers, runtime.tuning().block_group,
                 static_cast<cl_int>(workers), static_cast<cl_int>(blocks.count),
                 static_cast<cl_int>(capacity), static_cast<cl_int>(larger), blocks.device_offsets,
                 work.bounds.orient, work.bounds.circle, next, blocks.vertices, blocks.source,
                 representatives, rings.edges, rings.vertex_edge, rings.block_ends, free_lists,
                 rings.device_distinct, rings.device_undecided, points, source, ranks, axes);
}

}  // namespace

std::size_t solve_bytes(const host::Tuning& tuning, std::size_t n) {
  constexpr std::size_t kBytes = sizeof(cl_double2) + sizeof(cl_int) + 3 * sizeof(cl_int2) + sizeof(cl_uchar);
  // Many blocks at once, or all points in one.
  return kBytes * std::max(n, std::min(kScratchPerPoint * n,
                                       tuning.block_workers * kLargeBlocks * tuning.block_points));
}

Rings divide(Workspace& work, const Blocks& blocks, const Buffer<cl_int>& representatives) {
  host::Runtime& runtime = work.runtime;
  Rings rings;
  rings.edges = work.persistent.allocate<RingEdge>(kEdgesPerVertex * blocks.points);
  rings.vertex_edge = work.persistent.allocate<cl_int>(blocks.points);
  rings.block_ends = work.persistent.allocate<cl_int4>(blocks.count);
  Arena::Scope scope(work.scratch());
  rings.device_distinct = work.persistent.allocate<cl_int>(blocks.count);
  rings.device_undecided = work.persistent.allocate<cl_uint>(1);
  runtime.fill(rings.device_undecided, 1, cl_uint{0});
  const auto free_lists = work.scratch().allocate<cl_int2>(blocks.count);

  std::size_t largest = 1;
  for (std::size_t b = 0; b < blocks.count; ++b) {
    largest = std::max<std::size_t>(largest, blocks.offsets[b + 1] - blocks.offsets[b]);
  }
  const host::Tuning& tuning = runtime.tuning();
  const std::size_t capacity = std::min(largest, kLargeBlocks * tuning.block_points);
  const std::size_t affordable = std::max<std::size_t>(1, kScratchPerPoint * blocks.points / capacity);
  solve(work, blocks, std::min({blocks.count, tuning.block_workers, affordable}), capacity, -1, rings,
        free_lists, representatives);
  if (largest > capacity) {
    solve(work, blocks, 1, largest, static_cast<std::ptrdiff_t>(capacity), rings, free_lists,
          representatives);
  }
  std::size_t first = 0;
  for (const std::size_t end : blocks.level_ends) {
    runtime.launch("divide", "merge_blocks", end - first, tuning.block_group,
                   static_cast<cl_int>(end - first), static_cast<cl_int>(first), blocks.device_merges,
                   blocks.device_nodes, work.bounds.orient, work.bounds.circle, blocks.vertices, rings.edges,
                   rings.vertex_edge, rings.block_ends, free_lists, rings.device_undecided);
    first = end;
  }
  runtime.flush();
  return rings;
}

void await_rings(Workspace& work, const Blocks& blocks, Rings& rings) {
  rings.distinct.resize(blocks.count);
  const host::Runtime::Settled settled(work.runtime);
  work.runtime.read_later(rings.device_distinct, 0, blocks.count, rings.distinct.data());
  rings.undecided = work.runtime.read_one(rings.device_undecided, 0);
}

}  // namespace flaunay::hybrid
