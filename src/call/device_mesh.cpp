#include "call/device_mesh.hpp"

#include "call/handles.hpp"
#include "geometry/magnitudes.hpp"

namespace flaunay::call {

void expect(bool holds, const char* what) {
  if (!holds) throw Error(ErrorKind::usage, what);
}

points::DeviceMesh mesh_of(host::Runtime& runtime, const double* coordinates, std::size_t n,
                           const Triangulation& triangulation) {
  expect(n == 0 || coordinates != nullptr, "points, but no coordinates: the pointer is null");
  expect(triangulation.representatives.size() == n, "the triangulation is of another number of points");
  expect(triangulation.neighbors.size() == triangulation.triangles.size(),
         "the triangulation has no neighbours: see Options::neighbors");
  const auto view = [&](const std::vector<std::int32_t>& values) {
    return runtime.view(values.data(), values.size());
  };
  points::DeviceMesh mesh;
  mesh.point_offsets = {0, n};
  mesh.triangle_offsets = {0, triangulation.triangles.size() / 3};
  mesh.hull_offsets = {0, triangulation.hull.size()};
  mesh.coordinates = runtime.view(coordinates, 2 * n);
  mesh.triangles = view(triangulation.triangles);
  mesh.neighbors = view(triangulation.neighbors);
  mesh.hull = view(triangulation.hull);
  mesh.representatives = view(triangulation.representatives);
  return mesh;
}

points::DeviceMesh mesh_of(host::Runtime& runtime, const double* coordinates,
                           const std::vector<std::size_t>& offsets, const Triangulation& triangulation) {
  geometry::check_offsets(offsets);
  expect(triangulation.triangle_offsets.size() == offsets.size() &&
             triangulation.hull_offsets.size() == offsets.size(),
         "the triangulation is of another number of sets");
  points::DeviceMesh mesh = mesh_of(runtime, coordinates, offsets.back(), triangulation);
  expect(triangulation.triangle_offsets.back() == mesh.triangle_count() &&
             triangulation.hull_offsets.back() == triangulation.hull.size(),
         "the triangulation's offsets do not fit its arrays");
  mesh.point_offsets = offsets;
  mesh.triangle_offsets = triangulation.triangle_offsets;
  mesh.hull_offsets = triangulation.hull_offsets;
  return mesh;
}

points::DeviceMesh mesh_of(host::Runtime& runtime, const DevicePoints& points,
                           const DeviceTriangulation& triangulation) {
  points::DeviceMesh mesh = mesh_without_points(runtime, points, triangulation);
  mesh.coordinates = wide_points(runtime, runtime.arena(), points);
  return mesh;
}

points::DeviceMesh mesh_without_points(host::Runtime& runtime, const DevicePoints& points,
                                       const DeviceTriangulation& triangulation) {
  const Parts& parts = triangulation.parts;
  expect(!triangulation.is_constrained, "a constrained triangulation is not the dual of a Voronoi diagram");
  expect(parts.triangles && parts.neighbors && parts.hull && parts.representatives,
         "the parts triangles, neighbors, hull and representatives are needed");
  expect(points.count == triangulation.points, "the triangulation is of another number of points");
  const auto input = [&](const DeviceBuffer& buffer, std::size_t count, const char* what) {
    return input_buffer<cl_int>(runtime, buffer, count, what);
  };
  const std::size_t sets = triangulation.point_offsets.size();
  expect(sets > 0 && triangulation.triangle_offsets.size() == sets &&
             triangulation.hull_offsets.size() == sets && triangulation.point_offsets.back() == points.count,
         "the triangulation's offsets do not fit: was it moved from?");
  points::DeviceMesh mesh;
  mesh.point_offsets = triangulation.point_offsets;
  mesh.triangle_offsets = triangulation.triangle_offsets;
  mesh.hull_offsets = triangulation.hull_offsets;
  mesh.triangles = input(triangulation.triangles, 3 * mesh.triangle_count(), "triangles");
  mesh.neighbors = input(triangulation.neighbors, 3 * mesh.triangle_count(), "neighbors");
  mesh.hull = input(triangulation.hull, mesh.hull_offsets.back(), "hull");
  mesh.representatives = input(triangulation.representatives, points.count, "representatives");
  return mesh;
}

OwnCall::OwnCall(Engine& self) : runtime((self.use_own_memory(), self.runtime)), scope_(runtime.arena()) {
  runtime.use_queue(nullptr, false);
}

}  // namespace flaunay::call
