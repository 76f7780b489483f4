// Voronoi cells of points on the sphere.
#pragma once

#include "flaunay/sphere.hpp"
#include "host/runtime.hpp"

namespace flaunay::sphere {

/// See voronoi_on_sphere. The mesh is one that triangulate_sphere made.
SphericalVoronoi make_dual(host::Runtime& runtime, const SphericalTriangulation& mesh);

}  // namespace flaunay::sphere
