// Voronoi cells on a torus.
#pragma once

#include "space/spaces.hpp"

namespace flaunay::periodic {

/// See Triangulator::clipped_voronoi.
ClippedVoronoi make_cells(call::Implementation& self, const call::CellInput& input);

}  // namespace flaunay::periodic
