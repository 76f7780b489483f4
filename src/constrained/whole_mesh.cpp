#include "constrained/whole_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "geometry/arguments.hpp"
#include "geometry/magnitudes.hpp"
#include "geometry/predicates.hpp"
#include "geometry/sort.hpp"
#include "mesh/corners.hpp"
#include "mesh/rows.hpp"

namespace flaunay::constrained {
namespace {

using Ids = std::vector<std::int32_t>;

[[noreturn]] void refuse(std::size_t triangle) {
  throw Error(
      ErrorKind::input,
      fmt::format("triangle {} is not that of a constrained triangulation of these points", triangle));
}

void check(const WholeMesh& filled, const ConstrainedTriangulation& mesh) {
  const std::size_t n = filled.coordinates.size() / 2, triangles = mesh.triangles.size() / 3;
  expect(mesh.triangle_offsets.size() == 2 && mesh.hull_offsets.size() == 2,
         "queries in a triangulation with constraints need one set: of polygons, make a map");
  expect(mesh.representatives.size() == n, "the triangulation is of another number of points");
  expect(mesh.neighbors.size() == mesh.triangles.size(),
         "the triangulation has no neighbours: see Options::neighbors");
  expect(mesh.constrained.size() == mesh.triangles.size(),
         "the triangulation does not say which edges are constraints");
  const auto is_in = [](std::int32_t i, std::int32_t first, std::size_t end) {
    return i >= first && (i < 0 || static_cast<std::size_t>(i) < end);
  };
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    if (!is_in(mesh.triangles[c], 0, n) || !is_in(mesh.neighbors[c], -1, triangles)) refuse(c / 3);
  }
  for (const std::int32_t v : mesh.hull) {
    expect(is_in(v, 0, n), "the hull has an index that is no point's");
  }
}

// Whether the triangles of a mesh are all up to the convex hull: by Euler's formula for the inside of its
// hull. Rounding may have made the hull turn to the right.
bool is_whole(const WholeMesh& filled, const ConstrainedTriangulation& mesh) {
  const Ids& hull = mesh.hull;
  std::size_t vertices = 0;
  for (std::size_t i = 0; i < mesh.representatives.size(); ++i) {
    vertices += mesh.representatives[i] == static_cast<std::int32_t>(i);
  }
  if (mesh.triangles.size() / 3 + 2 + hull.size() != 2 * vertices) return false;
  const double* const coordinates = filled.coordinates.data();
  const std::size_t n = filled.coordinates.size() / 2;
  const geometry::Scaling scaling =
      geometry::scaling_for(coordinates, 0, n, geometry::inspect(coordinates, 0, n));
  const geometry::Predicates predicates{scaling.bounds};
  const auto at = [&](std::size_t i) {
    return kernel::scaled_point(hull[i % hull.size()], coordinates, scaling.powers());
  };
  for (std::size_t i = 0; i < hull.size(); ++i) {
    if (predicates.orient(at(i), at(i + 1), at(i + 2)) < 0) return false;
  }
  return !mesh.triangles.empty();
}

// The edges that the whole mesh must have: constraints and the border.
Ids walls(const ConstrainedTriangulation& mesh) {
  Ids segments;
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::int32_t beyond = mesh.neighbors[c];
    if (beyond >= 0 && (mesh.constrained[c] == 0 || static_cast<std::size_t>(beyond) < c / 3)) continue;
    const auto [from, to] = mesh::edge_opposite(mesh.triangles, c);
    segments.insert(segments.end(), {from, to});
  }
  return segments;
}

// Triangles in the order of their first edges; no two have the same. Triangles have their smallest corner
// first.
std::vector<geometry::Keyed> by_edge(const Ids& triangles) {
  std::vector<geometry::Keyed> sorted(triangles.size() / 3);
  for (std::size_t t = 0; t < sorted.size(); ++t) {
    sorted[t] = {
        static_cast<std::uint64_t>(triangles[3 * t]) << 32 | static_cast<std::uint32_t>(triangles[3 * t + 1]),
        static_cast<std::int32_t>(t)};
  }
  geometry::sort_by_key(sorted);
  return sorted;
}

// Moves the triangles of `mesh` to the front in `whole`, in their order.
void reorder(const ConstrainedTriangulation& mesh, Triangulation& whole) {
  const std::size_t all = whole.triangles.size() / 3;
  const std::vector<geometry::Keyed> of_whole = by_edge(whole.triangles);
  Ids place(all, -1);
  auto from = of_whole.begin();
  for (const auto& [edge, t] : by_edge(mesh.triangles)) {
    while (from != of_whole.end() && from->key < edge) ++from;
    const auto corners = mesh.triangles.begin() + 3 * std::ptrdiff_t{t};
    if (from == of_whole.end() || place[static_cast<std::size_t>(from->index)] >= 0 ||
        !std::equal(corners, corners + 3, whole.triangles.begin() + 3 * std::ptrdiff_t{from->index})) {
      refuse(static_cast<std::size_t>(t));
    }
    place[static_cast<std::size_t>(from->index)] = t;
  }
  auto next = static_cast<std::int32_t>(mesh.triangles.size() / 3);
  for (std::int32_t& t : place) t = t < 0 ? next++ : t;
  mesh::permute(place, 3, whole.triangles);
  mesh::permute(place, 3, whole.neighbors);
  for (std::int32_t& t : whole.neighbors) t = t < 0 ? t : place[static_cast<std::size_t>(t)];
}

}  // namespace

WholeMesh fill(const double* coordinates, std::size_t n, const ConstrainedTriangulation& mesh,
               const Constrain& constrain) {
  check_points(coordinates, n);
  WholeMesh filled;
  filled.coordinates.assign(coordinates, coordinates + 2 * n);
  filled.coordinates.insert(filled.coordinates.end(), mesh.added_points.begin(), mesh.added_points.end());
  check(filled, mesh);
  filled.constrained = mesh.constrained;
  if (is_whole(filled, mesh)) {
    filled.mesh = mesh;
    return filled;
  }
  const Ids segments = walls(mesh);
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  filled.mesh = constrain(filled.coordinates, constraints);
  reorder(mesh, filled.mesh);
  return filled;
}

}  // namespace flaunay::constrained
