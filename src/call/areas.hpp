// The areas of the triangles of a result.
#pragma once

#include "call/frame.hpp"

namespace flaunay::call {

/// Writes Triangulation::areas, on threads of the host, if the options ask for them. The points are finite.
void write_areas(const HostPoints& points, const Options& options, Triangulation& result);

}  // namespace flaunay::call
