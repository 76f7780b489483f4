#include <algorithm>
#include <utility>

#include "blocks/limits.h"
#include "blocks/parts.hpp"
#include "blocks/pipeline.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/blocks/halve.cl.hpp"
#include "launchers/blocks/halve_large.cl.hpp"
#include "mesh/limits.h"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
using namespace points;

namespace {

// Points of a block per work-item; more in the largest groups.
constexpr std::size_t kPointsPerItem = 4;

// The arrays in which blocks are sorted.
struct SortedPoints {
  Buffer<cl_double2> points{};
  Buffer<cl_int> source{};
  Buffer<cl_uint> scanned{};  ///< how many distinct points large blocks have before each place
};

// Sorts blocks of more than `capacity` points and drops their duplicates. Later rounds have none, and no
// representative is written then, but such blocks are sorted nowhere else.
void drop_duplicates(Workspace& work, const PointBlocks& blocks, const HalvedBlocks& halved,
                     std::size_t capacity, const Buffer<cl_int>& representatives,
                     const SortedPoints& sorted) {
  host::Runtime& runtime = work.runtime;
  Arena::Scope scope(work.scratch());
  auto order = work.scratch().allocate<cl_int>(blocks.points);
  auto merged = work.scratch().allocate<cl_int>(blocks.points);
  runtime.map(blocks.points, kernels::name_blocks{.blocks = blocks.count,
                                                  .largest = blocks.largest,
                                                  .offsets = blocks.offsets,
                                                  .block_of_place = halved.block_of_place});
  runtime.map(blocks.points, kernels::sort_large_tiles{.capacity = capacity,
                                                       .offsets = blocks.offsets,
                                                       .block_of_place = halved.block_of_place,
                                                       .points = blocks.vertices,
                                                       .order = order});
  for (std::size_t width = kernel::SORTED_TILE; width < blocks.largest; width *= 2) {
    runtime.map(blocks.points, kernels::merge_large_runs{.capacity = capacity,
                                                         .width = width,
                                                         .offsets = blocks.offsets,
                                                         .block_of_place = halved.block_of_place,
                                                         .points = blocks.vertices,
                                                         .order = order,
                                                         .merged = merged});
    std::swap(order, merged);
  }
  runtime.map(blocks.points, kernels::flag_distinct{.capacity = capacity,
                                                    .offsets = blocks.offsets,
                                                    .block_of_place = halved.block_of_place,
                                                    .points = blocks.vertices,
                                                    .order = order,
                                                    .flags = sorted.scanned});
  host::exclusive_scan(runtime, sorted.scanned, blocks.points, sorted.scanned);
  runtime.map(blocks.points, kernels::move_distinct{.capacity = capacity,
                                                    .offsets = blocks.offsets,
                                                    .block_of_place = halved.block_of_place,
                                                    .points = blocks.vertices,
                                                    .source = blocks.source,
                                                    .order = order,
                                                    .scanned = sorted.scanned,
                                                    .distinct_points = sorted.points,
                                                    .distinct_source = sorted.source});
  runtime.map(blocks.points, kernels::name_duplicates{.capacity = capacity,
                                                      .offsets = blocks.offsets,
                                                      .block_of_place = halved.block_of_place,
                                                      .source = blocks.source,
                                                      .order = order,
                                                      .scanned = sorted.scanned,
                                                      .distinct_source = sorted.source,
                                                      .representatives = representatives});
}

// Whether most blocks are tiny, so that one work-item per block is better than a group per block.
bool are_tiny(const PointBlocks& blocks) {
  return blocks.largest <= kernel::TINY_BLOCK || blocks.points < kernel::LEAF_VERTICES * blocks.count;
}

// Halves tiny blocks. Returns how many others there are at most, and which.
std::size_t halve_tiny(Workspace& work, const PointBlocks& blocks, const HalvedBlocks& halved,
                       const kernels::block_points& block_points, const SortedPoints& sorted,
                       const Buffer<cl_uint>& larger_blocks) {
  host::Runtime& runtime = work.runtime;
  runtime.map(blocks.count, kernels::halve_tiny_blocks{.places = blocks.points,
                                                       .offsets = blocks.offsets,
                                                       .block_points = block_points,
                                                       .block_of_place = halved.block_of_place,
                                                       .axes = halved.axes,
                                                       .scratch_points = sorted.points,
                                                       .scratch_source = sorted.source});
  if (blocks.largest <= kernel::TINY_BLOCK) return 0;
  runtime.map(blocks.count, kernels::flag_larger_blocks{.offsets = blocks.offsets, .flags = larger_blocks});
  host::exclusive_scan(runtime, larger_blocks, blocks.count, larger_blocks);
  return blocks.points / (kernel::TINY_BLOCK + 1);
}

}  // namespace

