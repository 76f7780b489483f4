// From the triangles of a Delaunay triangulation, in any order, to the canonical result.
#pragma once

#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "recursive/points.hpp"

namespace flaunay::recursive {

/// Twins of half-edges: half-edge 3t + k runs from vertex k of triangle t to the next; -1 beyond the hull.
/// triangles: 3 ids each, counter-clockwise. O(n).
std::vector<std::int32_t> match_edges(const std::vector<std::int32_t>& triangles);

/// Replaces the triangles of every cell, a polygon of several triangles on one empty circle, by the fan from
/// its lexicographically smallest vertex, and mends the twins. Throws Error(internal) if an edge is not
/// Delaunay. O(n).
void canonicalize(const PointSets& sets, std::vector<std::int32_t>& triangles,
                  std::vector<std::int32_t>& twins);

/// Everything that a caller gets, but statistics of how it came about: triangles ordered by set, rows from
/// their smallest index, neighbours if asked for, hulls, representatives, and the counts in
/// Triangulation::statistics. triangles: of ids, counter-clockwise, any order and any choice among cocircular
/// points; twins: as above, or empty to have them found. O(n).
Triangulation finish(const PointSets& sets, std::vector<std::int32_t> triangles,
                     std::vector<std::int32_t> twins, const Options& options);

}  // namespace flaunay::recursive
