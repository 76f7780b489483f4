// Voronoi cells on a torus.
#pragma once

#include "flaunay/periodic.hpp"
#include "host/runtime.hpp"

namespace flaunay::periodic {

/// See periodic_cells. The arrays have been checked, but for what is next to what. weights: null if points
/// have none. O(t).
ClippedVoronoi make_cells(host::Runtime& runtime, const PeriodicTriangulation& mesh, const double* weights);

}  // namespace flaunay::periodic
