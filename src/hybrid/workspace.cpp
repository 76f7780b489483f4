#include "hybrid/workspace.hpp"

#include <algorithm>

#include "hybrid/cut_tree.hpp"
#include "hybrid/stages.hpp"

namespace flaunay::hybrid {
namespace {

// Arrays that live at the same time, each rounded up to what a device aligns to.
constexpr std::size_t kArrays = 48;
// By point: a vertex, its source, its representative, its edge, and the edges.
constexpr std::size_t kPersistent =
    sizeof(cl_double2) + 3 * sizeof(cl_int) + kEdgesPerVertex * sizeof(RingEdge);
// By block: where it begins, its set, its merge, its node, its ends, its number of vertices.
constexpr std::size_t kPersistentByBlock =
    3 * sizeof(cl_int) + sizeof(Merge) + sizeof(CutNode) + sizeof(cl_int4);
// By point, until it is in its block.
constexpr std::size_t kInput = sizeof(cl_double2);
// By point, while points go to blocks: the block, the cursor, the count and the sums of its scan.
constexpr std::size_t kMoving = 4 * sizeof(cl_int);
// By block: a place, the first count of its set, and what the last chunk of its set has on top of that.
constexpr std::size_t kMovingByBlock = 6 * sizeof(cl_int);
constexpr std::size_t kMovingByChunk = 9 * sizeof(cl_int);
// By point, while triangles are written: first rows with the sums of their scan, and the corner of each edge.
constexpr std::size_t kWriting = (2 + kEdgesPerVertex) * sizeof(cl_int);

}  // namespace

WorkspaceBytes workspace_bytes(const host::Runtime& runtime, std::size_t n, std::size_t sets) {
  const host::Tuning& tuning = runtime.tuning();
  // A set that is cut has blocks of more than half the points that they may have.
  const std::size_t leaves = 2 * n / tuning.block_points;
  const std::size_t blocks = sets + leaves + 1;
  const std::size_t chunks = std::min(n, 3 * n / tuning.chunk(n)) + blocks + 2;
  const std::size_t rounding = kArrays * runtime.arena().alignment();
  const std::size_t cutting = CutTrees::bytes(std::min(sets, leaves), leaves, kSamplesPerBlock);
  const std::size_t moving = n * kMoving + blocks * kMovingByBlock + chunks * kMovingByChunk;
  const std::size_t solving = solve_bytes(tuning, n) + blocks * sizeof(cl_int2);
  const std::size_t writing = n * kWriting + 2 * (sets + 1) * sizeof(cl_int);
  return {n * kPersistent + (blocks + 1) * kPersistentByBlock + rounding,
          std::max({n * kInput + std::max(cutting, moving), solving, writing}) + rounding};
}

}  // namespace flaunay::hybrid
