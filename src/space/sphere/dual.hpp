// Voronoi cells of points on the sphere.
#pragma once

#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"

namespace flaunay::sphere {

/// See Triangulator::voronoi. The mesh is one on the sphere, as a call made it.
Voronoi make_dual(host::Runtime& runtime, const Triangulation& mesh);

}  // namespace flaunay::sphere
