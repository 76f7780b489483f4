#include "blocks/memory.hpp"

#include <algorithm>

#include "blocks/pipeline.hpp"
#include "blocks/records.h"
#include "mesh/limits.h"
#include "points/cut_tree.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
using namespace points;

namespace {

// Number of arrays that exist at the same time. Each is rounded up to the device's alignment.
constexpr std::size_t kArrays = 48;
// Per point: a vertex, its source, its representative, its edge, and the edges.
constexpr std::size_t kPersistent =
    sizeof(cl_double2) + 3 * sizeof(cl_int) + kernel::EDGES_PER_VERTEX * sizeof(kernel::ring_edge);
// Per block: its first point, its set, its merge, its node, its triangulation, its number of vertices.
constexpr std::size_t kPersistentByBlock = 3 * sizeof(cl_int) + sizeof(kernel::block_merge) +
                                           sizeof(kernel::cut_node) + sizeof(kernel::solved_block);
// Per point, until it is in its block.
constexpr std::size_t kInput = sizeof(cl_double2);
// Per set, if each has its own scaling, in a copy of the points: its first point and its shift.
constexpr std::size_t kScalingBySet = 2 * sizeof(cl_int);
// Per point, while points are moved to blocks: the block, the cursor, the count and the sum of its scan.
constexpr std::size_t kMoving = 4 * sizeof(cl_int);
// Per block: a place, the first count of its set, and the further values of the last chunk of its set.
constexpr std::size_t kMovingByBlock = 6 * sizeof(cl_int);
constexpr std::size_t kMovingByChunk = 9 * sizeof(cl_int);
// Per point, if blocks' numbers have more than two digits: one more block and index.
constexpr std::size_t kMovingByDigits = 2 * sizeof(cl_int);
// Per point, while triangles are written: first rows with the sums of their scan, and the corner of each
// edge.
constexpr std::size_t kWriting = (2 + kernel::EDGES_PER_VERTEX) * sizeof(cl_int);

// In rounds, per point: a vertex, its source, its representative, two places of triangles with their links,
// and the hull's next and previous vertex.
constexpr std::size_t kRoundsPersistent = sizeof(cl_double2) + 2 * sizeof(cl_int) +
                                          2 * 3 * kMostTrianglesPerPoint * sizeof(cl_int) +
                                          2 * sizeof(cl_int);
// Per point that goes on: itself, its number and its first open edge, and the open edges. A planar graph has
// less than 3 edges per vertex, each of which is open at both ends, and a vertex of the hull has the ray to
// infinity.
constexpr std::size_t kMostOpenEdges = 7;
constexpr std::size_t kOpenPoint =
    sizeof(cl_double2) + 2 * sizeof(cl_int) + kMostOpenEdges * sizeof(kernel::open_edge);
// Per point of a round: its place in a block, its edges, and when these are solved the state of each edge's
// left side, the vertex' number, and two counts with the sums of their scan.
constexpr std::size_t kRound =
    sizeof(cl_double2) + 2 * sizeof(cl_int) + kernel::EDGES_PER_VERTEX * sizeof(kernel::ring_edge);
constexpr std::size_t kEmitting = (kernel::EDGES_PER_VERTEX + 1) * sizeof(cl_int) + 2 * sizeof(cl_uint2);
// Per block, if most are tiny and some are not: a count and the sum of its scan.
constexpr std::size_t kHalvingByBlock = 2 * sizeof(cl_uint);
// Per block of a round.
constexpr std::size_t kRoundByBlock = sizeof(kernel::block_frame) + sizeof(cl_int);
// Per point, at the end: the row of each place, the place of each hull vertex, the sums of their scans, and
// for hulls a vertex and how far ahead it looks, twice.
constexpr std::size_t kRows =
    4 * sizeof(cl_uint) + 2 * sizeof(cl_uint) + sizeof(cl_int) + 2 * sizeof(cl_int2);

// Bounds for rounds. input: of the scratch memory until all points are in blocks.
WorkspaceBytes rounds_bytes(const Tuning& tuning, std::size_t n, std::size_t sets, std::size_t blocks,
                            std::size_t input, std::size_t rounding) {
  // A round that leaves more than a half, as a rule, is followed by the last.
  const std::size_t open = n * kOpenPoint * std::max<std::size_t>(100, 2 * tuning.merge_from_percent) / 100;
  const std::size_t gap_leaves = 2 * n / tuning.round_points + sets;
  const std::size_t cutting =
      CutTrees::bytes(std::min(sets, gap_leaves), gap_leaves, tuning.samples_per_gap_block);
  const std::size_t most_blocks = blocks + gap_leaves;
  const std::size_t round = n * kRound +
                            most_blocks * (kPersistentByBlock + kRoundByBlock + kHalvingByBlock) +
                            std::max({solve_bytes(tuning, n), n * kEmitting, cutting + n * sizeof(cl_int)});
  return {n * kRoundsPersistent + open + (blocks + 1) * (kPersistentByBlock + sizeof(kernel::vertex_box)) +
              rounding,
          std::max({input, round, n * kRows + 4 * (sets + 1) * sizeof(cl_uint2)}) + rounding};
}

}  // namespace

WorkspaceBytes workspace_bytes(const host::Runtime& runtime, std::size_t n, std::size_t sets) {
  const Tuning& tuning = tuning_of(runtime);
  // The blocks of a set that is cut are more than half full on average.
  const std::size_t leaves = 2 * n / tuning.block_points;
  const std::size_t blocks = sets + leaves + 1;
  const std::size_t chunks = std::min(n, 3 * n / tuning.chunk(n)) + blocks + 2;
  const std::size_t rounding = kArrays * runtime.arena().alignment();
  const std::size_t cutting = CutTrees::bytes(std::min(sets, leaves), leaves, tuning.samples_per_block);
  const std::size_t scaling = sets > 1 ? n * kInput + (sets + 1) * kScalingBySet : 0;
  const std::size_t digits = blocks >> (2 * tuning.block_bits) > 0 ? n * kMovingByDigits : 0;
  const std::size_t moving = n * kMoving + digits + blocks * kMovingByBlock + chunks * kMovingByChunk;
  // The blocks are merged in pairs, each of which has a state.
  const std::size_t halving = tuning.blocks_in_parallel != 0 ? blocks * kHalvingByBlock : 0;
  const std::size_t solving = std::max(solve_bytes(tuning, n) + halving, blocks / 2 * sizeof(cl_int));
  const std::size_t writing = n * kWriting + 2 * (sets + 1) * sizeof(cl_int);
  const std::size_t input = n * kInput + scaling + std::max(cutting, moving);
  if (tuning.round_points > 0) return rounds_bytes(tuning, n, sets, blocks, input, rounding);
  return {n * kPersistent + (blocks + 1) * kPersistentByBlock + rounding,
          std::max({input, solving, writing}) + rounding};
}

}  // namespace flaunay::blocks
