// Voronoi cells on a torus.
#pragma once

#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"

namespace flaunay::periodic {

/// See Triangulator::clipped_voronoi. The arrays have been checked, but for what is next to what. O(t).
ClippedVoronoi make_cells(host::Runtime& runtime, const Triangulation& mesh);

}  // namespace flaunay::periodic
