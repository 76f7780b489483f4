// The twin of constrained/insertion: segments become edges one after the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/constrained.hpp"

namespace flaunay::sequential {

struct Result : ConstrainedTriangulation {
  std::size_t large_polygons = 0;     ///< cavities' sides triangulated by random insertion
  std::size_t repeated_polygons = 0;  ///< those of them for which gift-wrapping was needed
};

/// Makes the segments edges of a triangulation, in one or more sets.
///
/// coordinates, offsets: as in Triangulator::triangulate. delaunay: their triangulation, with neighbours.
/// segments: 2 indices of points of the same set per segment. Of the result there are the triangles, their
/// neighbours, and the edges; each segment is one piece.
///
/// Throws Error(usage) if an index is no point, or if the ends of a segment are in different sets;
/// Error(input) if two segments cross at a place that is no
/// point. That names the first segment that crosses one with a smaller index, the one with the smallest index
/// of those, and the place.
///
/// Inserts segments in random rounds that are always the same (see docs/constrained.md). In a fully random
/// order, s segments among n points take expected time O(n log n + n log^2 s) beside the triangulation. If
/// segments cross, they are inserted again in their own order, which takes O(s n) at worst.
Result constrain(const double* coordinates, const std::vector<std::size_t>& offsets,
                 const Triangulation& delaunay, const std::vector<std::int32_t>& segments);

}  // namespace flaunay::sequential
