// The C interface to triangulations that the caller keeps as arrays, and tables made from their triangles.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "c/errors.hpp"
#include "c/handles.hpp"
#include "flaunay/flaunay.h"
#include "flaunay/sphere.hpp"
#include "flaunay/verify.hpp"
#include "flaunay/weighted.hpp"
#include "geometry/triangles.hpp"

using namespace flaunay;

using c::create;
using c::guarded;
using c::required;

namespace {

using Indices = std::vector<std::int32_t>;

// Throws Error(usage) for an index that is not from `lowest` to n - 1. name: the array; what: that of which
// there are n.
void check_each(const Indices& given, std::int32_t lowest, std::size_t n, const char* name,
                const char* what) {
  for (const std::int32_t index : given) {
    if (index < lowest || index >= static_cast<std::int64_t>(n)) {
      throw Error(ErrorKind::usage, fmt::format("{}: {} is none of the {} {}", name, index, n, what));
    }
  }
}

// A copy of the caller's indices, in `rows` rows of so many columns, from `lowest` to n - 1. They are checked
// in the copy, since the caller's other threads may change the original. name: the array; what: that of which
// there are n.
Indices checked(const std::int32_t* given, std::size_t rows, std::size_t columns, std::int32_t lowest,
                std::size_t n, const char* name, const char* what) {
  check_array(given, rows, name, kMostIndexed / columns);
  Indices copy(given, given + rows * columns);
  check_each(copy, lowest, n, name, what);
  return copy;
}

Indices checked_corners(const std::int32_t* triangles, std::size_t t, std::size_t n) {
  check_count(n, "points");
  return checked(triangles, t, 3, 0, n, "triangles", "points");
}

// Throws Error(usage) for an index that is out of range.
void check_indices(const Triangulation& mesh) {
  const std::size_t n = mesh.representatives.size(), triangles = mesh.triangles.size() / 3;
  check_each(mesh.triangles, 0, n, "triangles", "points");
  check_each(mesh.neighbors, -1, triangles, "neighbors", "triangles");
  check_each(mesh.hull, 0, n, "hull vertices", "points");
  check_each(mesh.representatives, 0, n, "representatives", "points");
  check_each(mesh.hidden, 0, n, "hidden points", "points");
}

// Calls visit(from, to) for each edge of a mesh from each of its ends: a triangle has its edges one way
// round, and edges without a triangle on the other side are on the hull.
template <typename Visit>
void for_each_edge(const Indices& corners, const Indices& hull, const Visit& visit) {
  for (std::size_t t = 0; t < corners.size(); t += 3) {
    for (std::size_t k = 0; k < 3; ++k) visit(corners[t + k], corners[t + (k + 1) % 3]);
  }
  for (std::size_t i = 0; i < hull.size(); ++i) visit(hull[(i + 1) % hull.size()], hull[i]);
}

// Checks the caller's triangles and calls work(triangles, results), unless there are none.
template <typename Result, typename Work>
flaunay_status measure(const double* coordinates, std::size_t n, const std::int32_t* corners, std::size_t t,
                       Result* results, const Work& work) {
  return guarded([&] {
    check_points(coordinates, n);
    const Indices copy = checked_corners(corners, t, n);
    check_array(results, t, "results");
    if (t > 0) work(geometry::Triangles(coordinates, n, copy), results);
  });
}

}  // namespace

