// The areas of the triangles of a result.
#pragma once

#include "call/frame.hpp"

namespace flaunay::call {

/// Writes Triangulation::areas, which the engine computes unless they are few. The points are finite. Resets
/// the engine's accounts.
void write_areas(Engine& engine, const HostPoints& points, Triangulation& result);
/// Computes them on the calling thread.
void write_areas(const HostPoints& points, Triangulation& result);

}  // namespace flaunay::call
