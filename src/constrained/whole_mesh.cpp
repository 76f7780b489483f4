#include "constrained/whole_mesh.hpp"

#include <fmt/format.h>

#include <utility>

#include "geometry/arguments.hpp"
#include "geometry/magnitudes.hpp"
#include "geometry/predicates.hpp"
#include "mesh/corners.hpp"
#include "mesh/join_sides.hpp"
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

// The predicates of points by their indices.
struct Plane {
  explicit Plane(const std::vector<double>& all)
      : coordinates(all.data()),
        scaling(geometry::scaling_for(coordinates, 0, all.size() / 2,
                                      geometry::inspect(coordinates, 0, all.size() / 2))) {}
  geometry::Point at(std::int32_t v) const { return kernel::scaled_point(v, coordinates, powers); }
  int orient(std::int32_t a, std::int32_t b, std::int32_t c) const {
    return predicates.orient(at(a), at(b), at(c));
  }

  const double* coordinates;
  geometry::Scaling scaling;
  kernel::scaling powers = scaling.powers();
  geometry::Predicates predicates{scaling.bounds};
};

// Whether the triangles of a mesh are all up to the convex hull: by Euler's formula for the inside of its
// hull. Rounding may have made the hull turn to the right.
bool is_whole(const Plane& plane, const Triangulation& mesh) {
  const Ids& hull = mesh.hull;
  std::size_t vertices = 0;
  for (std::size_t i = 0; i < mesh.representatives.size(); ++i) {
    vertices += mesh.representatives[i] == static_cast<std::int32_t>(i);
  }
  if (mesh.triangles.size() / 3 + 2 + hull.size() != 2 * vertices) return false;
  const auto at = [&](std::size_t i) { return hull[i % hull.size()]; };
  for (std::size_t i = 0; i < hull.size(); ++i) {
    if (plane.orient(at(i), at(i + 1), at(i + 2)) < 0) return false;
  }
  return !mesh.triangles.empty();
}

// Throws unless triangles turn to the left, and none has the corner beyond an edge in its circle, unless the
// edge is a constraint.
void check_triangles(const Plane& plane, const ConstrainedTriangulation& mesh) {
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::size_t t = c / 3;
    const std::int32_t* const row = &mesh.triangles[3 * t];
    if (c % 3 == 0 && plane.orient(row[0], row[1], row[2]) <= 0) refuse(t);
    const auto own = static_cast<std::int32_t>(t), beyond = mesh.neighbors[c];
    if (beyond < own || mesh.constrained[c] != 0) continue;
    const std::size_t back = 3 * static_cast<std::size_t>(beyond);
    std::size_t k = 0;
    while (k < 3 && mesh.neighbors[back + k] != own) ++k;
    if (k == 3) refuse(t);
    const auto at = [&](std::int32_t v) { return plane.at(v); };
    if (plane.predicates.circle(at(row[0]), at(row[1]), at(row[2]), at(mesh.triangles[back + k])) > 0)
      refuse(t);
  }
}

// The points on the border of a mesh, and those that are in no triangle, with the border as segments.
struct Border {
  Border(const ConstrainedTriangulation& mesh, const std::vector<double>& all) {
    std::vector<bool> is_inside(all.size() / 2, false);
    for (const std::int32_t v : mesh.triangles) is_inside[v] = true;
    for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
      if (mesh.neighbors[c] >= 0) continue;
      const auto [from, to] = mesh::edge_opposite(mesh.triangles, c);
      is_inside[from] = is_inside[to] = false;
      segments.insert(segments.end(), {from, to});
    }
    Ids places(is_inside.size());
    for (std::size_t v = 0; v < places.size(); ++v) {
      if (is_inside[v]) continue;
      places[v] = static_cast<std::int32_t>(points.size());
      points.push_back(static_cast<std::int32_t>(v));
      coordinates.insert(coordinates.end(), {all[2 * v], all[2 * v + 1]});
    }
    for (std::int32_t& v : segments) v = places[v];
  }
  Ids points;    // their indices in the mesh
  Ids segments;  // by indices here
  std::vector<double> coordinates;
};

// Adds the triangles that are outside of the border, which have depth 0, to the triangles of a mesh.
void add_outside(ConstrainedTriangulation all, const Border& border, Triangulation& mesh) {
  const auto first = static_cast<std::int32_t>(mesh.triangles.size() / 3);
  std::vector<bool> is_outside;
  for (const std::int32_t depth : all.depths) is_outside.push_back(depth == 0);
  const Ids numbers = mesh::numbers_of_kept(is_outside);
  mesh::keep(is_outside, 3, all.triangles);
  mesh::keep(is_outside, 3, all.neighbors);
  for (std::int32_t& t : all.neighbors) t = t < 0 || numbers[t] < 0 ? -1 : first + numbers[t];
  for (Ids* const vertices : {&all.triangles, &all.hull}) {
    for (std::int32_t& v : *vertices) v = border.points[v];
  }
  mesh.triangles.insert(mesh.triangles.end(), all.triangles.begin(), all.triangles.end());
  mesh.neighbors.insert(mesh.neighbors.end(), all.neighbors.begin(), all.neighbors.end());
  mesh.triangle_offsets = {0, mesh.triangles.size() / 3};
  mesh.hull = std::move(all.hull);
  mesh.hull_offsets = {0, mesh.hull.size()};
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
  filled.mesh = mesh;
  const Plane plane(filled.coordinates);
  if (is_whole(plane, mesh)) return filled;
  check_triangles(plane, mesh);
  const Border border(mesh, filled.coordinates);
  Constraints constraints;
  constraints.segments = border.segments.data();
  constraints.segment_count = border.segments.size() / 2;
  add_outside(constrain(border.coordinates, constraints), border, filled.mesh);
  const auto twice = mesh::join_sides(filled.mesh.triangles, filled.mesh.neighbors);
  if (twice) refuse(static_cast<std::size_t>(twice->first) / 3);
  if (!filled.mesh.triangles.empty() && !is_whole(plane, filled.mesh)) {
    throw Error(ErrorKind::input, "a triangle of the constrained triangulation has a point in it");
  }
  return filled;
}

}  // namespace flaunay::constrained