namespace flaunay::c {

std::vector<std::size_t> copied_offsets(const std::size_t* offsets, std::size_t count, std::size_t size) {
  if (offsets == nullptr && count <= 1) return {0, size};
  check_array(offsets, count, "offsets", kMostIndexed);
  return {offsets, offsets + count + 1};
}

void copy_to(Triangulation& triangulation, const flaunay_mesh& mesh) {
  check_count(mesh.triangle_count, "triangles", kMostIndexed / 3);
  constexpr bool always = true, on_request = false;
  const std::size_t triangle = mesh.triangle_count, halfedge = 3 * triangle, hull = mesh.hull_count,
                    point = mesh.point_count;
#define COPY_IN_SPACE(type, name, row, columns) COPY(type, name, row, columns, on_request)
#define COPY(type, name, row, columns, asked, ...) \
  triangulation.name = copied(mesh.name, columns * row, "values of " #name, !asked);
  FLAUNAY_TRIANGULATION_ARRAYS(COPY)
  const std::size_t hidden = mesh.hidden_count;
  FLAUNAY_SPACE_ARRAYS(COPY_IN_SPACE)
#undef COPY_IN_SPACE
#undef COPY
  triangulation.space = to_space(mesh.space);
  triangulation.images = mesh.image_count;
  triangulation.is_weighted = mesh.is_weighted != 0 || hidden > 0;
  triangulation.triangle_offsets = copied_offsets(mesh.triangle_offsets, mesh.set_count, mesh.triangle_count);
  if (triangulation.space.kind == SpaceKind::plane) {
    triangulation.hull_offsets = copied_offsets(mesh.hull_offsets, mesh.set_count, mesh.hull_count);
  } else {
    triangulation.point_offsets = copied_offsets(mesh.point_offsets, mesh.set_count, mesh.point_count);
  }
}

}  // namespace flaunay::c

flaunay_status flaunay_triangulation_create(const flaunay_mesh* mesh,
                                            const flaunay_constrained_arrays* constraints,
                                            flaunay_triangulation** triangulation) {
  return create(triangulation, [&] {
    const flaunay_mesh& given = required(mesh, "the mesh");
    const auto complete = [](Triangulation& made) {
      check_indices(made);
      made.statistics.points = made.representatives.size();
      made.statistics.triangles = made.triangles.size() / 3;
      made.statistics.hull_vertices = made.hull.size();
    };
    if (constraints == nullptr) {
      Triangulation made;
      c::copy_to(made, given);
      complete(made);
      return std::make_unique<flaunay_triangulation>(std::move(made));
    }
    ConstrainedTriangulation made;
    c::copy_to(made, given, *constraints);
    complete(made);
    return std::make_unique<flaunay_triangulation>(std::move(made));
  });
}

flaunay_status flaunay_mesh_verify(const flaunay_mesh* mesh, const double* coordinates, const size_t* offsets,
                                   const flaunay_space* space) {
  return c::verified([&] {
    const flaunay_mesh& given = required(mesh, "the mesh");
    Triangulation triangulation;
    c::copy_to(triangulation, given);
    return verify(coordinates, c::copied_offsets(offsets, given.set_count, given.point_count),
                  c::to_space(space), triangulation);
  });
}

flaunay_status flaunay_hiding_triangles(flaunay_triangulator* triangulator, const double* points,
                                        const size_t* offsets, size_t sets,
                                        const flaunay_triangulation* triangulation, int32_t* triangles) {
  return c::with(triangulator, [&](Triangulator& cpp) {
    const Triangulation& mesh = required(triangulation, "the triangulation").plain();
    c::copy_to(triangles,
               hiding_triangles(cpp, points, c::to_offsets(offsets, sets, mesh.representatives.size()), mesh),
               "results");
  });
}

flaunay_status flaunay_directions(const double* places, size_t n, double* directions) {
  return guarded([&] {
    check_array(places, n, "places of points", kMostIndexed / 2);
    check_array(directions, n, "directions");
    c::copy_to(directions, directions_of({places, places + 2 * n}), "directions");
  });
}

flaunay_status flaunay_first_triangles(const int32_t* triangles, size_t t, size_t n, int32_t* first) {
  return guarded([&] {
    const Indices corners = checked_corners(triangles, t, n);
    check_array(first, n, "results");
    std::fill_n(first, n, -1);
    for (std::size_t i = corners.size(); i-- > 0;) first[corners[i]] = static_cast<std::int32_t>(i / 3);
  });
}

flaunay_status flaunay_vertex_neighbors(const int32_t* triangles, size_t t, const int32_t* hull, size_t h,
                                        size_t n, int32_t* starts, int32_t* neighbors) {
  return guarded([&] {
    const Indices corners = checked_corners(triangles, t, n);
    Indices ring = checked(hull, h, 1, 0, n, "hull vertices", "points");
    // Points on one line have no edges.
    if (t == 0) ring.clear();
    check_array(starts, n + 1, "starts");
    check_array(neighbors, corners.size() + ring.size(), "neighbours");
    std::fill_n(starts, n + 1, 0);
    if (t == 0) return;
    for_each_edge(corners, ring, [&](std::int32_t from, std::int32_t) { ++starts[from + 1]; });
    for (std::size_t i = 0; i < n; ++i) starts[i + 1] += starts[i];
    Indices next(starts, starts + n);
    for_each_edge(corners, ring, [&](std::int32_t from, std::int32_t to) { neighbors[next[from]++] = to; });
    for (std::size_t i = 0; i < n; ++i) std::sort(neighbors + starts[i], neighbors + starts[i + 1]);
  });
}

flaunay_status flaunay_triangle_turns(const double* coordinates, size_t n, const int32_t* triangles, size_t t,
                                      int8_t* turns) {
  return measure(coordinates, n, triangles, t, turns, [](const auto& of, int8_t* results) {
    for (std::size_t i = 0; i < of.size(); ++i) results[i] = static_cast<int8_t>(of.turn(i));
  });
}

flaunay_status flaunay_triangle_areas(const double* coordinates, size_t n, const int32_t* triangles, size_t t,
                                      double* areas) {
  return measure(coordinates, n, triangles, t, areas, [](const auto& of, double* results) {
    for (std::size_t i = 0; i < of.size(); ++i) results[i] = of.area(i);
  });
}

flaunay_status flaunay_triangle_angles(const double* coordinates, size_t n, const int32_t* triangles,
                                       size_t t, int8_t* angles) {
  return measure(coordinates, n, triangles, t, angles, [](const auto& of, int8_t* results) {
    for (std::size_t i = 0; i < of.size(); ++i) {
      for (int k = 0; k < 3; ++k) results[3 * i + k] = static_cast<int8_t>(of.angle(i, k));
    }
  });
}

flaunay_status flaunay_circumradii(const double* coordinates, size_t n, const int32_t* triangles, size_t t,
                                   double* radii) {
  return measure(coordinates, n, triangles, t, radii, [](const auto& of, double* results) {
    for (std::size_t i = 0; i < of.size(); ++i) results[i] = of.circumradius(i);
  });
}

flaunay_status flaunay_edge_circles(const double* coordinates, size_t n, const int32_t* triangles, size_t t,
                                    const int32_t* halfedges, int8_t* sides) {
  return measure(coordinates, n, triangles, t, sides, [&](const auto& of, int8_t* results) {
    const Indices twins = checked(halfedges, t, 3, -1, 3 * t, "halfedges", "halfedges");
    for (std::size_t h = 0; h < twins.size(); ++h) {
      results[h] =
          static_cast<int8_t>(twins[h] < 0 ? -1 : of.circle(h / 3, static_cast<std::size_t>(twins[h])));
    }
  });
}

flaunay_status flaunay_same_circles(const double* coordinates, size_t n, const int32_t* triangles, size_t t,
                                    const int32_t* neighbors, int32_t* first) {
  return measure(coordinates, n, triangles, t, first, [&](const auto& of, int32_t* results) {
    geometry::find_same_circles(of, checked(neighbors, t, 3, -1, t, "neighbors", "triangles"), results);
  });
}
