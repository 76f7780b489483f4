// The public calls for points on a sphere.
#include "flaunay/sphere.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "call/frame.hpp"
#include "derived/sphere/close.hpp"
#include "derived/sphere/dual.hpp"
#include "derived/sphere/places.hpp"
#include "derived/sphere/plane.hpp"
#include "derived/sphere/walk.hpp"
#include "flaunay/verify.hpp"
#include "geometry/arguments.hpp"
#include "mesh/corners.hpp"
#include "prove/sphere_proof.hpp"
#include "sphere/places.h"

namespace flaunay {
namespace {

using Ids = std::vector<std::int32_t>;
using sphere::Plane;
using sphere::Point;

std::vector<double> places_of(call::Implementation& self, const double* points, std::size_t n,
                              SphereCoordinates coordinates, const char* what) {
  check_enumerator(coordinates);
  return call::take_turn(
      self, [&] { return sphere::to_places(self.native().runtime, points, n, coordinates, what); });
}

// Appends the triangles of one set in the plane.
void append(const Triangulation& planar, std::size_t set, SphericalTriangulation& mesh) {
  const std::size_t begin = planar.triangle_offsets[set], first = mesh.triangles.size() / 3;
  const auto shift = static_cast<std::int32_t>(first) - static_cast<std::int32_t>(begin);
  for (std::size_t c = 3 * begin; c < 3 * planar.triangle_offsets[set + 1]; ++c) {
    mesh.triangles.push_back(planar.triangles[c]);
    mesh.neighbors.push_back(planar.neighbors[c] < 0 ? -1 : planar.neighbors[c] + shift);
  }
}

// The edges of triangles, from `first` on, without a triangle beyond, numbered from there.
std::vector<sphere::OpenEdge> open_edges(const SphericalTriangulation& mesh, std::size_t first) {
  std::vector<sphere::OpenEdge> open;
  const auto add = [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) {
      if (mesh.neighbors[c] >= 0) continue;
      const auto [from, to] = mesh::edge_opposite(mesh.triangles, c);
      open.push_back({from, to, static_cast<std::int32_t>(c - 3 * first)});
    }
  };
  // They are few: most runs have none, and only these have no number below 0.
  constexpr std::size_t kCorners = 192;
  for (std::size_t begin = 3 * first; begin < mesh.neighbors.size(); begin += kCorners) {
    const std::size_t end = std::min(begin + kCorners, mesh.neighbors.size());
    std::int32_t signs = 0;
    for (std::size_t c = begin; c < end; ++c) signs |= mesh.neighbors[c];
    if (signs < 0) add(begin, end);
  }
  return open;
}

SphericalTriangulation close_all(const Plane& plane, Triangulation planar, SphericalTriangulation mesh) {
  mesh.triangle_offsets = {0};
  const std::size_t sets = plane.poles.size(), most = 3 * mesh.places.size();  // corners
  if (sets == 1) {
    mesh.triangles = std::move(planar.triangles);
    mesh.neighbors = std::move(planar.neighbors);
  }
  mesh.triangles.reserve(most);
  mesh.neighbors.reserve(most);
  for (std::size_t s = 0; s < sets; ++s) {
    const std::size_t first = mesh.triangle_offsets.back();
    if (sets > 1) append(planar, s, mesh);
    sphere::PlanarSet set{{planar.hull.begin() + static_cast<std::ptrdiff_t>(planar.hull_offsets[s]),
                           planar.hull.begin() + static_cast<std::ptrdiff_t>(planar.hull_offsets[s + 1])},
                          {},
                          plane.poles[s].empty() ? -1 : plane.poles[s].front()};
    for (const std::int32_t v : set.hull)
      set.places.push_back(sphere::place_at(mesh.places, static_cast<std::size_t>(v)));
    const sphere::Cap cap = sphere::close(set, open_edges(mesh, first), mesh.triangles.size() / 3 - first);
    for (const auto& corners : cap.triangles)
      mesh.triangles.insert(mesh.triangles.end(), corners.begin(), corners.end());
    mesh.neighbors.resize(mesh.triangles.size(), -1);
    for (const sphere::Cap::Link& link : cap.links) {
      mesh.neighbors[3 * first + static_cast<std::size_t>(link.at)] =
          static_cast<std::int32_t>(first) + link.beyond;
    }
    mesh.triangle_offsets.push_back(mesh.triangles.size() / 3);
  }
  mesh.representatives = std::move(planar.representatives);
  mesh.statistics = std::move(planar.statistics);
  return mesh;
}

void check_arrays(const SphericalTriangulation& mesh) {
  const std::size_t n = mesh.places.size() / 2, triangles = mesh.triangles.size() / 3;
  const bool is_whole = mesh.places.size() % 2 == 0 && mesh.triangles.size() % 3 == 0 &&
                        mesh.representatives.size() == n && mesh.neighbors.size() == mesh.triangles.size() &&
                        !mesh.point_offsets.empty() &&
                        are_offsets(mesh.point_offsets, mesh.point_offsets.size() - 1, n) &&
                        are_offsets(mesh.triangle_offsets, mesh.point_offsets.size() - 1, triangles) &&
                        are_indices(mesh.triangles, n) && are_indices(mesh.neighbors, triangles);
  call::expect(is_whole, "the arrays are not those of a triangulation on the sphere");
}

void check(const SphericalTriangulation& mesh) {
  check_arrays(mesh);
  for (std::size_t i = 0; i < mesh.places.size() / 2; ++i) {
    const Point place = sphere::place_at(mesh.places, i), known = kernel::rounded_place(place.x, place.y);
    call::expect(place.x == known.x && place.y == known.y, [&] {
      return fmt::format("place {} of the triangulation on the sphere is none: ({}, {})", i, place.x,
                         place.y);
    });
  }
  // Each edge has the same ends in the triangle beyond it, so that walks around a point come back.
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::int32_t* const other = &mesh.triangles[3 * static_cast<std::size_t>(mesh.neighbors[c])];
    const auto [from, to] = mesh::edge_opposite(mesh.triangles, c);
    bool has_edge = false;
    for (int k = 0; k < 3; ++k) has_edge |= other[k] == to && other[(k + 1) % 3] == from;
    call::expect(has_edge, "the arrays are not those of a triangulation on the sphere");
  }
}

}  // namespace

