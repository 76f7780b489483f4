// From the triangles of a Delaunay triangulation, in any order, to the canonical result.
#pragma once

#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "recursive/points.hpp"

namespace flaunay::recursive {

/// Triangles and how they hang together.
struct Mesh {
  std::vector<std::int32_t> triangles;  ///< 3 indices of points each, counter-clockwise
  /// Half-edge 3t + k runs from vertex k of triangle t to the next; its twin runs back, -1 beyond the hull.
  std::vector<std::int32_t> twins;
};

/// Mesh::twins for Mesh::triangles. Returns false, twins half found, if two triangles are on the same side of
/// an edge. O(n log d) for vertices of d edges.
bool find_twins(const std::vector<std::int32_t>& triangles, std::vector<std::int32_t>& twins);

/// The same; throws Error(internal) where find_twins returns false.
std::vector<std::int32_t> match_edges(const std::vector<std::int32_t>& triangles);

/// Everything that a caller gets, but statistics of how it came about: triangles ordered by set, rows from
/// their smallest index, neighbours if asked for, hulls, representatives, and the counts in
/// Triangulation::statistics. triangles: of ids, counter-clockwise, any order and any choice among cocircular
/// points; twins: as above, or empty to have them found. O(n).
Triangulation finish(const PointSets& sets, std::vector<std::int32_t> triangles,
                     std::vector<std::int32_t> twins, const Options& options);

}  // namespace flaunay::recursive
