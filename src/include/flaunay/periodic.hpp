// Points on a torus: a plane that repeats itself in x and y.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay {

/// Where the plane begins again, in x and in y.
struct Period {
  double x = 1;  ///< positive, and at most 2^30 times the other
  double y = 1;  ///< see x
};

/// The Delaunay triangulations of one or more sets of points on a torus.
struct PeriodicTriangulation {
  /// x and y per point: its place in [0, period), a multiple of the period's last bit. They are rounded once,
  /// to half of that, and are then what the point is: so every image of a point is exact.
  std::vector<double> places;
  /// 3 per triangle, counter-clockwise, smallest index first: 2 n for n different points of a set.
  std::vector<std::int32_t> triangles;
  /// 6 per triangle: x and y per corner, in periods. With the first corner's in its place, the corner is at
  /// its place + offset * period. The first corner has 0, 0; the others -1, 0 or 1.
  std::vector<std::int8_t> offsets;
  /// 3 per triangle: the triangle opposite to each corner. There is always one.
  std::vector<std::int32_t> neighbors;
  /// One per point: the smallest index of a point of its set with the same place.
  std::vector<std::int32_t> representatives;
  /// sets + 1 values: set s has points [point_offsets[s], point_offsets[s + 1]).
  std::vector<std::size_t> point_offsets;
  /// sets + 1 values: set s has triangles [triangle_offsets[s], triangle_offsets[s + 1]).
  std::vector<std::size_t> triangle_offsets;
  /// Images that were triangulated besides the points, because empty circles reach across the border.
  std::size_t images = 0;
  Statistics statistics;  ///< of the last triangulation in the plane
};

/// Triangulates n points on a torus, x0 y0 x1 y1 ...; any finite numbers, which are taken into the period.
/// The result is exact, and a function of the set of places: where more than three points are cocircular,
/// their polygon is a fan from its lexicographically smallest vertex. Triangles are in the order that they
/// have in the plane, which the number of points given has a part in. Images of points near the border are
/// triangulated with the points. If each empty circle is less than half the smaller period wide, all
/// triangles are found, of which there are 2 n; otherwise it is an Error(input) that says so: a set has too
/// few points, or too large a gap, and has to be repeated. Throws what Triangulator::triangulate throws;
/// Error(usage) also for a period that is none. O(n log n) work.
FLAUNAY_API PeriodicTriangulation triangulate_periodic(Triangulator& triangulator, const double* points,
                                                       std::size_t n, const Period& period);
/// Triangulates many sets at once. Set s has points [offsets[s], offsets[s + 1]).
FLAUNAY_API PeriodicTriangulation triangulate_periodic(Triangulator& triangulator, const double* points,
                                                       const std::vector<std::size_t>& offsets,
                                                       const Period& period);

/// Returns the areas of the Voronoi cells on the torus, one per point, rounded; those of a set sum to that of
/// the period. Points that another one represents have 0. Throws Error(usage) for arrays that are none's.
/// O(n).
FLAUNAY_API std::vector<double> periodic_cell_areas(const PeriodicTriangulation& triangulation,
                                                    const Period& period);

}  // namespace flaunay