SphericalTriangulation triangulate_sphere(Triangulator& triangulator, const double* points, std::size_t n,
                                          SphereCoordinates coordinates) {
  return triangulate_sphere(triangulator, points, std::vector<std::size_t>{0, n}, coordinates);
}

SphericalTriangulation triangulate_sphere(Triangulator& triangulator, const double* points,
                                          const std::vector<std::size_t>& offsets,
                                          SphereCoordinates coordinates) {
  check_offsets(offsets);
  check_points(points, offsets.back());
  SphericalTriangulation mesh;
  mesh.places = places_of(TriangulatorAccess::implementation(triangulator), points, offsets.back(),
                          coordinates, "point");
  mesh.point_offsets = offsets;
  const Plane plane = sphere::make_plane(mesh.places, offsets);
  Triangulation planar = triangulator.triangulate(plane.places().data(), plane.offsets);
  sphere::number_by_points(plane, offsets.back(), planar);
  return close_all(plane, std::move(planar), std::move(mesh));
}

std::string verify(const double* points, const std::vector<std::size_t>& offsets,
                   SphereCoordinates coordinates, const SphericalTriangulation& triangulation) {
  check_offsets(offsets);
  check_arrays(triangulation);
  if (offsets != triangulation.point_offsets) return "the sets have other points";
  return prove::find_problem(places_on_sphere(points, offsets.back(), coordinates), triangulation);
}

