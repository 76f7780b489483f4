// The spaces in which points are triangulated, as tests of what holds in all of them see these: the same
// calls under one name, and points of every degenerate kind.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/neighbors.hpp"
#include "flaunay/verify.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::testing::spaces {

using Numbers = std::vector<double>;
using Offsets = std::vector<std::size_t>;

/// The answers to queries of one set: triangles, nearest points, and several of these.
struct Answers {
  std::vector<std::int32_t> triangles, nearest;
  Neighbors several;
};

/// A space, and how its points are given.
struct TestSpace {
  std::string name;
  std::size_t width;  ///< numbers per point
  Space space;
  bool has_weights = false;  ///< the third number of a point is its weight

  /// Calls work(coordinates, space) with the weights in the space.
  template <typename Work>
  auto with_columns(const Numbers& points, const Work& work) const {
    if (!has_weights) return work(points, space);
    Numbers coordinates, weights;
    for (std::size_t i = 0; i < points.size(); i += width) {
      coordinates.insert(coordinates.end(), {points[i], points[i + 1]});
      weights.push_back(points[i + 2]);
    }
    return work(coordinates, space.with_weights(weights.data()));
  }
  bool is_plane() const { return space.kind == SpaceKind::plane; }
  /// All arrays that triangulations in this space have.
  Triangulation triangulate(Triangulator& triangulator, const Numbers& points, const Offsets& offsets) const {
    Options options;
    options.neighbors = true;
    options.halfedges = options.areas = is_plane();
    return with_columns(points, [&](const Numbers& coordinates, const Space& given) {
      return triangulator.triangulate(coordinates.data(), offsets, given, options);
    });
  }
  std::string verify(const Numbers& points, const Offsets& offsets, const Triangulation& mesh) const {
    return with_columns(points, [&](const Numbers& coordinates, const Space& given) {
      return flaunay::verify(coordinates.data(), offsets, given, mesh);
    });
  }
  Locator locator(Triangulator& triangulator, const Numbers& points, const Offsets& offsets,
                  const Triangulation& mesh) const {
    return with_columns(points, [&](const Numbers& coordinates, const Space& given) {
      return is_plane() ? Locator(triangulator, coordinates.data(), offsets, mesh)
                        : Locator(triangulator, mesh, given.weights);
    });
  }
  Answers answers(Triangulator& triangulator, const Numbers& points, const Triangulation& mesh,
                  const Numbers& queries, const NeighborOptions& options) const {
    const std::size_t n = points.size() / width, m = queries.size() / width;
    Locator locator = this->locator(triangulator, points, {0, n}, mesh);
    PointTree tree = is_plane() ? PointTree(triangulator, points.data(), n) : PointTree(triangulator, mesh);
    return {locator.locate(queries.data(), m), locator.nearest(queries.data(), m),
            tree.nearest(queries.data(), m, options)};
  }

  /// Whether cells have an end, in the plane in a box.
  bool has_cells() const { return std::isfinite(space.period.x) && std::isfinite(space.period.y); }
  /// Points after some steps of Lloyd's method, with their weights.
  Numbers relax(Triangulator& triangulator, const Numbers& points, std::size_t steps,
                const Numbers& box) const {
    const Numbers moved = with_columns(points, [&](const Numbers& coordinates, const Space& given) {
      const std::size_t n = points.size() / width;
      return space.kind == SpaceKind::plane
                 ? triangulator.relax(coordinates.data(), n, given, steps, box.data(), box.size() / 2)
                 : triangulator.relax(coordinates.data(), n, given, steps);
    });
    if (!has_weights) return moved;
    Numbers all = points;
    for (std::size_t k = 0; k < moved.size(); ++k) all[k / 2 * width + k % 2] = moved[k];
    return all;
  }

  friend void PrintTo(const TestSpace& space, std::ostream* out) { *out << space.name; }
};

inline std::vector<TestSpace> all_spaces() {
  constexpr double kWhole = std::numeric_limits<double>::infinity();
  return {{"plane", 2, Space::plane()},
          {"weighted", 3, Space::plane(), true},
          {"torus", 2, Space::torus({0.75, 1})},
          {"sheared_torus", 2, Space::torus({0.75, 1, 0.25})},
          {"weighted_torus", 3, Space::torus({0.75, 1}), true},
          {"weighted_sheared_torus", 3, Space::torus({0.75, 1, 0.25}), true},
          {"weighted_cylinder", 3, Space::torus({0.75, kWhole}), true},
          {"cylinder", 2, Space::torus({0.75, kWhole})},
          {"upright_cylinder", 2, Space::torus({kWhole, 1})},
          {"sphere", 3, Space::sphere(SphereCoordinates::directions)},
          {"globe", 2, Space::sphere(SphereCoordinates::degrees)}};
}

struct Case {
  std::string name;
  Numbers numbers;
};

/// Points of so many numbers each, none of which are all 0, for directions. number(i, k): the k-th of point
/// i.
template <typename Number>
Numbers points_of(std::size_t n, std::size_t width, const Number& number) {
  Numbers numbers;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < width; ++k) numbers.push_back(number(i, k));
    if (std::all_of(numbers.end() - static_cast<std::ptrdiff_t>(width), numbers.end(),
                    [](double x) { return x == 0; }))
      numbers.back() = 1;
  }
  return numbers;
}

