#include "call/mesh_of.hpp"

#include <algorithm>

#include "geometry/arguments.hpp"

namespace flaunay::call {
namespace {

constexpr const char* kOtherSpace = "the triangulation is not one in the plane";

}  // namespace

points::DeviceMesh mesh_of(Frame& call, const HostPoints& points, const Triangulation& triangulation) {
  const std::size_t n = points.count;
  check_points(points.wide, n);
  expect(triangulation.space.kind == SpaceKind::plane, kOtherSpace);
  expect(triangulation.representatives.size() == n, "the triangulation is of another number of points");
  expect(triangulation.neighbors.size() == triangulation.triangles.size(),
         "the triangulation has no neighbours: see Options::neighbors");
  points::DeviceMesh mesh;
  mesh.point_offsets = {0, n};
  mesh.triangle_offsets = {0, triangulation.triangles.size() / 3};
  mesh.hull_offsets = {0, triangulation.hull.size()};
  mesh.triangles = call.in(triangulation.triangles);
  mesh.neighbors = call.in(triangulation.neighbors);
  mesh.hull = call.in(triangulation.hull);
  mesh.representatives = call.in(triangulation.representatives);
  return mesh;
}

points::DeviceMesh mesh_of(Frame& call, const HostPoints& points, const std::vector<std::size_t>& offsets,
                           const Triangulation& triangulation) {
  check_offsets(offsets);
  expect(triangulation.triangle_offsets.size() == offsets.size() &&
             triangulation.hull_offsets.size() == offsets.size(),
         "the triangulation is of another number of sets");
  points::DeviceMesh mesh = mesh_of(call, points, triangulation);
  expect(triangulation.triangle_offsets.back() == mesh.triangle_count() &&
             triangulation.hull_offsets.back() == triangulation.hull.size(),
         "the triangulation's offsets do not fit its arrays");
  mesh.point_offsets = offsets;
  mesh.triangle_offsets = triangulation.triangle_offsets;
  mesh.hull_offsets = triangulation.hull_offsets;
  return mesh;
}

points::DeviceMesh mesh_with_sets(Frame& call, const HostPoints& points, const Triangulation& triangulation) {
  points::DeviceMesh mesh = mesh_of(call, points, triangulation);
  const std::size_t sets = triangulation.triangle_offsets.size() - 1;
  expect(!triangulation.triangle_offsets.empty() &&
             are_offsets(triangulation.triangle_offsets, sets, mesh.triangle_count()) &&
             are_offsets(triangulation.hull_offsets, sets, triangulation.hull.size()),
         "the triangulation's offsets do not fit its arrays");
  mesh.triangle_offsets = triangulation.triangle_offsets;
  mesh.hull_offsets = triangulation.hull_offsets;
  // A set's first point equals no earlier one, so it is a vertex.
  mesh.point_offsets.assign(sets + 1, points.count);
  for (std::size_t s = sets; s-- > 0;) {
    std::size_t& first = mesh.point_offsets[s];
    first = s > 0 ? mesh.point_offsets[s + 1] : 0;
    const auto look = [&](const std::vector<std::int32_t>& ids, std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end && s > 0; ++k)
        first = std::min(first, static_cast<std::size_t>(ids[k]));
    };
    look(triangulation.triangles, 3 * mesh.triangle_offsets[s], 3 * mesh.triangle_offsets[s + 1]);
    look(triangulation.hull, mesh.hull_offsets[s], mesh.hull_offsets[s + 1]);
  }
  return mesh;
}

points::DeviceMesh mesh_of(Frame& call, const DevicePoints& points,
                           const DeviceTriangulation& triangulation) {
  const Parts& parts = triangulation.parts;
  expect(!triangulation.is_constrained, "a constrained triangulation is not the dual of a Voronoi diagram");
  expect(triangulation.space.kind == SpaceKind::plane, kOtherSpace);
  expect(parts.triangles && parts.neighbors && parts.hull && parts.representatives,
         "the parts triangles, neighbors, hull and representatives are needed");
  expect(points.count == triangulation.points, "the triangulation is of another number of points");
  const std::size_t sets = triangulation.point_offsets.size();
  expect(sets > 0 && triangulation.triangle_offsets.size() == sets &&
             triangulation.hull_offsets.size() == sets && triangulation.point_offsets.back() == points.count,
         "the triangulation's offsets do not fit: was it moved from?");
  points::DeviceMesh mesh;
  mesh.point_offsets = triangulation.point_offsets;
  mesh.triangle_offsets = triangulation.triangle_offsets;
  mesh.hull_offsets = triangulation.hull_offsets;
  const std::size_t corners = 3 * mesh.triangle_count();
  mesh.triangles = call.in<cl_int>(triangulation.triangles.memory(), corners, "triangles");
  mesh.neighbors = call.in<cl_int>(triangulation.neighbors.memory(), corners, "neighbors");
  mesh.hull = call.in<cl_int>(triangulation.hull.memory(), mesh.hull_offsets.back(), "hull");
  mesh.representatives =
      call.in<cl_int>(triangulation.representatives.memory(), points.count, "representatives");
  return mesh;
}

}  // namespace flaunay::call
