#include "blocks/memory.hpp"

#include <algorithm>

#include "blocks/stages.hpp"
#include "points/cut_tree.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {
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
  const std::size_t solving = std::max(solve_bytes(tuning, n), blocks / 2 * sizeof(cl_int));
  const std::size_t writing = n * kWriting + 2 * (sets + 1) * sizeof(cl_int);
  return {n * kPersistent + (blocks + 1) * kPersistentByBlock + rounding,
          std::max({n * kInput + scaling + std::max(cutting, moving), solving, writing}) + rounding};
}

}  // namespace flaunay::blocks
