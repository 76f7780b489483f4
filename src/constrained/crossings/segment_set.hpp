// The segments of sets of points: checks, and the segments of one set as pieces between its vertices.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "constrained/crossings/crossing_places.hpp"
#include "constrained/crossings/pairs.hpp"

namespace flaunay::constrained {

/// Throws Error(usage) if an index is no point, or if the ends of a segment are in different sets.
void check_segments(const std::vector<std::size_t>& offsets, const Ids& segments);

/// The set of a point.
std::size_t set_of(const std::vector<std::size_t>& offsets, std::int32_t point);

/// The numbers of each set's segments, without segments of length zero.
std::vector<Ids> segments_of_sets(const double* coordinates, const std::vector<std::size_t>& offsets,
                                  const Ids& segments);

/// Segments of one set.
struct SegmentSet {
  /// numbers: of the segments, none of length zero. Throws the errors of Triangulator::triangulate for the
  /// points.
  SegmentSet(const double* coordinates, const std::vector<std::size_t>& offsets, std::size_t set,
             const Ids& segments, const Ids& numbers);

  /// The index of a vertex that is the caller's: the smallest one of its points.
  std::int32_t index(std::int32_t vertex) const { return first + points.source[vertex]; }

  std::int32_t first;          ///< the index of the set's first point
  geometry::PointSets points;  ///< of this set alone
  Vertices vertices;           ///< at first the points, in their order
  std::vector<Piece> pieces;   ///< per segment
};

}  // namespace flaunay::constrained
