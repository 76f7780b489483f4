// Voronoi cells on a torus.
#pragma once

#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"

namespace flaunay::periodic {

/// See Triangulator::clipped_voronoi. The arrays have been checked, but for what is next to what. weights:
/// null if points have none. O(t).
ClippedVoronoi make_cells(host::Runtime& runtime, const Triangulation& mesh, const double* weights);

}  // namespace flaunay::periodic
