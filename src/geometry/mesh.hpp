// Makes the canonical result from the triangles of a Delaunay triangulation in any order.
#pragma once

#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "geometry/point_sets.hpp"

namespace flaunay::geometry {

/// Triangles and their adjacency.
struct Mesh {
  std::vector<std::int32_t> triangles;  ///< 3 indices of points each, counter-clockwise
  /// Half-edge 3t + k goes from vertex k of triangle t to its next vertex. Entry 3t + k is its twin, the
  /// opposite half-edge in the adjacent triangle, or -1 on the hull.
  std::vector<std::int32_t> twins;
};

/// Computes Mesh::twins from Mesh::triangles. Returns false, with some twins missing, if two triangles are on
/// the same side of an edge. O(n log d) for vertices of d edges.
bool find_twins(const std::vector<std::int32_t>& triangles, std::vector<std::int32_t>& twins);

/// Returns Mesh::twins; throws Error(internal) if two triangles are on the same side of an edge.
std::vector<std::int32_t> match_edges(const std::vector<std::int32_t>& triangles);

/// Makes the result for the caller: triangles in the order of sets, each beginning with its smallest index,
/// neighbours if the options ask for them, hulls, representatives, and the numbers of points and triangles in
/// Triangulation::statistics. triangles: 3 ids each, counter-clockwise, in any order, with any choice among
/// cocircular points. twins: Mesh::twins, or empty if they are not known yet. O(n).
Triangulation finish(const PointSets& sets, std::vector<std::int32_t> triangles,
                     std::vector<std::int32_t> twins, const Options& options);

}  // namespace flaunay::geometry