std::vector<double> places_on_sphere(const double* points, std::size_t n, SphereCoordinates coordinates) {
  check_points(points, n);
  check_enumerator(coordinates);
  return sphere::to_places(call::Engine::of_thread().runtime, points, n, coordinates, "point");
}

std::vector<double> directions_of(const std::vector<double>& places) {
  std::vector<double> directions;
  directions.reserve(places.size() / 2 * 3);
  for (std::size_t i = 0; i < places.size() / 2; ++i) {
    const sphere::Direction d = sphere::direction_of(sphere::place_at(places, i));
    directions.insert(directions.end(), {d.x, d.y, d.z});
  }
  return directions;
}

SphericalVoronoi voronoi_on_sphere(Triangulator& triangulator, const SphericalTriangulation& triangulation) {
  call::Implementation& self = TriangulatorAccess::implementation(triangulator);
  return call::take_turn(self, [&] {
    check(triangulation);
    return sphere::make_dual(self.native().runtime, triangulation);
  });
}

struct SphereLocator::Implementation {
  Implementation(Triangulator& used, const SphericalTriangulation& triangulation)
      : owner(TriangulatorAccess::shared(used)), mesh(triangulation) {
    check(mesh);
    call::expect(mesh.point_offsets.size() == 2, "queries on a sphere need one set of points");
    walker.emplace(mesh);
    plane = sphere::make_plane(mesh.places, mesh.point_offsets);
    if (plane.places().empty()) return;
    const std::size_t n = plane.places().size() / 2;
    Triangulation planar = sphere::planar_part(plane, mesh);
    if (planar.triangles.empty()) planar = used.triangulate(plane.places().data(), n);
    locator.emplace(used, plane.places().data(), n, planar);
  }

  /// Of each query a vertex near it, in the order given; -1 if there are no points.
  Ids starts(const std::vector<double>& places, const Ids& order) {
    const std::int32_t other = plane.poles[0].empty() ? -1 : plane.poles[0].front();
    if (!locator) return Ids(order.size(), other);
    std::vector<double> in_plane;
    in_plane.reserve(places.size());
    for (const std::int32_t i : order) {
      const Point p = sphere::place_at(places, static_cast<std::size_t>(i));
      in_plane.insert(in_plane.end(), {sphere::is_pole(p) ? 0 : p.x, sphere::is_pole(p) ? 0 : p.y});
    }
    Ids result = locator->nearest(in_plane.data(), order.size());
    if (!plane.points.empty()) {
      for (std::int32_t& v : result) v = plane.points[static_cast<std::size_t>(v)];
    }
    return result;
  }

  /// Returns so many numbers per query. Calls work(place, start, numbers) for each query, on several threads;
  /// for those that are near each other one after the other, which finds what they need in the cache.
  template <typename T, typename Work>
  std::vector<T> answer(const double* queries, std::size_t m, SphereCoordinates coordinates,
                        std::size_t columns, T none, const Work& work) {
    check_queries(queries, m);
    std::vector<T> result(check_columns(columns, m), none);
    const std::vector<double> places = places_of(*owner, queries, m, coordinates, "query");
    const Ids order =
        call::take_turn(*owner, [&] { return sphere::order_along_curve(owner->native().runtime, places); });
    const Ids start = starts(places, order);
    call::take_turn(*owner, [&] {
      sphere::for_each(owner->native().runtime, m, [&](std::size_t k) {
        const auto i = static_cast<std::size_t>(order[k]);
        if (start[k] >= 0) work(sphere::place_at(places, i), start[k], &result[columns * i]);
      });
    });
    return result;
  }

  // A set without triangles has one or two points.
  std::int32_t nearest_of_two(Point query) const {
    std::int32_t best = -1;
    for (std::size_t i = 0; i < mesh.representatives.size(); ++i) {
      if (mesh.representatives[i] != static_cast<std::int32_t>(i)) continue;
      const Point p = sphere::place_at(mesh.places, i);
      const int sign = best < 0 ? 1 : sphere::nearer(query, p, walker->place(best));
      if (sign > 0 || (sign == 0 && sphere::comes_first(p, walker->place(best))))
        best = static_cast<std::int32_t>(i);
    }
    return best;
  }

