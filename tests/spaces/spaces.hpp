// The spaces in which points are triangulated, as tests of what holds in all of them see these: the same
// calls under one name, and points of every degenerate kind.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/neighbors.hpp"
#include "flaunay/periodic.hpp"
#include "flaunay/sphere.hpp"
#include "flaunay/verify.hpp"
#include "flaunay/weighted.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::testing::spaces {

using Numbers = std::vector<double>;
using Offsets = std::vector<std::size_t>;

/// The answers to queries of one set: triangles, nearest points, and several of these.
struct Answers {
  std::vector<std::int32_t> triangles, nearest;
  Neighbors several;
};

struct Plane {
  static constexpr std::size_t kWidth = 2;
  static auto triangulate(Triangulator& triangulator, const Numbers& points, const Offsets& offsets) {
    Options options;
    options.neighbors = true;
    return triangulator.triangulate(points.data(), offsets, options);
  }
  static std::string verify(const Numbers& points, const Offsets& offsets, const Triangulation& mesh) {
    return flaunay::verify(points.data(), offsets, mesh);
  }
  static Answers answers(Triangulator& triangulator, const Numbers& points, const Triangulation& mesh,
                         const Numbers& queries, const NeighborOptions& options) {
    Locator locator(triangulator, points.data(), points.size() / kWidth, mesh);
    PointTree tree(triangulator, points.data(), points.size() / kWidth);
    const std::size_t m = queries.size() / kWidth;
    return {locator.locate(queries.data(), m), locator.nearest(queries.data(), m),
            tree.nearest(queries.data(), m, options)};
  }
};

/// The third number of a point is its weight.
struct Weighted {
  static constexpr std::size_t kWidth = 3;
  static auto triangulate(Triangulator& triangulator, const Numbers& points, const Offsets& offsets) {
    Options options;
    options.neighbors = true;
    return triangulate_weighted(triangulator, columns(points, 0, 2).data(), columns(points, 2, 1).data(),
                                offsets, options);
  }
  static std::string verify(const Numbers& points, const Offsets& offsets,
                            const WeightedTriangulation& mesh) {
    return flaunay::verify(columns(points, 0, 2).data(), columns(points, 2, 1).data(), offsets, mesh);
  }
  static Numbers columns(const Numbers& points, std::size_t first, std::size_t count) {
    Numbers chosen;
    for (std::size_t i = first; i < points.size(); i += kWidth)
      chosen.insert(chosen.end(), &points[i], &points[i] + count);
    return chosen;
  }
};

template <int kAcross, int kUp>
struct Periodic {
  static constexpr std::size_t kWidth = 2;
  static Period period() { return {kAcross > 0 ? kAcross * 0.75 : HUGE_VAL, kUp > 0 ? kUp * 1.0 : HUGE_VAL}; }
  static auto triangulate(Triangulator& triangulator, const Numbers& points, const Offsets& offsets) {
    return triangulate_periodic(triangulator, points.data(), offsets, period());
  }
  static std::string verify(const Numbers&, const Offsets&, const PeriodicTriangulation& mesh) {
    return flaunay::verify(mesh);
  }
  static Answers answers(Triangulator& triangulator, const Numbers&, const PeriodicTriangulation& mesh,
                         const Numbers& queries, const NeighborOptions& options) {
    PeriodicLocator locator(triangulator, mesh);
    PointTree tree(triangulator, mesh);
    const std::size_t m = queries.size() / kWidth;
    return {locator.locate(queries.data(), m), locator.nearest(queries.data(), m),
            tree.nearest(queries.data(), m, options)};
  }
};
/// Weighted points there. The third number of a point is its weight.
template <int kAcross, int kUp>
struct WeightedPeriodic {
  static constexpr std::size_t kWidth = 3;
  static auto triangulate(Triangulator& triangulator, const Numbers& points, const Offsets& offsets) {
    return triangulate_periodic(triangulator, Weighted::columns(points, 0, 2).data(),
                                Weighted::columns(points, 2, 1).data(), offsets,
                                Periodic<kAcross, kUp>::period());
  }
  static std::string verify(const Numbers& points, const Offsets&,
                            const WeightedPeriodicTriangulation& mesh) {
    return flaunay::verify(Weighted::columns(points, 2, 1).data(), mesh);
  }
};
using WeightedTorus = WeightedPeriodic<1, 1>;
using WeightedCylinder = WeightedPeriodic<1, 0>;
using Torus = Periodic<1, 1>;
using Cylinder = Periodic<1, 0>;
using UprightCylinder = Periodic<0, 1>;

struct Sphere {
  static constexpr std::size_t kWidth = 3;
  static auto triangulate(Triangulator& triangulator, const Numbers& points, const Offsets& offsets) {
    return triangulate_sphere(triangulator, points.data(), offsets, SphereCoordinates::directions);
  }
  static std::string verify(const Numbers& points, const Offsets& offsets,
                            const SphericalTriangulation& mesh) {
    return flaunay::verify(points.data(), offsets, SphereCoordinates::directions, mesh);
  }
  static Answers answers(Triangulator& triangulator, const Numbers&, const SphericalTriangulation& mesh,
                         const Numbers& queries, const NeighborOptions& options) {
    constexpr SphereCoordinates kDirections = SphereCoordinates::directions;
    SphereLocator locator(triangulator, mesh);
    const std::size_t m = queries.size() / kWidth;
    return {locator.locate(queries.data(), m, kDirections), locator.nearest(queries.data(), m, kDirections),
            locator.nearest(queries.data(), m, kDirections, options)};
  }
};

struct Case {
  std::string name;
  Numbers numbers;
};

/// Sets of points of so many numbers each, none of which are all 0, for directions: few and many, on a
/// lattice, on a line, in one place, and in two.
inline std::vector<Case> cases(std::size_t width) {
  FixtureRandom random(width);
  const auto make = [&](std::size_t n, const auto& number) {
    Numbers numbers;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < width; ++k) numbers.push_back(number(i, k));
      if (std::all_of(numbers.end() - static_cast<std::ptrdiff_t>(width), numbers.end(),
                      [](double x) { return x == 0; }))
        numbers.back() = 1;
    }
    return numbers;
  };
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
