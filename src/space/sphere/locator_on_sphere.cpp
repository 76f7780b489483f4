// Queries on a sphere.
#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "derived/interpolate/gradients.hpp"
#include "geometry/arguments.hpp"
#include "space/sphere/natural.hpp"
#include "space/sphere/smooth.hpp"
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
    walker_.emplace(mesh_);
    plane_ = sphere::make_plane(mesh_.places, mesh_.point_offsets);
    const WithinTurn within(*owner_);
    locator_.emplace(used, plane_.places().data(), plane_.offsets, sphere::planar_part(plane_, mesh_));
  });
}

// For each query a vertex of its set near it, in the order given, which has one set after the other; -1 if
// the set has no points.
SphereLocator::Ids SphereLocator::starts(const std::vector<double>& places, const Ids& order,
                                         const std::vector<std::size_t>& offsets) {
  std::vector<double> in_plane;
  in_plane.reserve(places.size());
  for (const std::int32_t i : order) {
    const Point p = sphere::place_at(places, static_cast<std::size_t>(i));
    in_plane.insert(in_plane.end(), {sphere::is_pole(p) ? 0 : p.x, sphere::is_pole(p) ? 0 : p.y});
  }
  const WithinTurn within(*owner_);
  Ids result = locator_->nearest(in_plane.data(), offsets);
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    const std::int32_t other = plane_.poles[s].empty() ? -1 : plane_.poles[s].front();
    for (std::size_t k = offsets[s]; k < offsets[s + 1]; ++k) {
      std::int32_t& v = result[k];
      v = v < 0 ? other : plane_.points.empty() ? v : plane_.points[static_cast<std::size_t>(v)];
    }
  }
  return result;
}

// Returns `columns` numbers per query. Calls work(place, start, numbers) for each query, on several threads;
// for queries that are near each other one after the other, which finds what they need in the cache.
template <typename T, typename Work>
std::vector<T> SphereLocator::answer(const double* queries, const std::vector<std::size_t>& offsets,
                                     std::size_t columns, T none, const Work& work) {
  return take_turn(*owner_, [&] {
    check_offsets(offsets);
    const std::size_t m = offsets.back();
    check_queries(queries, m);
    std::vector<T> result(check_columns(columns, m), none);
    host::Runtime& runtime = owner_->native().runtime;
    const std::vector<double> places =
        sphere::to_places(runtime, queries, m, Space::sphere(coordinates_), "query");
    const Ids order = sphere::order_along_curve(runtime, places, offsets),
              start = starts(places, order, offsets);
    sphere::for_each(runtime, m, [&](std::size_t k) {
      const auto i = static_cast<std::size_t>(order[k]);
      if (start[k] >= 0) work(sphere::place_at(places, i), start[k], &result[columns * i]);
    });
    return result;
  });
}

void SphereLocator::set_coordinates(SphereCoordinates coordinates) {
  take_turn(*owner_, [&] {
    check_enumerator(coordinates);
    coordinates_ = coordinates;
  });
}

std::vector<std::int32_t> SphereLocator::locate(const double* queries,
                                                const std::vector<std::size_t>& offsets) {
  return answer(queries, offsets, 1, std::int32_t{-1},
                [&](Point query, std::int32_t start, std::int32_t* result) {
                  *result = walker_->find(query, start).triangle;
                });
}

