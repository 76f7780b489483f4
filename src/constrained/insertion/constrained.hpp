// The constrained Delaunay triangulation on the host, one segment after the other. docs/constrained.md
// defines it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::constrained {

struct Result {
  /// As in Triangulation. Rows of `delaunay` that no segment crosses are unchanged, at their places; the
  /// other places have the new triangles in ascending order.
  std::vector<std::int32_t> triangles, neighbors;
  /// As in ConstrainedTriangulation.
  std::vector<std::uint8_t> constrained;
  /// The edges that segments are made of, each once: 2 vertices per edge, the lexicographically smaller one
  /// first.
  std::vector<std::int32_t> constraint_edges;
  /// 2 per segment: its edges are [first, second) in constraint_edges, from its lexicographically smaller end
  /// to the other one. 0, 0 if its ends have the same coordinates.
  std::vector<std::int32_t> segment_edges;
  /// As in Triangulation; empty unless asked for.
  std::vector<std::int32_t> halfedges;

  std::size_t large_polygons = 0;     ///< cavities' sides triangulated by random insertion
  std::size_t repeated_polygons = 0;  ///< those of them for which gift-wrapping was needed
};

/// Throws Error(usage) if an index is no point, if the ends of a segment are in different sets, or if the
/// number of indices is odd.
void check_segments(const std::vector<std::size_t>& offsets, const std::vector<std::int32_t>& segments);

/// Throws the error of constrain() for segments that cross, if that takes few comparisons: of the first
/// segments of a single set, O(sqrt(s)) of s segments, each with each. The arguments are those of
/// constrain(); what that refuses for another reason is left to it. O(s), and O(n) if segments cross.
void check_first_segments(const double* coordinates, const std::vector<std::size_t>& offsets,
                          const std::vector<std::int32_t>& representatives,
                          const std::vector<std::int32_t>& segments);

/// Makes the segments edges of a triangulation, in one or more sets.
///
/// coordinates, offsets: as in Triangulator::triangulate. delaunay: their triangulation, with neighbours.
/// segments: 2 indices of points of the same set per segment.
///
/// Throws Error(usage) if an index is no point, if the ends of a segment are in different sets, if the number
/// of indices is odd, or if neighbours are missing; Error(input) if two segments cross at a place that is no
/// point. That names the first segment that crosses one with a smaller index, the one with the smallest index
/// of those, and the place.
///
/// Inserts segments in random rounds that are always the same (see docs/constrained.md). In a fully random
/// order, s segments among n points take expected time O(n log n + n log^2 s) beside the triangulation. If
/// segments cross, they are inserted again in their own order, which takes O(s n) at worst.
Result constrain(const double* coordinates, const std::vector<std::size_t>& offsets,
                 const Triangulation& delaunay, const std::vector<std::int32_t>& segments);

}  // namespace flaunay::constrained
