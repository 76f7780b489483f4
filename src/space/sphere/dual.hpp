// Voronoi cells of points on the sphere.
#pragma once

#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"

namespace flaunay::sphere {

/// See Triangulator::voronoi. The mesh is one on the sphere, as a call made it.
Voronoi make_dual(host::Runtime& runtime, const Triangulation& mesh);

/// Per point the direction of the centroid of its cell, by these coordinates: see Triangulator::relax. NaN
/// for points that another one represents, for a point alone, and for cells that are too small to have one.
/// O(t).
std::vector<double> centroids(host::Runtime& runtime, const Triangulation& mesh,
                              SphereCoordinates coordinates);

}  // namespace flaunay::sphere
