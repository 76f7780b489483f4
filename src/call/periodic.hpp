// What calls for points on a torus or a cylinder share.
#pragma once

#include "call/triangulate.hpp"
#include "flaunay/periodic.hpp"

namespace flaunay::call {

/// Throws Error(usage) for a period that is none.
void check(const Period& period);
/// Throws Error(usage) for arrays that are not those of a triangulation on a torus or a cylinder.
void check(const PeriodicTriangulation& mesh);
/// Throws Error(usage), too, if it has places that no call has made.
void check_with_places(const PeriodicTriangulation& mesh);

/// Implement triangulate_periodic. weights: null if points have none.
void triangulate_periodic(Triangulator& triangulator, const double* points,
                          const std::vector<std::size_t>& offsets, const Period& period,
                          const HostWeights* weights, PeriodicTriangulation& result);
void triangulate_periodic(Triangulator& triangulator, const DevicePoints& points, const Period& period,
                          const DeviceWeights* weights, DevicePeriodicTriangulation& result,
                          const Enqueue& enqueue);
/// Implements periodic_cells. weights: null if points have none.
ClippedVoronoi periodic_cells(Triangulator& triangulator, const double* weights,
                              const PeriodicTriangulation& mesh);

}  // namespace flaunay::call
