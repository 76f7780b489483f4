// Points on a sphere: their Delaunay triangulation, Voronoi cells, and queries.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.hpp"
#include "flaunay/neighbors.hpp"

namespace flaunay {

/// How points of the unit sphere are given.
enum class SphereCoordinates {
  directions,  ///< x y z: any finite vector but 0; its length does not count
  degrees,     ///< longitude to the east, any number, and latitude, -90 to 90
};

/// The Delaunay triangulations of one or more sets of points on the unit sphere: the convex hulls of the
/// points in space. Points and triangles are numbered over all sets.
struct SphericalTriangulation {
  /// x and y per point: where the line from the south pole through it meets the plane of the equator;
  /// infinite for the south pole. They are rounded once and are then what the point is: every pair of numbers
  /// is a point that lies on the sphere exactly.
  std::vector<double> places;
  /// 3 per triangle, counter-clockwise as seen from outside, smallest index first. A set of n > 2 different
  /// points has 2 n - 4. If all lie on one circle, they are the two sides of a polygon. Where more than three
  /// are cocircular, their polygon is a fan from the first of them: the south pole, or else the smallest
  /// place, x before y.
  std::vector<std::int32_t> triangles;
  /// 3 per triangle: the triangle opposite to each vertex. There is always one.
  std::vector<std::int32_t> neighbors;
  /// One per point: the smallest index of a point of its set with the same place.
  std::vector<std::int32_t> representatives;
  /// sets + 1 values: set s has points [point_offsets[s], point_offsets[s + 1]).
  std::vector<std::size_t> point_offsets;
  /// sets + 1 values: set s has triangles [triangle_offsets[s], triangle_offsets[s + 1]).
  std::vector<std::size_t> triangle_offsets;
  Statistics statistics;  ///< of the triangulation of places in the plane
};

/// Triangulates n points of the sphere: their places in the plane, and around the south pole what is beyond
/// the hull there, which is the farthest-point Delaunay triangulation of the hull (Brown, 1979). So the
/// result is exact and canonical as that in the plane is. Throws what Triangulator::triangulate throws;
/// Error(input) also for the direction 0 and for a latitude beyond a pole. O(n log n) work.
FLAUNAY_API SphericalTriangulation triangulate_sphere(Triangulator& triangulator, const double* points,
                                                      std::size_t n, SphereCoordinates coordinates);
/// Triangulates many sets at once. Set s has points [offsets[s], offsets[s + 1]).
FLAUNAY_API SphericalTriangulation triangulate_sphere(Triangulator& triangulator, const double* points,
                                                      const std::vector<std::size_t>& offsets,
                                                      SphereCoordinates coordinates);

/// A SphericalTriangulation in device memory. For n points the caller's buffers must have, and flaunay's
/// have, the sizes given here.
struct DeviceSphericalTriangulation {
  DeviceBuffer places;           ///< SphericalTriangulation::places, double2, 16 n bytes
  DeviceBuffer triangles;        ///< SphericalTriangulation::triangles, int32, 24 n bytes
  DeviceBuffer neighbors;        ///< SphericalTriangulation::neighbors, int32, 24 n bytes
  DeviceBuffer representatives;  ///< SphericalTriangulation::representatives, int32, 4 n bytes
  /// sets + 1 values in host memory: as those of SphericalTriangulation.
  std::vector<std::size_t> point_offsets;
  std::vector<std::size_t> triangle_offsets;  ///< see point_offsets
  /// The triangulation of the places in the plane, kept for the memory that the next call needs for it.
  DeviceTriangulation planar;
  Statistics statistics;  ///< of that
};

/// Triangulates points in device memory, whose buffer has per point the numbers of the coordinates: x y z, or
/// longitude and latitude. All arrays stay there; the host makes the triangles around the south pole, for
/// which it reads the hull in the plane, and waits some times. If a point is at the south pole, the host
/// computes all. The results are those of the call for host memory. The work is enqueued like that of
/// Triangulator::triangulate for device memory, with the same errors.
FLAUNAY_API void triangulate_sphere(Triangulator& triangulator, const DevicePoints& points,
                                    SphereCoordinates coordinates, DeviceSphericalTriangulation& result,
                                    const Enqueue& enqueue = own_queue());

/// Returns x and y per point: its place, as SphericalTriangulation::places has it. Throws what
/// triangulate_sphere throws for points. O(n).
FLAUNAY_API std::vector<double> places_on_sphere(const double* points, std::size_t n,
                                                 SphereCoordinates coordinates);

/// Returns x y z per place: unit vectors, rounded.
FLAUNAY_API std::vector<double> directions_of(const std::vector<double>& places);

/// The Voronoi cells of points on the unit sphere.
struct SphericalVoronoi {
  /// x y z per triangle: the centre of the empty cap whose rim passes through its corners, rounded.
  std::vector<double> centres;
  /// n + 1 values: the cell of point i has corners [cell_offsets[i], cell_offsets[i + 1]) of cells.
  std::vector<std::int32_t> cell_offsets;
  /// The triangles whose centres are the corners of the cells, counter-clockwise as seen from outside,
  /// smallest first. Points that another point represents have none, nor have one or two points: the cells of
  /// these are hemispheres. If all points are on one great circle, cells are lunes with two corners (and some
  /// that coincide), opposite to each other, so that a side needs its middle to be drawn: of the cell of p
  /// that is the direction of a x (q - p), for the side that begins at the centre a of a triangle and is
  /// shared with q, the corner before p in that triangle.
  std::vector<std::int32_t> cells;
  /// n values: the areas of the cells, of which those of a set sum to 4 pi; rounded by some 1e-15, and if all
  /// points are within an angle r, by that divided by r^2; of points within some 1e-15 of each other a sum
  /// can rarely be another multiple of 4 pi. Points that another one represents have 0, two points a
  /// hemisphere each, and a point alone the sphere.
  std::vector<double> areas;
};

/// Computes the dual of a triangulation on the sphere. Throws Error(usage) for arrays that are none's. O(n).
FLAUNAY_API SphericalVoronoi voronoi_on_sphere(Triangulator& triangulator,
                                               const SphericalTriangulation& triangulation);

/// Answers queries on a sphere with one set of points. Queries are given as points are, and are rounded to
/// places as these. Of the points' places the plane's locator finds one near the query's, from which an exact
/// walk goes on over the sphere.
class FLAUNAY_API SphereLocator {
 public:
  /// Makes a locator, which copies what it needs. Throws Error(usage) for several sets and for arrays that
  /// are no triangulation's. O(n log n).
  SphereLocator(Triangulator& triangulator, const SphericalTriangulation& triangulation);
  ~SphereLocator();
  /// A locator that was moved from can only be destroyed or assigned to.
  SphereLocator(SphereLocator&&) noexcept;
  /// Releases the memory of the locator that is assigned to.
  SphereLocator& operator=(SphereLocator&&) noexcept;

