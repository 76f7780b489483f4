// Checks a triangulation that the caller passes, and makes the DeviceMesh that Voronoi diagrams and locators
// use.
#pragma once

#include <cstddef>
#include <vector>

#include "call/frame.hpp"
#include "points/device_mesh.hpp"

namespace flaunay::call {

// Each makes a mesh without coordinates in a call; Frame::points makes those. Throws Error(usage) for a
// triangulation of another number of points, or without neighbours.

/// From host memory. All sets are treated as one.
points::DeviceMesh mesh_of(Frame& call, const HostPoints& points, const Triangulation& triangulation);
/// From host memory, of several sets. Also throws Error(usage) if the triangulation has other sets.
points::DeviceMesh mesh_of(Frame& call, const HostPoints& points, const std::vector<std::size_t>& offsets,
                           const Triangulation& triangulation);
/// From host memory, of the triangulation's own sets. Also throws Error(usage) if its offsets do not fit.
points::DeviceMesh mesh_with_sets(Frame& call, const HostPoints& points, const Triangulation& triangulation);
/// From device memory. Also throws Error(usage) if a part is missing.
points::DeviceMesh mesh_of(Frame& call, const DevicePoints& points, const DeviceTriangulation& triangulation);
inline points::DeviceMesh mesh_with_sets(Frame& call, const DevicePoints& points,
                                         const DeviceTriangulation& triangulation) {
  return mesh_of(call, points, triangulation);
}

}  // namespace flaunay::call
