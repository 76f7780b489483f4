// Mode blocks, the default: points are distributed to blocks, each work-item triangulates a block, blocks are
// merged up the tree, and the mesh is written to arrays.
#pragma once

#include <cstddef>
#include <vector>

#include "blocks/stages.hpp"
#include "statistics/phases.hpp"

namespace flaunay::blocks {

/// Provides the points of a call and the memory for its results: vectors in host memory, or buffers of the
/// caller.
class Exchange {
 public:
  virtual ~Exchange() = default;
  /// The coordinates, x0 y0 x1 y1 ... They may be in the runtime's arena, because they are needed only until
  /// the points are in blocks.
  virtual Buffer<cl_double> points() = 0;
  /// The array for the representatives, one per point.
  virtual Buffer<cl_int> representatives() = 0;
  /// Called while the device computes, for work of the host that needs no results.
  virtual void while_device_computes() {}
  /// Whether neighbours or halfedges are wanted.
  virtual bool wants_links() const = 0;
  /// The arrays for the parts of the mesh, called when its size is known. Parts that are not wanted have no
  /// memory.
  virtual MeshBuffers mesh(const MeshSizes& sizes) = 0;
};

/// What the host knows about a result when run returns.
struct Outcome {
  MeshSizes sizes;
  std::size_t undecided = 0;      ///< predicates that were evaluated exactly
  std::size_t rounds = 0;         ///< rounds of blocks; 0 if blocks were merged without
  std::size_t round_points = 0;   ///< points of all rounds
  std::size_t merged_points = 0;  ///< points of the round whose blocks were merged

  /// Writes it to the statistics of a call on n points.
  void write(std::size_t n, Statistics& statistics) const;
};

/// Triangulates sets with at least one point; the offsets are those of Triangulator::triangulate. Returns
/// when the last kernel is enqueued. Allocates from both arenas, in the caller's scopes. Throws Error(input)
/// for points that are not finite or whose magnitudes differ too much. O(n log n).
Outcome run(host::Runtime& runtime, Arena& persistent, const std::vector<std::size_t>& offsets,
            Exchange& exchange, statistics::Phases& phases);

}  // namespace flaunay::blocks
