// Points on a torus or a cylinder: a plane that repeats itself in x and y, or in one of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "flaunay/chunks.hpp"
#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay {

/// Where the plane begins again: a place x farther along x, and a place y farther along y and `shear` along
/// x.
struct Period {
  /// From 2^-900 to 2^900 (about 1.2e-271 to 8.4e270), and at most 2^30 times the other. If one is infinite,
  /// the plane does not repeat itself in that direction: it is a cylinder.
  double x = 1;
  double y = 1;  ///< see x
  /// Any finite number, which is reduced by multiples of x. On a cylinder it must be 0. If it is not a
  /// multiple of x, then x may be at most 64 times y.
  double shear = 0;
};

/// The Delaunay triangulations of one or more sets of points on a torus or a cylinder.
struct PeriodicTriangulation {
  /// As given, but for the last bit of a double, which is 0 unless the period is a power of two. The shear is
  /// more than -x / 2 and at most x / 2, a multiple of what x of places is. With a shear, y is a multiple of
  /// 2^-52 times the first power of two that is at least y + x / 2.
  Period period;
  /// x and y per point: its place in [0, period), a multiple of the period's last bit but one, or of the last
  /// bit if it is a power of two; with a shear, y as that of the period. They are rounded once, to half of
  /// that, and are then what the point is: so every image of a point is exact. What has no period is not
  /// rounded.
  std::vector<double> places;
  /// 3 per triangle, counter-clockwise, smallest index first. n different points on a torus have 2 n, and on
  /// a cylinder 2 n - h, if h of them are on its lowest and its highest circle: none if all are on one.
  std::vector<std::int32_t> triangles;
  /// 6 per triangle: i and j per corner. If the first corner is in its place, the corner is i (x, 0) +
  /// j (shear, y) away from its place. The first corner has 0, 0; the others -1, 0 or 1. With a shear they
  /// are from -2 to 2 if x is at most y, and otherwise |j| < 2 + x / y and |i| < 2 + |j| / 2. They tell apart
  /// corners that are the same point, as few points have them.
  std::vector<std::int8_t> offsets;
  /// 3 per triangle: the triangle opposite to each corner. There is always one on a torus; -1 is beyond the
  /// ends of a cylinder.
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

/// Triangulates n points on a torus or a cylinder, x0 y0 x1 y1 ...; any finite numbers, which are taken into
/// the period. The result is exact, and a function of the set of places: the Delaunay triangulation of all
/// images of all points, of which it has each triangle once, however few points there are. Where more than
/// three points are cocircular, their polygon is a fan from its lexicographically smallest vertex. Triangles
/// are in the order that they have in the plane, which the number of points given has a part in. Images of
/// points near the border are triangulated with the points. Throws what Triangulator::triangulate throws;
/// Error(usage) also for a period that is none. O(n log n) work.
FLAUNAY_API PeriodicTriangulation triangulate_periodic(Triangulator& triangulator, const double* points,
                                                       std::size_t n, const Period& period);
/// Triangulates many sets at once. Set s has points [offsets[s], offsets[s + 1]).
FLAUNAY_API PeriodicTriangulation triangulate_periodic(Triangulator& triangulator, const double* points,
                                                       const std::vector<std::size_t>& offsets,
                                                       const Period& period);

/// Takes n points, x0 y0 x1 y1 ..., to their places in the period, as triangulate_periodic does. Returns the
/// period as it is rounded. Throws Error(usage) for a period that is none, and Error(input) for points that
/// are not finite. O(n).
FLAUNAY_API Period take_to_places(const Period& period, double* points, std::size_t n);

/// Where a triangulation on a torus or a cylinder is written, in pieces. There is no hull.
class FLAUNAY_API PeriodicMeshSink : public MeshSink {
 public:
  ~PeriodicMeshSink() override;
  /// Stores `count` values as the entries [first, first + count) of PeriodicTriangulation::offsets; throws an
  /// Error if it cannot. It is called for all triangles, in any order.
  virtual void write_offsets(std::uint64_t first, const std::int8_t* offsets, std::size_t count) = 0;
};

/// Triangulates one set of points on a torus or a cylinder in chunks, as triangulate_chunks does in the
/// plane. The set of triangles with their offsets and neighbours, and the representatives are those of
/// triangulate_periodic; rows are in the order that triangulate_chunks says, and indices are 64-bit numbers.
///
/// First, all points are read once more, on a cylinder twice, to find those near the border ("images" for
/// progress). Their images are held in memory and count as 48 bytes each, beside what chunks need. If these
/// were too few, which is found out at the end, all begins again with a wider margin, and everything is
/// written again. So there may be rows of no use beyond the number of triangles that is returned, but never
/// more than 2 n. Statistics are of the last time; rounds count images as points. Throws what
/// triangulate_periodic and triangulate_chunks throw; Error(input), too, if the images do not fit
/// memory_bytes, as if most points are near the border. O(n log n) work.
FLAUNAY_API ChunkStatistics triangulate_periodic_chunks(PointSource& points, const Period& period,
                                                        PeriodicMeshSink& sink,
                                                        const ChunkOptions& options = {});
/// Points and results are in memory; there is no hull. offsets: room for 12 n numbers, or null. Throws as the
/// triangulate_chunks that has these arrays, too.
FLAUNAY_API ChunkStatistics triangulate_periodic_chunks(const double* coordinates, std::uint64_t n,
                                                        const Period& period,
                                                        const MeshArrays<std::int32_t>& results,
                                                        std::int8_t* offsets,
                                                        const ChunkOptions& options = {});
/// Results have 64-bit indices.
FLAUNAY_API ChunkStatistics triangulate_periodic_chunks(const double* coordinates, std::uint64_t n,
                                                        const Period& period,
                                                        const MeshArrays<std::int64_t>& results,
                                                        std::int8_t* offsets,
                                                        const ChunkOptions& options = {});

/// A PeriodicTriangulation in device memory. For n points the caller's buffers must have, and flaunay's have,
/// the sizes given here.
struct DevicePeriodicTriangulation {
  DeviceBuffer places;                     ///< PeriodicTriangulation::places, double2, 16 n bytes
  DeviceBuffer triangles;                  ///< PeriodicTriangulation::triangles, int32, 24 n bytes
  DeviceBuffer offsets;                    ///< PeriodicTriangulation::offsets, char, 12 n bytes
  DeviceBuffer neighbors;                  ///< PeriodicTriangulation::neighbors, int32, 24 n bytes
  DeviceBuffer representatives;            ///< PeriodicTriangulation::representatives, int32, 4 n bytes
  Period period;                           ///< PeriodicTriangulation::period; the rest is in host memory, too
  std::vector<std::size_t> point_offsets;  ///< PeriodicTriangulation::point_offsets
  std::vector<std::size_t> triangle_offsets;  ///< PeriodicTriangulation::triangle_offsets
  std::size_t images = 0;                     ///< PeriodicTriangulation::images
  Statistics statistics;                      ///< of the call
};

/// Triangulates points in device memory, in one or more sets, into device memory: the same bytes. The host
/// joins what meets at the border, about the square root of n triangles, and waits about 5 times more than
/// for Triangulator::triangulate; otherwise the work is enqueued like that of triangulate for device memory,
/// with the same errors. Devices without double precision leave it to the host.
FLAUNAY_API void triangulate_periodic(Triangulator& triangulator, const DevicePoints& points,
                                      const Period& period, DevicePeriodicTriangulation& result,
                                      const Enqueue& enqueue = own_queue());

/// Computes the Voronoi cells on the torus, each around its point's place, so that some reach beyond the
/// period. Vertices are rounded to the units of the period, so that their images are exact, and are those of
/// ClippedVoronoi: simple polygons that tile the torus. The areas of a set's cells sum to that of the period.
/// Points that another one represents have no vertices. Throws Error(usage) for arrays that are none's, and
/// for a cylinder, where cells have no end. O(n).
FLAUNAY_API ClippedVoronoi periodic_cells(Triangulator& triangulator,
                                          const PeriodicTriangulation& triangulation);

/// Answers queries on a torus or a cylinder with one set of points. Queries are any places of the plane, and
/// are rounded to places as points are. They are answered in the plane, with images of points around the box.
class FLAUNAY_API PeriodicLocator {
 public:
  /// Makes a locator, which copies what it needs: as a Locator does, for points and their images; on a
  /// cylinder for three times as many. Throws Error(usage) for several sets and for arrays that are no
  /// triangulation's. O(n log n).
  PeriodicLocator(Triangulator& triangulator, const PeriodicTriangulation& triangulation);
  ~PeriodicLocator();
  /// A locator that was moved from can only be destroyed or assigned to.
  PeriodicLocator(PeriodicLocator&&) noexcept;
  /// Releases the memory of the locator that is assigned to.
  PeriodicLocator& operator=(PeriodicLocator&&) noexcept;

  /// Finds for each of m queries a triangle that contains it, exactly; on an edge or at a corner always the
  /// same one. It is -1 beyond the ends of a cylinder, and if there are no triangles.
  std::vector<std::int32_t> locate(const double* queries, std::size_t m);
  /// Finds for each of m queries the nearest point, exactly; of several the first one in the order of x, then
  /// y, as they lie around the query's place. It is -1 if there are no points.
  std::vector<std::int32_t> nearest(const double* queries, std::size_t m);
  /// Computes values at m queries as Locator::interpolate does, rounded: options.columns numbers per point
  /// and per query. At a point the result is exactly that point's value; beyond the ends of a cylinder, and
  /// without triangles, options.fill. For duplicates, the value of their representative is used. Throws
  /// Error(usage) for gradients and Clough-Tocher; Error(input) for the natural neighbors of so few points
  /// that a circle without points is wider than the shorter period, with its centre between the ends of a
  /// cylinder.
  std::vector<double> interpolate(const double* values, const double* queries, std::size_t m,
                                  const InterpolationOptions& options = {});

 private:
  struct FLAUNAY_LOCAL Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flaunay