HalvedBlocks halve(Workspace& work, const PointBlocks& blocks, const Buffer<cl_int>& representatives,
                   const Rings& rings) {
  host::Runtime& runtime = work.runtime;
  const Tuning& tuning = tuning_of(runtime);
  Arena& scratch = work.scratch();
  const HalvedBlocks halved{scratch.allocate<cl_int>(blocks.points),
                            scratch.allocate<cl_uchar>(blocks.points)};
  Arena::Scope scope(scratch);
  const std::size_t capacity = std::min(tuning.large_blocks * tuning.block_points,
                                        tuning.local_bytes / kernel::LOCAL_BYTES_PER_BLOCK_POINT);
  const bool has_large = blocks.largest > capacity;
  const SortedPoints sorted{scratch.allocate<cl_double2>(blocks.points),
                            scratch.allocate<cl_int>(blocks.points),
                            scratch.allocate<cl_uint>(has_large ? blocks.points + 1 : 1)};
  if (has_large) drop_duplicates(work, blocks, halved, capacity, representatives, sorted);
  const kernels::block_points block_points{.points = blocks.vertices,
                                           .source = blocks.source,
                                           .representatives = representatives,
                                           .solved = rings.solved,
                                           .distinct_counts = rings.device_distinct};
  const bool with_tiny = are_tiny(blocks);
  const auto larger_blocks = scratch.allocate<cl_uint>(with_tiny ? blocks.count + 1 : 1);
  const std::size_t groups =
      with_tiny ? halve_tiny(work, blocks, halved, block_points, sorted, larger_blocks) : blocks.count;
  if (groups == 0) return halved;
  const std::size_t group = group_for(tuning, groups, (blocks.points + kPointsPerItem - 1) / kPointsPerItem);
  const kernels::blocks_to_halve to_halve{.blocks = blocks.count,
                                          .are_listed = with_tiny,
                                          .larger_blocks = larger_blocks,
                                          .capacity = capacity,
                                          .largest = blocks.largest,
                                          .offsets = blocks.offsets,
                                          .scanned = sorted.scanned};
  runtime.note_elements((std::min(blocks.largest, capacity) + group - 1) / group);
  runtime.launch(group * groups, group,
                 kernels::halve_blocks{.blocks_to_halve = to_halve,
                                       .places = blocks.points,
                                       .block_points = block_points,
                                       .block_of_place = halved.block_of_place,
                                       .axes = halved.axes,
                                       .scratch_points = sorted.points,
                                       .scratch_source = sorted.source});
  if (has_large) {
    runtime.launch(group * groups, group,
                   kernels::halve_large_blocks{.blocks_to_halve = to_halve,
                                               .points = blocks.vertices,
                                               .source = blocks.source,
                                               .distinct_counts = rings.device_distinct,
                                               .axes = halved.axes,
                                               .distinct_points = sorted.points,
                                               .distinct_source = sorted.source,
                                               .scratch = scratch.allocate<cl_int>(4 * blocks.points)});
  }
  return halved;
}

}  // namespace flaunay::blocks
