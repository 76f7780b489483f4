// Weighted points: regular triangulations and power diagrams.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.hpp"
#include "flaunay/periodic.hpp"

namespace flaunay {

/// The regular triangulations of one or more sets of weighted points: the lower hulls of the points at height
/// x^2 + y^2 - weight. Its representatives are of points that have the same coordinates and weight.
struct WeightedTriangulation : Triangulation {
  /// The points without a power cell, in ascending order: they lie on or above what other points of their set
  /// span, and are in no triangle. Those that another point represents are not among them.
  std::vector<std::int32_t> hidden;
};

/// Computes the regular triangulation of n points, x0 y0 x1 y1 ..., whose weights are squared lengths, of any
/// sign: of circles, the squared radii. The result is exact, a function of the set of weighted points, and
/// with equal weights the Delaunay triangulation, to the byte. Where more than three lifted points are on a
/// plane, those that are no corners of their hull there are hidden; the others' polygon is triangulated as
/// the farthest-point Delaunay triangulation, and where these are cocircular, as a fan from the
/// lexicographically smallest one. Runs on the device that was named, if it has double precision; otherwise
/// on the host's cores. Throws what Triangulator::triangulate throws; Error(input) also for a weight that is
/// not finite, or beyond the squares of what coordinates may be. O(n log n) work.
FLAUNAY_API WeightedTriangulation triangulate_weighted(Triangulator& triangulator, const double* points,
                                                       const double* weights, std::size_t n,
                                                       const Options& options = {});
/// Triangulates many sets at once. Set s has points [offsets[s], offsets[s + 1]).
FLAUNAY_API WeightedTriangulation triangulate_weighted(Triangulator& triangulator, const double* points,
                                                       const double* weights,
                                                       const std::vector<std::size_t>& offsets,
                                                       const Options& options = {});

/// A WeightedTriangulation in device memory.
struct DeviceWeightedTriangulation : DeviceTriangulation {
  DeviceBuffer hidden;           ///< WeightedTriangulation::hidden, int32; a caller's buffer has 4 n bytes
  std::size_t hidden_count = 0;  ///< number of hidden points, known when the call returns
};

/// Triangulates points in device memory, in one or more sets, into device memory: the same bytes. weights:
/// double, 8 bytes per point to use. The host waits about twice as often as for Triangulator::triangulate;
/// otherwise the work is enqueued like that of triangulate for device memory, with the same errors, but in
/// memory of the triangulator's own. Devices without double precision leave it to the host.
FLAUNAY_API void triangulate_weighted(Triangulator& triangulator, const DevicePoints& points, cl_mem weights,
                                      DeviceWeightedTriangulation& result,
                                      const Parts& parts = triangles_alone(),
                                      const Enqueue& enqueue = own_queue());

/// Returns for each hidden point the triangle that hides it, exactly: the one of the smallest index that has
/// it inside or on its border. -1 in a set without triangles. points, offsets: those that were triangulated.
/// The triangulation must have neighbours. Throws Error(usage) for arrays that do not fit each other.
/// O(n + h log n) for h hidden points.
FLAUNAY_API std::vector<std::int32_t> hiding_triangles(Triangulator& triangulator, const double* points,
                                                       const std::vector<std::size_t>& offsets,
                                                       const WeightedTriangulation& triangulation);

/// Computes the power cells of n points, clipped to a convex polygon: of each point the places whose power,
/// the squared distance less the weight, is least for it. Vertices, areas and centroids are rounded; polygons
/// are simple, and tile. Points without a cell in the polygon, such as hidden ones, have no vertices.
/// corners: as of Triangulator::clipped_voronoi, with its errors. The triangulation is of one set, with
/// neighbours; throws Error(usage) for arrays that do not fit each other. O(n k) for k corners, but for
/// points with very many neighbours.
FLAUNAY_API ClippedVoronoi power_cells(Triangulator& triangulator, const double* points,
                                       const double* weights, std::size_t n,
                                       const WeightedTriangulation& triangulation, const double* corners,
                                       std::size_t corner_count);

/// The regular triangulations of one or more sets of weighted points on a torus or a cylinder. There are as
/// many triangles as PeriodicTriangulation has for the points that are not hidden.
struct WeightedPeriodicTriangulation : PeriodicTriangulation {
  /// As WeightedTriangulation::hidden; points are hidden by images, too.
  std::vector<std::int32_t> hidden;
};

/// Triangulates n weighted points on a torus or a cylinder: the regular triangulation of all images of all
/// points, which have the weights of their points, as triangulate_periodic without weights does. A point's
/// place is rounded, its weight is not. Throws what that and triangulate_weighted throw. O(n log n) work.
FLAUNAY_API WeightedPeriodicTriangulation triangulate_periodic(Triangulator& triangulator,
                                                               const double* points, const double* weights,
                                                               std::size_t n, const Period& period);
/// Triangulates many sets at once. Set s has points [offsets[s], offsets[s + 1]).
FLAUNAY_API WeightedPeriodicTriangulation triangulate_periodic(Triangulator& triangulator,
                                                               const double* points, const double* weights,
                                                               const std::vector<std::size_t>& offsets,
                                                               const Period& period);

/// A WeightedPeriodicTriangulation in device memory.
struct DeviceWeightedPeriodicTriangulation : DevicePeriodicTriangulation {
  DeviceBuffer hidden;           ///< as of DeviceWeightedTriangulation
  std::size_t hidden_count = 0;  ///< as of DeviceWeightedTriangulation
};

/// Triangulates points in device memory into device memory: the same bytes. See both calls for device memory
/// that have weights or a period.
FLAUNAY_API void triangulate_periodic(Triangulator& triangulator, const DevicePoints& points, cl_mem weights,
                                      const Period& period, DeviceWeightedPeriodicTriangulation& result,
                                      const Enqueue& enqueue = own_queue());

/// Computes the power cells on the torus, as periodic_cells does Voronoi cells. weights: those that were
/// triangulated. A point may lie outside of its cell. Hidden points have no vertices. O(n).
FLAUNAY_API ClippedVoronoi periodic_cells(Triangulator& triangulator, const double* weights,
                                          const WeightedPeriodicTriangulation& triangulation);

}  // namespace flaunay
