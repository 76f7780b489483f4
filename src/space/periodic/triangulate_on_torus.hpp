// Checks that calls for points on a torus or a cylinder share, and cells there.
#pragma once

#include "space/spaces.hpp"

namespace flaunay::call {

/// Throws Error(usage) for a period that is none.
void check(const Period& period);
/// Throws Error(usage) for arrays that are not those of a triangulation on a torus or a cylinder.
void check_on_torus(const Triangulation& mesh);
/// Throws Error(usage), too, if it has places that no call has made.
void check_with_places(const Triangulation& mesh);

}  // namespace flaunay::call

namespace flaunay::periodic {

/// See SpaceCalls.
void check_cells(const Space& space);
/// See Triangulator::clipped_voronoi.
ClippedVoronoi make_cells(call::Implementation& self, const call::CellInput& input);

}  // namespace flaunay::periodic
