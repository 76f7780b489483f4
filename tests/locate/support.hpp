// What the tests of queries and of Voronoi diagrams share: sets of points with their triangulations and
// queries.
#pragma once

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "geometry/predicates.hpp"
#include "host/opencl/device.hpp"
#include "points/device_mesh.hpp"
#include "tests/support/device.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/runtimes.hpp"
#include "tests/support/same.hpp"
#include "tests/support/shared_triangulator.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::locate {

using namespace geometry;
using namespace points;

using host::Runtime;
using testing::Coordinates;
using testing::download;
using testing::FixtureRandom;
using testing::guarded;
using testing::make_fixture;
using testing::reference_orient2d;
using testing::same;
using testing::upload;

using Offsets = std::vector<std::size_t>;

using Runtimes = testing::SharedRuntimes<testing::make_tuned_runtime>;
[[maybe_unused]] inline ::testing::Environment* const kRuntimes =
    ::testing::AddGlobalTestEnvironment(new Runtimes);

/// Under the tuning that the environment names alone, if it names one.
inline std::vector<std::string> tunings() {
  if (std::getenv("FLAUNAY_TUNING") != nullptr) return {"own"};
  return {"own", "small", "gpu"};
}

/// Sets of points, their triangulation, and queries for each.
struct Case {
  Coordinates points;
  Offsets offsets{0};
  Coordinates queries;
  Offsets query_offsets{0};
  Triangulation mesh;

  std::size_t sets() const { return offsets.size() - 1; }
  std::size_t size() const { return points.size() / 2; }
  std::size_t query_count() const { return queries.size() / 2; }
  const double* point(std::int32_t i) const { return &points[2 * static_cast<std::size_t>(i)]; }
  const double* query(std::size_t i) const { return &queries[2 * i]; }
  std::int32_t corner(std::size_t t, int k) const {
    return mesh.triangles[3 * t + static_cast<std::size_t>(k)];
  }

  void add(const Coordinates& set, const Coordinates& queries_of_set) {
    points.insert(points.end(), set.begin(), set.end());
    offsets.push_back(points.size() / 2);
    queries.insert(queries.end(), queries_of_set.begin(), queries_of_set.end());
    query_offsets.push_back(queries.size() / 2);
  }
  void triangulate() { mesh = testing::triangulator().triangulate(points.data(), offsets); }
};

/// Twice the signed area of a triangle.
inline mpq_class area(const double* a, const double* b, const double* c) {
  return (mpq_class(a[0]) - mpq_class(c[0])) * (mpq_class(b[1]) - mpq_class(c[1])) -
         (mpq_class(a[1]) - mpq_class(c[1])) * (mpq_class(b[0]) - mpq_class(c[0]));
}

/// m queries of each kind: anywhere, on points, between two points, where three points' circle has its
/// centre, and far away.
inline Coordinates make_queries(const Coordinates& points, std::size_t m, std::uint64_t seed) {
  FixtureRandom random(seed);
  const auto n = static_cast<std::int64_t>(points.size() / 2);
  double low[2] = {0, 0}, high[2] = {1, 1};
  for (std::int64_t i = 0; i < 2 * n; ++i) {
    const auto c = static_cast<std::size_t>(i);
    low[c % 2] = i < 2 ? points[c] : std::min(low[c % 2], points[c]);
    high[c % 2] = i < 2 ? points[c] : std::max(high[c % 2], points[c]);
  }
  Coordinates queries;
  for (std::size_t i = 0; i < 2 * m; ++i) {
    queries.push_back(low[i % 2] + (1.2 * random.unit() - 0.1) * (high[i % 2] - low[i % 2]));
  }
  for (std::size_t i = 0; i < 4 * m && n > 0; ++i) {
    const auto a = static_cast<std::size_t>(2 * random.integer(0, n - 1));
    const auto b = static_cast<std::size_t>(
        2 * std::min(n - 1, static_cast<std::int64_t>(a / 2) + random.integer(1, 3)));
    const double x = (points[a] + points[b]) / 2, y = (points[a + 1] + points[b + 1]) / 2;
    if (i < m) {
      queries.insert(queries.end(), {points[a], points[a + 1]});
    } else if (i < 2 * m) {
      queries.insert(queries.end(), {x, y});
    } else if (i < 3 * m) {
      // Of integers that are neighbours in a grid, the middle of a cell.
      queries.insert(queries.end(), {std::floor(points[a]) + 0.5, std::floor(points[a + 1]) + 0.5});
    } else {
      const double far = 1e7 * (1 + std::max(high[0] - low[0], high[1] - low[1]));
      queries.insert(queries.end(), {far * (random.unit() - 0.5), far * (random.unit() - 0.5)});
    }
  }
  return queries;
}

inline Case make_case(const Coordinates& points, std::size_t m, std::uint64_t seed) {
  Case result;
  result.add(points, make_queries(points, m, seed));
  result.triangulate();
  return result;
}

inline Case nested_case(std::size_t n, std::size_t m) {
  Case result;
  const auto add = [&](const Coordinates& points) {
    result.add(points, make_queries(points, m, result.sets()));
  };
  add({});
  add(make_fixture("uniform", n, 1));
  add({2, 3});
  result.add(make_fixture("grid", n, 2), {});
  add({});
  add({0, 0, 4, 0, 1, 3});
  add(make_fixture("collinear", n, 3));
  add({1, 1, 1, 1, 1, 1});
  add(make_fixture("star", n, 4));
  add(make_fixture("kuzmin", 3 * n, 5));
  add({5, 5, 6, 7});
  add({});
  result.triangulate();
  return result;
}

inline std::vector<double> values_for(std::size_t n) {
  std::vector<double> values;
  FixtureRandom random(n);
  for (std::size_t i = 0; i < n; ++i) values.push_back(random.unit() * 2 - 1);
  return values;
}

inline DeviceMesh upload_mesh(Runtime& runtime, const Case& input) {
  DeviceMesh mesh;
  mesh.point_offsets = input.offsets;
  mesh.triangle_offsets = input.mesh.triangle_offsets;
  mesh.hull_offsets = input.mesh.hull_offsets;
  mesh.coordinates = upload(runtime, input.points);
  mesh.triangles = upload(runtime, input.mesh.triangles);
  mesh.neighbors = upload(runtime, input.mesh.neighbors);
  mesh.hull = upload(runtime, input.mesh.hull);
  mesh.representatives = upload(runtime, input.mesh.representatives);
  return mesh;
}

/// Sets with and without trees take turns, with empty ones; only some have queries.
inline Case case_of_trees(std::size_t n, std::size_t m) {
  Case result;
  const auto add = [&](const Coordinates& points) {
    result.add(points, make_queries(points, m, result.sets()));
  };
  add({});
  add({2, 3});
  add(make_fixture("uniform", n, 23));
  add({0, 0, 4, 0, 1, 3});
  add({});
  add(make_fixture("collinear", n, 24));
  result.add(make_fixture("uniform", n, 25), {});
  add(make_fixture("kuzmin", n, 26));
  add(make_fixture("grid", n, 27));
  add({1, 1, 1, 1});
  add({});
  result.triangulate();
  return result;
}

/// The Voronoi diagram that the device makes; see voronoi_test.cpp.
Voronoi dual(Runtime& runtime, const Case& input);

}  // namespace flaunay::locate