  /// Finds for each of m queries the triangle between whose sides, which are arcs of great circles, it lies;
  /// exactly. On an arc or at a corner it is the triangle of the smallest index. It is -1 beyond a set that
  /// lies within a hemisphere.
  std::vector<std::int32_t> locate(const double* queries, std::size_t m, SphereCoordinates coordinates);
  /// Finds for each of m queries the nearest point, exactly; of several the south pole, or else the one with
  /// the smallest place. It is -1 if there are no points.
  std::vector<std::int32_t> nearest(const double* queries, std::size_t m, SphereCoordinates coordinates);
  /// Finds for each of m queries the nearest points, in their order by exact comparisons; of several that are
  /// as near, the first is the one above, and equal points are in the order of their indices. Distances, also
  /// the largest one, are angles in radians, rounded. Throws Error(usage) as PointTree does. Some O(count log
  /// count) per query.
  Neighbors nearest(const double* queries, std::size_t m, SphereCoordinates coordinates,
                    const NeighborOptions& options);
  /// Computes for each of m queries the value at the place where its direction meets the triangle in space,
  /// which is linear there (Renka, 1984): `columns` numbers per point and per query. At a point it is that
  /// point's value; where there is no triangle, NaN.
  std::vector<double> interpolate(const double* values, std::size_t columns, const double* queries,
                                  std::size_t m, SphereCoordinates coordinates);

 private:
  struct FLAUNAY_LOCAL Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flaunay
