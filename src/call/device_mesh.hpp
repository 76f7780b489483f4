// Checks a triangulation that the caller passes, and makes the DeviceMesh that Voronoi diagrams and locators
// use.
#pragma once

#include <cstddef>
#include <vector>

#include "call/engine.hpp"
#include "flaunay/device_memory.hpp"
#include "points/device_mesh.hpp"

namespace flaunay::call {

/// Throws Error(usage) with the message `what` unless the condition holds.
void expect(bool holds, const char* what);

/// Makes a mesh from points and a triangulation in host memory, which are used in place or copied; the mesh
/// is valid until the next wait. All sets are treated as one. Throws Error(usage) for a triangulation without
/// neighbours or of another number of points.
points::DeviceMesh mesh_of(host::Runtime& runtime, const double* coordinates, std::size_t n,
                           const Triangulation& triangulation);
/// Makes a mesh of several sets. Also throws Error(usage) if the triangulation has other sets.
points::DeviceMesh mesh_of(host::Runtime& runtime, const double* coordinates,
                           const std::vector<std::size_t>& offsets, const Triangulation& triangulation);
/// Makes a mesh from points and a triangulation in device memory. Throws Error(usage) if a part is missing.
points::DeviceMesh mesh_of(host::Runtime& runtime, const DevicePoints& points,
                           const DeviceTriangulation& triangulation);
/// The same without the coordinates.
points::DeviceMesh mesh_without_points(host::Runtime& runtime, const DevicePoints& points,
                                       const DeviceTriangulation& triangulation);

/// The setting of a call on host memory other than a triangulation: the triangulator's own memory and queue,
/// and a scope of the scratch arena.
class OwnCall {
 public:
  explicit OwnCall(Engine& self);
  host::Runtime& runtime;

 private:
  host::Arena::Scope scope_;
};

}  // namespace flaunay::call
