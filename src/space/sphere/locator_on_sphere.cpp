// Queries on a sphere.
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "geometry/arguments.hpp"
#include "space/sphere/triangulate_on_sphere.hpp"
#include "space/triangulate.hpp"

namespace flaunay::call {

using sphere::Point;

SphereLocator::SphereLocator(Triangulator& used, const Triangulation& triangulation)
    : owner_(TriangulatorAccess::shared(used)),
      mesh_(triangulation),
      coordinates_(triangulation.space.coordinates) {
  take_turn(*owner_, [&] {
    check_on_sphere(mesh_);
    expect(mesh_.point_offsets.size() == 2, "queries on a sphere need one set of points");
    walker_.emplace(mesh_);
    plane_ = sphere::make_plane(mesh_.places, mesh_.point_offsets);
    if (plane_.places().empty()) return;
    const double* const places = plane_.places().data();
    const std::size_t n = plane_.places().size() / 2;
    Triangulation planar = sphere::planar_part(plane_, mesh_);
    if (planar.triangles.empty()) planar = triangulate(*owner_, {places, nullptr, n}, {0, n}, {});
    const WithinTurn within(*owner_);
    locator_.emplace(used, places, n, planar);
  });
}

// A vertex near each query, in the order given; -1 if there are no points.
SphereLocator::Ids SphereLocator::starts(const std::vector<double>& places, const Ids& order) {
  const std::int32_t other = plane_.poles[0].empty() ? -1 : plane_.poles[0].front();
  if (!locator_) return Ids(order.size(), other);
  std::vector<double> in_plane;
  in_plane.reserve(places.size());
  for (const std::int32_t i : order) {
    const Point p = sphere::place_at(places, static_cast<std::size_t>(i));
    in_plane.insert(in_plane.end(), {sphere::is_pole(p) ? 0 : p.x, sphere::is_pole(p) ? 0 : p.y});
  }
  const WithinTurn within(*owner_);
  Ids result = locator_->nearest(in_plane.data(), order.size());
  if (!plane_.points.empty()) {
    for (std::int32_t& v : result) v = plane_.points[static_cast<std::size_t>(v)];
  }
  return result;
}

// Returns `columns` numbers per query. Calls work(place, start, numbers) for each query, on several threads;
// for queries that are near each other one after the other, which finds what they need in the cache.
template <typename T, typename Work>
std::vector<T> SphereLocator::answer(const double* queries, std::size_t m, std::size_t columns, T none,
                                     const Work& work) {
  return take_turn(*owner_, [&] {
    check_queries(queries, m);
    std::vector<T> result(check_columns(columns, m), none);
    host::Runtime& runtime = owner_->native().runtime;
    const std::vector<double> places = sphere::to_places(runtime, queries, m, coordinates_, "query");
    const Ids order = sphere::order_along_curve(runtime, places), start = starts(places, order);
    sphere::for_each(runtime, m, [&](std::size_t k) {
      const auto i = static_cast<std::size_t>(order[k]);
      if (start[k] >= 0) work(sphere::place_at(places, i), start[k], &result[columns * i]);
    });
    return result;
  });
}

// A set without triangles has one or two points.
std::int32_t SphereLocator::nearest_of_two(Point query) const {
  std::int32_t best = -1;
  for (std::size_t i = 0; i < mesh_.representatives.size(); ++i) {
    if (mesh_.representatives[i] != static_cast<std::int32_t>(i)) continue;
    const Point p = sphere::place_at(mesh_.places, i);
    const int sign = best < 0 ? 1 : sphere::nearer(query, p, walker_->place(best));
    if (sign > 0 || (sign == 0 && sphere::comes_first(p, walker_->place(best))))
      best = static_cast<std::int32_t>(i);
  }
  return best;
}

sphere::Found SphereLocator::find(Point query, std::int32_t start) const {
  return mesh_.triangles.empty() ? sphere::Found() : walker_->locate(query, walker_->nearest(query, start));
}

std::int32_t SphereLocator::find_nearest(Point query, std::int32_t start) const {
  return mesh_.triangles.empty() ? nearest_of_two(query) : walker_->nearest(query, start);
}

void SphereLocator::set_coordinates(SphereCoordinates coordinates) {
  take_turn(*owner_, [&] {
    check_enumerator(coordinates);
    coordinates_ = coordinates;
  });
}

std::vector<std::int32_t> SphereLocator::locate(const double* queries, std::size_t m) {
  return answer(queries, m, 1, std::int32_t{-1}, [&](Point query, std::int32_t start, std::int32_t* result) {
    *result = find(query, start).triangle;
  });
}

std::vector<std::int32_t> SphereLocator::nearest(const double* queries, std::size_t m) {
  return answer(queries, m, 1, std::int32_t{-1}, [&](Point query, std::int32_t start, std::int32_t* result) {
    *result = find_nearest(query, start);
  });
}

Neighbors SphereLocator::nearest(const double* queries, std::size_t m, const NeighborOptions& options) {
  struct Near {
    std::int32_t point = -1;
    double angle = std::numeric_limits<double>::infinity();
  };
  const auto find_row = [&](Point query, std::int32_t start, Near* row) {
    const sphere::Direction from = sphere::direction_of(query);
    double angle = 0;
    for (const std::int32_t v : walker_->nearest_points(query, find_nearest(query, start), options.count)) {
      // The order is exact, but angles are rounded: none is less than the one before.
      angle = std::max(angle, sphere::angle_between(from, sphere::direction_of(walker_->place(v))));
      if (angle <= options.max_distance) *row++ = {v, angle};
    }
  };
  Neighbors result;
  for (const Near& near : answer(queries, m, options.count, Near(), find_row)) {
    result.points.push_back(near.point);
    result.distances.push_back(near.angle);
  }
  return result;
}

std::vector<double> SphereLocator::interpolate(const double* values, const double* queries, std::size_t m,
                                               const InterpolationOptions& options) {
  check_enumerator(options.method);
  expect(options.method == Interpolation::linear && options.gradients == nullptr &&
             options.device_gradients == nullptr,
         "values on the sphere are interpolated linearly");
  const std::size_t columns = options.columns;
  check_array(values, check_columns(columns, mesh_.representatives.size()), "values", kMostCountable);
  return answer(queries, m, columns, options.fill, [&](Point query, std::int32_t start, double* numbers) {
    const sphere::Found found = find(query, start);
    if (found.triangle < 0) return;
    const std::array<double, 3> weights = walker_->weights(found, query);
    for (std::size_t c = 0; c < columns; ++c) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(walker_->corner(found.triangle, static_cast<int>(k)));
        if (weights[k] != 0) sum += weights[k] * values[columns * v + c];
      }
      numbers[c] = sum;
    }
  });
}

std::unique_ptr<SpaceLocator> make_locator_on_sphere(Triangulator& triangulator,
                                                     const Triangulation& triangulation) {
  return std::make_unique<SphereLocator>(triangulator, triangulation);
}

}  // namespace flaunay::call