/// The points with other weights: light, equal, and heavier in one place; by which all but corners are
/// hidden, by a plane or by one point.
inline std::vector<Case> with_other_weights(const Numbers& points) {
  FixtureRandom random(points.size());
  std::vector<Case> all;
  const auto n = static_cast<double>(points.size() / 3);
  const auto add = [&](const std::string& name, auto weight) {
    all.push_back({name, points});
    for (std::size_t i = 0; i < points.size(); i += 3)
      all.back().numbers[i + 2] = weight(points[i], points[i + 1]);
  };
  add("light", [&](double, double) { return random.unit() / n; });
  add("equal", [](double, double) { return 0.25; });
  add("on a plane", [](double x, double y) { return std::fma(x, x, y * y); });
  add("one heavy",
      [is_first = true](double, double) mutable { return std::exchange(is_first, false) * 2.0; });
  double up = 0;
  add("up and down", [&](double x, double y) { return (x < 0 ? ++up : y < 0 ? -++up : 0) / n; });
  return all;
}

/// Sets of points: few and some, on a lattice, on a line, in one place, and in two.
inline std::vector<Case> cases(const TestSpace& space) {
  const std::size_t width = space.width;
  FixtureRandom random(width);
  const auto make = [&](std::size_t n, const auto& number) { return points_of(n, width, number); };
  std::vector<Case> all;
  for (const std::size_t n : {0, 1, 2, 3, 4, 9, 60}) {
    all.push_back({"uniform " + std::to_string(n),
                   make(n, [&](std::size_t, std::size_t) { return random.unit() * 2 - 1; })});
  }
  for (const int size : {2, 8}) {
    all.push_back({"lattice of " + std::to_string(size), make(90, [&](std::size_t, std::size_t) {
                     return static_cast<double>(random.integer(-size, size)) / 8;
                   })});
  }
  all.push_back({"axes", make(2 * width, [&](std::size_t i, std::size_t k) {
                   return i / 2 == k ? (i % 2 == 0 ? 1.0 : -1.0) : 0.0;
                 })});
  all.push_back({"line", make(12, [](std::size_t i, std::size_t k) {
                   return k == 0 ? static_cast<double>(i * 5 % 12) / 16 : 0.25;
                 })});
  all.push_back({"one place", make(7, [](std::size_t, std::size_t) { return 0.5; })});
  all.push_back({"two places",
                 make(9, [](std::size_t i, std::size_t k) { return k == 0 && i % 2 == 0 ? 0.5 : 0.25; })});
  if (space.has_weights) {
    for (const std::size_t k : {6, 7}) {
      for (Case& weighted : with_other_weights(all[k].numbers)) all.push_back(std::move(weighted));
    }
  } else if (space.space.kind == SpaceKind::sphere && width == 3) {
    all.push_back(
        {"of any length", {1e30, 0, 1e30, 3e-30, 0, 4e-30, -1, 0, 0, 2, 0, 0, -5, 0, -7, 4, 0, 0, 0, 0, -2}});
  } else if (space.space.kind == SpaceKind::sphere) {
    all.push_back({"around the globe", make(54, [](std::size_t i, std::size_t k) {
                     return k == 0 ? static_cast<double>(i % 9) * 90 - 300
                                   : static_cast<double>(i / 9) * 36 - 90;
                   })});
  }
  return all;
}

/// Sets of thousands of points: as they come, with ties, in a corner, twice, and around a gap, over which a
/// torus needs more images.
inline std::vector<Case> large_cases(const TestSpace& space) {
  constexpr std::size_t kPoints = 2500;
  FixtureRandom random(space.width);
  const Numbers uniform =
      points_of(kPoints, space.width, [&](std::size_t, std::size_t) { return random.unit() - 0.5; });
  const auto changed = [&](const auto& number) {
    return points_of(kPoints, space.width,
                     [&](std::size_t i, std::size_t k) { return number(uniform[space.width * i + k]); });
  };
  std::vector<Case> all = {{"uniform", uniform},
                           {"lattice", changed([](double x) { return std::floor(50 * x) / 50; })},
                           {"corner", changed([](double x) { return x / 64; })},
                           {"twice", uniform},
                           {"gap", {}}};
  all[3].numbers.insert(all[3].numbers.end(), uniform.begin(), uniform.end());
  for (auto row = uniform.begin(); row != uniform.end(); row += static_cast<std::ptrdiff_t>(space.width)) {
    if (std::hypot(row[0], row[1]) > 0.3)
      all[4].numbers.insert(all[4].numbers.end(), row, row + static_cast<std::ptrdiff_t>(space.width));
  }
  if (space.has_weights) {
    for (Case& weighted : with_other_weights(uniform)) all.push_back(std::move(weighted));
  } else if (std::isfinite(space.space.period.x + space.space.period.y) &&
             space.space.kind == SpaceKind::torus) {
    all.push_back({"far", uniform});
    for (std::size_t i = 0; i < uniform.size(); ++i)
      all.back().numbers[i] = std::ldexp(uniform[i], static_cast<int>(i * 37 % 1000));
  }
  return all;
}

/// All cases in one call, and a set without points after each.
inline Numbers joined(const std::vector<Case>& cases, std::size_t width, Offsets& offsets) {
  Numbers all;
  offsets = {0};
  for (const Case& each : cases) {
    all.insert(all.end(), each.numbers.begin(), each.numbers.end());
    offsets.insert(offsets.end(), 2, all.size() / width);
  }
  return all;
}

}  // namespace flaunay::testing::spaces
