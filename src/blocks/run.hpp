// Mode blocks, the default: points are distributed to blocks, each work-item triangulates a block, blocks are
// merged up the tree, and the mesh is written to arrays.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "blocks/pipeline.hpp"
#include "points/device_mesh.hpp"
#include "statistics/phases.hpp"

namespace flaunay::blocks {

/// The points of a call and the memory for its results: vectors in host memory, or buffers in device memory.
struct Exchange {
  /// Returns the coordinates, x0 y0 x1 y1 ... They may be in the runtime's arena, because they are needed
  /// only until the points are in blocks.
  std::function<Buffer<cl_double>()> points;
  Buffer<cl_int> representatives;  ///< one per point
  bool wants_links;                ///< whether neighbours or halfedges are wanted
  /// Returns the arrays for the parts of the mesh, when its size is known, or for few points on devices with
  /// many lanes an upper bound. Parts that are not wanted have no memory.
  std::function<points::DeviceMesh(const MeshSizes&)> mesh;
  /// Called while the device computes, for work of the host that needs no results.
  std::function<void()> while_device_computes = [] {};
  /// Not null for regular triangulations, which blocks make without rounds.
  const points::Weights* weights = nullptr;
  /// Called after the last kernel if there was an upper bound, before the wait for the size, so that the
  /// transfer of the results needs no other wait.
  std::function<void()> transfer = [] {};
  /// The points if they are in host memory, too; otherwise null.
  const double* host_points = nullptr;
};

/// Facts about a result that the host knows when run returns.
struct Outcome {
  MeshSizes sizes;
  std::size_t undecided = 0;      ///< predicates that were evaluated exactly
  std::size_t rounds = 0;         ///< rounds of blocks; 0 if blocks were merged without
  std::size_t round_points = 0;   ///< points of all rounds
  std::size_t merged_points = 0;  ///< points of the round whose blocks were merged
  std::size_t hidden = 0;         ///< weighted points that are no vertices and no duplicates

  /// Writes it to the statistics of a call on n points.
  void write(std::size_t n, Statistics& statistics) const;
};

/// Triangulates sets with at least one point; offsets: as in Triangulator::triangulate. Returns when the last
/// kernel is enqueued. Allocates from both arenas, in the caller's scopes. Throws Error(input) for points
/// that are not finite or whose magnitudes differ too much. O(n log n).
geometry::Fitted<Outcome> run(host::Runtime& runtime, Arena& persistent,
                              const std::vector<std::size_t>& offsets, const Exchange& exchange,
                              statistics::Phases& phases);

/// Triangulates points in device memory, whose arrays come from `results`; otherwise as above.
points::DeviceMesh run(host::Runtime& runtime, Arena& persistent, const std::vector<std::size_t>& offsets,
                       const Buffer<cl_double>& coordinates, Arena& results);
/// weights: null if points have none.
points::DeviceMesh run(host::Runtime& runtime, Arena& persistent, const std::vector<std::size_t>& offsets,
                       const Buffer<cl_double>& coordinates, Arena& results, const points::Weights* weights);

}  // namespace flaunay::blocks