std::vector<std::int32_t> SphereLocator::nearest(const double* queries,
                                                 const std::vector<std::size_t>& offsets) {
  return answer(queries, offsets, 1, std::int32_t{-1},
                [&](Point query, std::int32_t start, std::int32_t* result) {
                  *result = walker_->nearest(query, start);
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
    for (const std::int32_t v :
         walker_->nearest_points(query, walker_->nearest(query, start), options.count)) {
      // The order is exact, but angles are rounded: none is less than the one before.
      angle = std::max(angle, sphere::angle_between(from, sphere::direction_of(walker_->place(v))));
      if (angle <= options.max_distance) *row++ = {v, angle};
    }
  };
  with_errors([&] { check_neighbors(options, m); });
  Neighbors result;
  for (const Near& near : answer(queries, {0, m}, options.count, Near(), find_row)) {
    result.points.push_back(near.point);
    result.distances.push_back(near.angle);
  }
  return result;
}

std::vector<double> SphereLocator::interpolate(const double* values, const double* queries,
                                               const std::vector<std::size_t>& offsets,
                                               const InterpolationOptions& options) {
  const Interpolation method = options.method;
  const std::size_t columns = options.columns;
  check_array(values, check_columns(columns, mesh_.representatives.size()), "values", kMostCountable);
  const auto row = [&](std::int32_t v) { return values + columns * static_cast<std::size_t>(v); };
  const double* slopes = options.gradients;
  const auto interpolate_at = [&](Point query, std::int32_t start, double* numbers) {
    if (method == Interpolation::nearest) {
      std::copy_n(row(walker_->nearest(query, start)), columns, numbers);
      return;
    }
    const sphere::Found found = walker_->find(query, start);
    if (found.triangle < 0) return;
    std::fill_n(numbers, columns, 0);
    const auto add = [&](std::int32_t v, double weight) {
      for (std::size_t c = 0; c < columns && weight != 0; ++c) numbers[c] += weight * row(v)[c];
    };
    if (method == Interpolation::linear) {
      const std::array<double, 3> weights = walker_->weights(found, query);
      for (int k = 0; k < 3; ++k)
        add(walker_->corner(found.triangle, k), weights[static_cast<std::size_t>(k)]);
    } else if (method != Interpolation::clough_tocher) {
      for (const auto& [v, weight] : sphere::natural_neighbors(*walker_, found, query, method))
        add(v, weight);
    } else {
      const sphere::SmoothPlace place(*walker_, found, query);
      for (std::size_t c = 0; c < columns; ++c) {
        std::array<double, 3> heights{};
        std::array<sphere::Direction, 3> gradients{};
        for (std::size_t k = 0; k < 3; ++k) {
          const std::int32_t v = walker_->corner(found.triangle, static_cast<int>(k));
          const double* const slope = slopes + 3 * (columns * static_cast<std::size_t>(v) + c);
          heights[k] = row(v)[c];
          gradients[k] = {slope[0], slope[1], slope[2]};
        }
        numbers[c] = place.value(heights, gradients);
      }
    }
  };
  return take_turn(*owner_, [&] {
    const WithinTurn within(*owner_);
    std::vector<double> estimated;
    if (method == Interpolation::clough_tocher && slopes == nullptr)
      slopes = (estimated = gradients(values, columns, options.estimation)).data();
    return answer(queries, offsets, columns, options.fill, interpolate_at);
  });
}

std::vector<double> SphereLocator::gradients(const double* values, std::size_t columns,
                                             const GradientOptions& options) {
  check_array(values, check_columns(columns, mesh_.representatives.size()), "values", kMostCountable);
  flaunay::interpolate::check(options);
  return take_turn(*owner_, [&] {
    return sphere::estimate_gradients(
        owner_->native().runtime, *walker_, mesh_, values, columns,
        std::min(options.iterations, flaunay::interpolate::iterations_for(options.tolerance)));
  });
}

NaturalWeights SphereLocator::natural_weights(const double* queries, std::size_t m, Interpolation method) {
  NaturalWeights result;
  result.offsets.push_back(0);
  const auto list = [&](Point query, std::int32_t start, std::vector<sphere::Weighed>* row) {
    const sphere::Found found = walker_->find(query, start);
    if (found.triangle >= 0) *row = sphere::natural_neighbors(*walker_, found, query, method);
  };
  for (const auto& row : answer(queries, {0, m}, 1, std::vector<sphere::Weighed>(), list)) {
    for (const auto& [v, weight] : row) {
      result.points.push_back(v);
      result.weights.push_back(weight);
    }
    result.offsets.push_back(result.points.size());
  }
  return result;
}

}  // namespace flaunay::call