  sphere::Found locate(Point query, std::int32_t start) const {
    return mesh.triangles.empty() ? sphere::Found() : walker->locate(query, walker->nearest(query, start));
  }
  std::int32_t nearest(Point query, std::int32_t start) const {
    return mesh.triangles.empty() ? nearest_of_two(query) : walker->nearest(query, start);
  }

  std::shared_ptr<call::Implementation> owner;
  SphericalTriangulation mesh;
  std::optional<sphere::Walker> walker;
  Plane plane;
  std::optional<Locator> locator;
};

SphereLocator::SphereLocator(Triangulator& triangulator, const SphericalTriangulation& triangulation)
    : implementation_(std::make_unique<Implementation>(triangulator, triangulation)) {}
SphereLocator::~SphereLocator() = default;
SphereLocator::SphereLocator(SphereLocator&&) noexcept = default;
SphereLocator& SphereLocator::operator=(SphereLocator&&) noexcept = default;

std::vector<std::int32_t> SphereLocator::locate(const double* queries, std::size_t m,
                                                SphereCoordinates coordinates) {
  return implementation_->answer(queries, m, coordinates, 1, std::int32_t{-1},
                                 [&](Point query, std::int32_t start, std::int32_t* triangle) {
                                   *triangle = implementation_->locate(query, start).triangle;
                                 });
}

std::vector<std::int32_t> SphereLocator::nearest(const double* queries, std::size_t m,
                                                 SphereCoordinates coordinates) {
  return implementation_->answer(queries, m, coordinates, 1, std::int32_t{-1},
                                 [&](Point query, std::int32_t start, std::int32_t* point) {
                                   *point = implementation_->nearest(query, start);
                                 });
}

Neighbors SphereLocator::nearest(const double* queries, std::size_t m, SphereCoordinates coordinates,
                                 const NeighborOptions& options) {
  with_errors([&] { check_neighbors(options, m); });
  struct Near {
    std::int32_t point = -1;
    double angle = std::numeric_limits<double>::infinity();
  };
  const auto find = [&](Point query, std::int32_t start, Near* row) {
    const sphere::Walker& walker = *implementation_->walker;
    const sphere::Direction from = sphere::direction_of(query);
    double angle = 0;
    for (const std::int32_t v :
         walker.nearest_points(query, implementation_->nearest(query, start), options.count)) {
      // The order is exact, but angles are rounded: none is less than the one before.
      angle = std::max(angle, sphere::angle_between(from, sphere::direction_of(walker.place(v))));
      if (angle <= options.max_distance) *row++ = {v, angle};
    }
  };
  Neighbors result;
  for (const Near& near : implementation_->answer(queries, m, coordinates, options.count, Near(), find)) {
    result.points.push_back(near.point);
    result.distances.push_back(near.angle);
  }
  return result;
}

std::vector<double> SphereLocator::interpolate(const double* values, std::size_t columns,
                                               const double* queries, std::size_t m,
                                               SphereCoordinates coordinates) {
  check_array(values, check_columns(columns, implementation_->mesh.representatives.size()), "values",
              kMostCountable);
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  const auto compute = [&](Point query, std::int32_t start, double* numbers) {
    const sphere::Found found = implementation_->locate(query, start);
    if (found.triangle < 0) return;
    const std::array<double, 3> weights = implementation_->walker->weights(found, query);
    for (std::size_t c = 0; c < columns; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v =
            static_cast<std::size_t>(implementation_->walker->corner(found.triangle, static_cast<int>(k)));
        if (weights[k] != 0) sum += weights[k] * values[columns * v + c];
      }
      numbers[c] = sum;
    }
  };
  return implementation_->answer(queries, m, coordinates, columns, kNone, compute);
}

}  // namespace flaunay
