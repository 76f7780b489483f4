// Triangulations on the sphere against rational arithmetic: convex hulls, cells and queries by brute force.
#include "flaunay/sphere.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "flaunay/verify.hpp"
#include "space/sphere/places.hpp"
#include "space/sphere/plane.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::sphere {
namespace {

using Numbers = std::vector<double>;
using Ids = std::vector<std::int32_t>;
constexpr SphereCoordinates kDirections = SphereCoordinates::directions;
constexpr SphereCoordinates kDegrees = SphereCoordinates::degrees;

/// A point exactly, times 1 + x^2 + y^2 > 0, which comes last.
using Exact = std::array<mpq_class, 4>;

Exact exact(double x, double y) {
  if (std::isinf(x)) return {0, 0, -1, 1};
  const mpq_class u(x), v(y), square = u * u + v * v;
  return {2 * u, 2 * v, 1 - square, 1 + square};
}

mpq_class det3(const Exact& a, const Exact& b, const Exact& c, int i, int j, int k) {
  const auto at = [](const Exact& p, int index) -> const mpq_class& {
    return p[static_cast<std::size_t>(index)];
  };
  return at(a, i) * (at(b, j) * at(c, k) - at(b, k) * at(c, j)) -
         at(a, j) * (at(b, i) * at(c, k) - at(b, k) * at(c, i)) +
         at(a, k) * (at(b, i) * at(c, j) - at(b, j) * at(c, i));
}

/// 1 if d lies outside of the plane through a, b, c, which are counter-clockwise as seen from there.
int outside(const Exact& a, const Exact& b, const Exact& c, const Exact& d) {
  const mpq_class det = d[0] * det3(a, b, c, 1, 2, 3) - d[1] * det3(a, b, c, 0, 2, 3) +
                        d[2] * det3(a, b, c, 0, 1, 3) - d[3] * det3(a, b, c, 0, 1, 2);
  return sgn(det);
}

int turn_of(const Exact& a, const Exact& b, const Exact& c) { return sgn(det3(a, b, c, 0, 1, 2)); }

/// The cosine of two points' angle, exactly.
mpq_class cosine(const Exact& a, const Exact& b) {
  return (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) / (a[3] * b[3]);
}

std::vector<Exact> exact_places(const Triangulation& mesh) {
  std::vector<Exact> points;
  for (std::size_t i = 0; i < mesh.places.size(); i += 2)
    points.push_back(exact(mesh.places[i], mesh.places[i + 1]));
  return points;
}

/// In the canonical order, the south pole is the first.
bool comes_first(const Triangulation& mesh, std::int32_t a, std::int32_t b) {
  const auto place = [&](std::int32_t v) {
    const double* const p = &mesh.places[2 * static_cast<std::size_t>(v)];
    return std::isinf(p[0]) ? std::pair(-HUGE_VAL, -HUGE_VAL) : std::pair(p[0], p[1]);
  };
  return place(a) < place(b);
}

/// Of one set: that it is the convex hull, each face a fan from its first vertex, with the right neighbours.
void expect_hull(const Triangulation& mesh) {
  const std::vector<Exact> points = exact_places(mesh);
  std::set<std::pair<double, double>> different;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto place = std::pair(mesh.places[2 * i], mesh.places[2 * i + 1]);
    const auto representative = static_cast<std::size_t>(mesh.representatives[i]);
    ASSERT_EQ(different.insert(place).second, representative == i);
    ASSERT_EQ(place, std::pair(mesh.places[2 * representative], mesh.places[2 * representative + 1]));
  }
  const std::size_t n = different.size(), triangles = mesh.triangles.size() / 3;
  ASSERT_EQ(n > 2 ? 2 * n - 4 : 0, triangles);
  ASSERT_EQ(3 * triangles, mesh.neighbors.size());
  for (std::size_t t = 0; t < triangles; ++t) {
    const std::int32_t* const v = &mesh.triangles[3 * t];
    const auto at = [&](std::size_t k) -> const Exact& { return points[static_cast<std::size_t>(v[k % 3])]; };
    ASSERT_TRUE(v[0] < v[1] && v[0] < v[2] && v[1] != v[2]);
    for (std::size_t i = 0; i < points.size(); ++i)
      ASSERT_LE(outside(at(0), at(1), at(2), points[i]), 0) << t << " " << i;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto beyond = static_cast<std::size_t>(mesh.neighbors[3 * t + k]);
      ASSERT_LT(beyond, triangles);
      const std::int32_t* const w = &mesh.triangles[3 * beyond];
      std::size_t opposite = 3;
      for (std::size_t j = 0; j < 3; ++j) {
        if (w[j] == v[(k + 2) % 3] && w[(j + 1) % 3] == v[(k + 1) % 3]) opposite = (j + 2) % 3;
      }
      ASSERT_LT(opposite, 3u);
      ASSERT_EQ(static_cast<std::int32_t>(t), mesh.neighbors[3 * beyond + opposite]);
      // The diagonals of a face go from its first vertex. Of a polygon with two sides, border edges are flat,
      // too.
      if (outside(at(0), at(1), at(2), points[static_cast<std::size_t>(w[opposite])]) != 0) continue;
      if (v[k] == w[opposite]) continue;
      const auto is_first = [&](std::int32_t u) {
        return !comes_first(mesh, v[0], u) && !comes_first(mesh, v[1], u) && !comes_first(mesh, v[2], u) &&
               !comes_first(mesh, w[opposite], u);
      };
      const bool on_both_sides = std::all_of(
          points.begin(), points.end(), [&](const Exact& p) { return outside(at(0), at(1), at(2), p) == 0; });
      if (on_both_sides) continue;
      ASSERT_TRUE(is_first(v[(k + 1) % 3]) || is_first(v[(k + 2) % 3])) << t;
    }
  }
}

Triangulation triangulated(const Numbers& points, SphereCoordinates coordinates) {
  return testing::triangulator().triangulate(
      points.data(), points.size() / (coordinates == kDirections ? 3 : 2), Space::sphere(coordinates));
}

InterpolationOptions columns(std::size_t count) {
  InterpolationOptions options;
  options.columns = count;
  return options;
}

std::string problem_of(const Triangulation& mesh, const Numbers& points, SphereCoordinates coordinates) {
  const std::vector<std::size_t> offsets = {0, points.size() / (coordinates == kDirections ? 3 : 2)};
  return verify(points.data(), offsets, Space::sphere(coordinates), mesh);
}

struct Case {
  std::string name;
  SphereCoordinates coordinates;
  Numbers points;
};

Numbers random_directions(std::size_t n, std::uint64_t seed) {
  testing::FixtureRandom random(seed);
  Numbers points;
  while (points.size() < 3 * n) {
    const double x = random.unit() * 2 - 1, y = random.unit() * 2 - 1, z = random.unit() * 2 - 1;
    const double square = x * x + y * y + z * z;
    if (square > 0.01 && square < 1) points.insert(points.end(), {x, y, z});
  }
  return points;
}

/// Every degenerate kind of set, all small.
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const std::size_t n : {0, 1, 2, 3, 4, 5, 8, 20, 60}) {
    all.push_back({"random " + std::to_string(n), kDirections, random_directions(n, 7 + n)});
  }
  Numbers lattice, octahedron, cube;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        const Numbers p = {static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
        if (x != 0 || y != 0 || z != 0) lattice.insert(lattice.end(), p.begin(), p.end());
        if (std::abs(x) + std::abs(y) + std::abs(z) == 1)
          octahedron.insert(octahedron.end(), p.begin(), p.end());
        if (std::abs(x) * std::abs(y) * std::abs(z) == 1) cube.insert(cube.end(), p.begin(), p.end());
      }
    }
  }
  all.push_back({"lattice", kDirections, lattice});
  all.push_back({"octahedron", kDirections, octahedron});
  all.push_back({"cube", kDirections, cube});
  Numbers globe, parallel, equator, meridian, half_meridian, cap, far_cap;
  for (int latitude = -90; latitude <= 90; latitude += 30) {
    for (int longitude = -180; longitude <= 180; longitude += 45) {
      globe.insert(globe.end(), {static_cast<double>(longitude), static_cast<double>(latitude)});
    }
  }
  for (int k = 0; k < 16; ++k) {
    parallel.insert(parallel.end(), {22.5 * k, 60.0});
    equator.insert(equator.end(), {22.5 * k, 0.0});
    meridian.insert(meridian.end(), {k < 8 ? 0.0 : 180.0, k % 8 * 180.0 / 7 - 90});
    half_meridian.insert(half_meridian.end(), {90.0, 8.0 * k - 60});
  }
  const Numbers directions = random_directions(12, 99);
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double axis = i % 3 == 2 ? 1 : 0;
    cap.push_back(axis + directions[i] * 0x1p-40);
    far_cap.push_back(directions[i] * 0x1p-45 - axis);
  }
  all.push_back({"globe", kDegrees, globe});
  all.push_back({"parallel", kDegrees, parallel});
  all.push_back({"equator", kDegrees, equator});
  all.push_back({"meridian with both poles", kDegrees, meridian});
  all.push_back({"half a meridian", kDegrees, half_meridian});
  // Points on a circle through the pole, beside another one: an edge of the hull, in both directions.
  for (const double longitude : {0.0, 180.0}) {
    Numbers beside = half_meridian;
    beside.insert(beside.end(), {longitude, 0.0});
    all.push_back({"half a meridian and a point", kDegrees, beside});
  }
  all.push_back({"cap in the north", kDirections, cap});
  all.push_back({"cap in the south", kDirections, far_cap});
  far_cap.insert(far_cap.end(), {0, 0, -3});
  all.push_back({"cap around the pole", kDirections, far_cap});
  all.push_back({"south poles", kDegrees, {17, -90, 0, -90}});
  all.push_back({"poles", kDegrees, {17, -90, 0, -90, 3, 90}});
  all.push_back({"poles and one", kDegrees, {17, -90, 5, 5, 3, 90, 17, -90}});
  // Flat triangles, the sides of cells half a circle long, and two points too near each other for doubles.
  all.push_back({"nearly one great circle",
                 kDirections,
                 {4, 0, 3, 0, 0, -1, 2, 0, -0x1p-52, 8, 0, 15, -0x1p-51, -0x1p-51, -1}});
  // Tangents of the half angle are 3/4 and others: exactly cocircular, on a hull without the pole.
  Numbers circle;
  for (const double a : {3.0, 4.0, -3.0, -4.0, 5.0, 0.0, -5.0}) {
    for (const double sign : {1.0, -1.0}) {
      const double b = sign * std::sqrt(25 - a * a);
      circle.insert(circle.end(), {2 * a, 2 * b, 1 - 25.0});
    }
  }
  all.push_back({"circle", kDirections, circle});
  circle.insert(circle.end(), {0, 0, 1, 1, 1, 20});
  all.push_back({"circle around others", kDirections, circle});
  return all;
}

TEST(Sphere, TrianglesAreTheConvexHull) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Triangulation mesh = triangulated(c.points, c.coordinates);
    expect_hull(mesh);
    EXPECT_EQ("", problem_of(mesh, c.points, c.coordinates));
  }
}

TEST(Sphere, PlacesAreThoseOfTheirDirections) {
  const Triangulation mesh =
      triangulated({0, 0, 0, 90, 90, 0, -90, 0, 180, 0, 123, -90, 540, 0, 30, 90, 45, 30}, kDegrees);
  const double kFar = HUGE_VAL;
  const Numbers places = {1, 0, 0, 0, 0, 1, 0, -1, -1, 0, kFar, kFar, -1, 0, 0, 0};
  EXPECT_EQ(places, Numbers(mesh.places.begin(), mesh.places.end() - 2));
  EXPECT_EQ((Ids{0, 1, 2, 3, 4, 5, 4, 1, 8}), mesh.representatives);
  // tan(30 degrees) at 45 degrees.
  EXPECT_DOUBLE_EQ(std::sqrt(1.0 / 6), mesh.places[16]);
  EXPECT_DOUBLE_EQ(std::sqrt(1.0 / 6), mesh.places[17]);
  // Degrees and directions agree, and directions return, to the last bits.
  testing::FixtureRandom random(5);
  for (int i = 0; i < 1000; ++i) {
    const double longitude = random.unit() * 720 - 360, latitude = random.unit() * 180 - 90;
    const double a = longitude * std::numbers::pi / 180, b = latitude * std::numbers::pi / 180;
    const Numbers direction = {std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
    const Numbers of_degrees = directions_of(triangulated({longitude, latitude}, kDegrees).places);
    const Numbers of_direction = directions_of(triangulated(direction, kDirections).places);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(direction[k], of_degrees[k], 2e-15);
      EXPECT_NEAR(direction[k], of_direction[k], 1e-15);
    }
  }
  // Of any length.
  for (const double length : {1e-320, 1e-160, 1.0, 1e160, 1e308}) {
    const Numbers of_direction = directions_of(triangulated({length, 0, -length}, kDirections).places);
    EXPECT_NEAR(std::sqrt(0.5), of_direction[0], 1e-15);
    EXPECT_NEAR(-std::sqrt(0.5), of_direction[2], 1e-15);
  }
}

TEST(Sphere, CellsAreThoseOfTheirPoints) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Triangulation mesh = triangulated(c.points, c.coordinates);
    const Voronoi dual = testing::triangulator().voronoi(mesh);
    const Numbers directions = directions_of(mesh.places);
    const std::size_t n = directions.size() / 3;
    const auto across = [](const double* a, const double* b) {
      return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
      const double* const centre = &dual.circumcentres[3 * t];
      EXPECT_NEAR(1, across(centre, centre), 1e-15);
      double nearest = -1;
      for (std::size_t i = 0; i < n; ++i) nearest = std::max(nearest, across(centre, &directions[3 * i]));
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(nearest,
                    across(centre, &directions[3 * static_cast<std::size_t>(mesh.triangles[3 * t + k])]),
                    1e-12);
      }
    }
    double area = 0;
    const bool is_cap = c.name.starts_with("cap");  // where nothing is left of areas after rounding
    for (std::size_t i = 0; i < n; ++i) {
      const auto first = dual.cells.begin() + dual.cell_offsets[i],
                 last = dual.cells.begin() + dual.cell_offsets[i + 1];
      area += dual.areas[i];
      if (!is_cap) {
        EXPECT_GE(dual.areas[i], -1e-13);
      }
      if (first == last) continue;
      EXPECT_EQ(*first, *std::min_element(first, last));
      for (auto at = first; at != last; ++at) {
        const auto t = static_cast<std::size_t>(*at);
        const auto next = static_cast<std::size_t>(at + 1 == last ? *first : at[1]);
        const std::int32_t* const v = &mesh.triangles[3 * t];
        const auto k = static_cast<std::size_t>(std::find(v, v + 3, static_cast<std::int32_t>(i)) - v);
        ASSERT_LT(k, 3u);
        EXPECT_EQ(next, static_cast<std::size_t>(mesh.neighbors[3 * t + (k + 1) % 3]));
      }
    }
    if (!is_cap) {
      EXPECT_NEAR(n > 0 ? 4 * std::numbers::pi : 0, area, 1e-12);
    }
  }
  const Voronoi octahedron = testing::triangulator().voronoi(
      triangulated({1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1}, kDirections));
  for (const double area : octahedron.areas) EXPECT_NEAR(4 * std::numbers::pi / 6, area, 1e-14);
}

TEST(Sphere, QueriesFindTheirTrianglesAndNearestPoints) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Triangulation mesh = triangulated(c.points, c.coordinates);
    Locator locator(testing::triangulator(), mesh);
    locator.set_coordinates(kDirections);
    Numbers queries = random_directions(40, 3);
    const Numbers own = directions_of(mesh.places);
    for (std::size_t i = 0; i < own.size(); ++i) {
      queries.push_back(own[i]);
      if (i % 3 == 2) queries.insert(queries.end(), {-own[i - 2], -own[i - 1], -own[i]});
    }
    queries.insert(queries.end(), {0, 0, -1, 0, 0, 1, 1, 0, 0});
    const std::size_t m = queries.size() / 3;
    const Ids found = locator.locate(queries.data(), m);
    const Ids nearest = locator.nearest(queries.data(), m);
    const std::vector<Exact> points = exact_places(mesh),
                             asked = exact_places(triangulated(queries, kDirections));
    Numbers values;
    for (std::size_t i = 0; i < points.size(); ++i)
      values.insert(values.end(), {static_cast<double>(i), own[3 * i] + 2 * own[3 * i + 1]});
    const Numbers between = locator.interpolate(values.data(), queries.data(), m, columns(2));
    for (std::size_t q = 0; q < m; ++q) {
      std::int32_t best = -1;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (mesh.representatives[i] != static_cast<std::int32_t>(i)) continue;
        const auto v = static_cast<std::int32_t>(i);
        const int sign = best < 0 ? 1
                                  : cmp(cosine(asked[q], points[i]),
                                        cosine(asked[q], points[static_cast<std::size_t>(best)]));
        if (sign > 0 || (sign == 0 && comes_first(mesh, v, best))) best = v;
      }
      EXPECT_EQ(best, nearest[q]) << q;
      std::int32_t within = -1;
      for (std::size_t t = 0; t < mesh.triangles.size() / 3 && within < 0; ++t) {
        const auto at = [&](std::size_t k) -> const Exact& {
          return points[static_cast<std::size_t>(mesh.triangles[3 * t + k % 3])];
        };
        if (turn_of(at(0), at(1), at(2)) <= 0) continue;
        bool is_in = true;
        for (std::size_t k = 0; k < 3; ++k) is_in = is_in && turn_of(at(k), at(k + 1), asked[q]) >= 0;
        if (is_in) within = static_cast<std::int32_t>(t);
      }
      EXPECT_EQ(within, found[q]) << q;
      EXPECT_EQ(within < 0, std::isnan(between[2 * q]));
      if (best >= 0 && within >= 0 && cosine(asked[q], points[static_cast<std::size_t>(best)]) == 1) {
        EXPECT_EQ(static_cast<double>(best), between[2 * q]);
      }
    }
  }
}

TEST(Sphere, PlanarPartsAreTheTriangulationsOfThePlane) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Triangulation mesh = triangulated(c.points, c.coordinates);
    const Plane plane = make_plane(mesh.places, mesh.point_offsets);
    const Triangulation part = planar_part(plane, mesh);
    const Triangulation planar =
        testing::triangulator().triangulate(plane.places().data(), plane.places().size() / 2);
    EXPECT_EQ(planar.triangles, part.triangles);
    EXPECT_EQ(planar.neighbors, part.neighbors);
    EXPECT_EQ(planar.representatives, part.representatives);
    EXPECT_EQ(planar.hull, part.hull);
  }
}

TEST(Sphere, LinearFunctionsInSpaceAreInterpolated) {
  // On the triangle in space, which is where the values are linear: of x / (the plane's value), at the query.
  const Triangulation mesh = triangulated(random_directions(50, 11), kDirections);
  Locator locator(testing::triangulator(), mesh);
  const Numbers own = directions_of(mesh.places), queries = random_directions(100, 12);
  const Ids found = locator.locate(queries.data(), 100);
  const Numbers between = locator.interpolate(own.data(), queries.data(), 100, columns(3));
  for (std::size_t q = 0; q < 100; ++q) {
    ASSERT_GE(found[q], 0);
    // The interpolated position has the query's direction.
    const double* const p = &between[3 * q];
    const double* const asked = &queries[3 * q];
    const double length = std::sqrt(asked[0] * asked[0] + asked[1] * asked[1] + asked[2] * asked[2]);
    const double size = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(asked[k] / length, p[k] / size, 1e-14);
  }
}

/// The weights of one query, by points.
std::map<std::int32_t, double> weights_of(Locator& locator, const double* query, Interpolation method) {
  const NaturalWeights found = locator.natural_weights(query, 1, method);
  std::map<std::int32_t, double> weights;
  for (std::size_t i = 0; i < found.points.size(); ++i) weights[found.points[i]] += found.weights[i];
  EXPECT_EQ(found.points.size(), weights.size());
  return weights;
}

TEST(Sphere, NaturalNeighborsAreWeighedByTheirCells) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Triangulation mesh = triangulated(c.points, c.coordinates);
    const Numbers own = directions_of(mesh.places);
    const std::size_t n = own.size() / 3;
    Locator locator(testing::triangulator(), mesh);
    locator.set_coordinates(kDirections);
    Numbers queries = random_directions(20, 8);
    for (std::size_t i = 0; i + 5 < own.size() && i < 60; i += 3) {
      for (const double share : {1.0, 1e-6}) {
        // On arcs, if the points are neighbours.
        const Direction at = {own[i] + share * own[i + 3], own[i + 1] + share * own[i + 4],
                              own[i + 2] + share * own[i + 5]};
        if (dot(at, at) > 0) queries.insert(queries.end(), {at.x, at.y, at.z});
      }
    }
    const Voronoi before = testing::triangulator().voronoi(mesh);
    for (std::size_t q = 0; q < queries.size() / 3; ++q) {
      const double* const query = &queries[3 * q];
      const auto sibson = weights_of(locator, query, Interpolation::sibson),
                 laplace = weights_of(locator, query, Interpolation::laplace);
      if (locator.locate(query, 1)[0] < 0) {
        ASSERT_TRUE(sibson.empty() && laplace.empty());
        continue;
      }
      Numbers with = own;
      with.insert(with.end(), query, query + 3);
      const Triangulation more = triangulated(with, kDirections);
      if (more.representatives[n] != static_cast<std::int32_t>(n)) {
        ASSERT_EQ((std::map<std::int32_t, double>{
                      {mesh.representatives[static_cast<std::size_t>(more.representatives[n])], 1}}),
                  sibson);
        ASSERT_EQ(sibson, laplace);
        continue;
      }
      // Directions are rounded once more, which may move points that are near each other.
      if (more.places != [&] {
            Numbers places = mesh.places;
            places.insert(places.end(), more.places.end() - 2, more.places.end());
            return places;
          }())
        continue;
      const Voronoi after = testing::triangulator().voronoi(more);
      // Neighbours with the lengths of edges between centres, around the new cell.
      std::map<std::int32_t, double> lengths;
      double whole = 0, sum = 0;
      const auto centre = [&](std::int32_t t) {
        const double* const p = &after.circumcentres[3 * static_cast<std::size_t>(t)];
        return Direction{p[0], p[1], p[2]};
      };
      const Direction at = direction_of(place_at(more.places, n));
      for (std::int32_t k = after.cell_offsets[n]; k < after.cell_offsets[n + 1]; ++k) {
        const std::int32_t t = after.cells[static_cast<std::size_t>(k)];
        const std::int32_t next = k + 1 < after.cell_offsets[n + 1]
                                      ? after.cells[static_cast<std::size_t>(k) + 1]
                                      : after.cells[static_cast<std::size_t>(after.cell_offsets[n])];
        const std::int32_t* const v = &more.triangles[3 * static_cast<std::size_t>(t)];
        const auto corner = static_cast<std::size_t>(std::find(v, v + 3, static_cast<std::int32_t>(n)) - v);
        const std::int32_t other = v[(corner + 2) % 3];
        const double length =
            angle_between(centre(t), centre(next)) /
            angle_between(at, direction_of(place_at(more.places, static_cast<std::size_t>(other))));
        lengths[other] += length;
        whole += length;
      }
      for (const auto& [v, weight] : laplace) {
        EXPECT_GE(weight, 0);
        EXPECT_NEAR(lengths[v] / whole, weight, 1e-7) << q << " " << v;
        sum += weight;
      }
      EXPECT_NEAR(1, sum, 1e-14);
      sum = 0;
      const double area = after.areas[n];
      for (const auto& [v, weight] : sibson) {
        EXPECT_GE(weight, 0);
        const auto i = static_cast<std::size_t>(v);
        if (area > 1e-6) {
          EXPECT_NEAR((before.areas[i] - after.areas[i]) / area, weight, 1e-13 / area + 1e-9)
              << q << " " << v;
        }
        sum += weight;
      }
      EXPECT_NEAR(1, sum, 1e-14);
    }
    // At points, the values of these; of several ways to give the same points the same bytes.
    Numbers values, turned, of_turned;
    for (std::size_t i = 0; i < n; ++i)
      values.push_back(std::sqrt(static_cast<double>(mesh.representatives[i]) + 2));
    for (std::size_t i = n; i-- > 0;) {
      turned.insert(turned.end(), own.begin() + static_cast<std::ptrdiff_t>(3 * i),
                    own.begin() + static_cast<std::ptrdiff_t>(3 * i + 3));
      of_turned.push_back(values[i]);
    }
    const Triangulation other_mesh = triangulated(turned, kDirections);
    Locator other(testing::triangulator(), other_mesh);
    bool are_the_same = true;
    for (std::size_t i = 0; i < n; ++i) {
      const Point a = place_at(other_mesh.places, n - 1 - i), b = place_at(mesh.places, i);
      are_the_same &= a.x == b.x && a.y == b.y;
    }
    InterpolationOptions options;
    options.fill = -1;
    for (const Interpolation method :
         {Interpolation::linear, Interpolation::nearest, Interpolation::sibson, Interpolation::laplace}) {
      options.method = method;
      const Numbers found = locator.interpolate(values.data(), queries.data(), queries.size() / 3, options);
      if (are_the_same && method != Interpolation::linear) {
        EXPECT_EQ(other.interpolate(of_turned.data(), queries.data(), queries.size() / 3, options), found);
      }
      if (!are_the_same) continue;
      const Numbers at_points = locator.interpolate(values.data(), own.data(), n, options);
      for (std::size_t i = 0; i < n; ++i) {
        if (at_points[i] != -1) {
          EXPECT_EQ(values[i], at_points[i]) << i;
        }
      }
    }
  }
}

TEST(Sphere, NaturalNeighborsAreContinuous) {
  const Numbers points = random_directions(60, 31);
  const Triangulation mesh = triangulated(points, kDirections);
  Locator locator(testing::triangulator(), mesh);
  Numbers values, queries;
  for (std::size_t i = 0; i < points.size(); i += 3)
    values.push_back(points[i] + std::sin(3 * points[i + 1]));
  // Along a circle that crosses arcs, circles of triangles, and a point.
  constexpr std::size_t kSteps = 200000;
  for (std::size_t i = 0; i <= kSteps; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kSteps;
    for (std::size_t k = 0; k < 3; ++k)
      queries.push_back(std::cos(angle) * points[k] + std::sin(angle) * (points[3 + k] + 0.25));
  }
  InterpolationOptions options;
  for (const Interpolation method : {Interpolation::sibson, Interpolation::laplace}) {
    options.method = method;
    const Numbers found = locator.interpolate(values.data(), queries.data(), queries.size() / 3, options);
    EXPECT_NEAR(values[0], found[0], 1e-12);
    for (std::size_t i = 0; i < kSteps; ++i) ASSERT_NEAR(found[i], found[i + 1], 1e-2) << i;
  }
}

/// The gradients with the least curvature along arcs, by elimination in the whole system: of two unknowns per
/// point, along vectors across it.
Numbers least_curved(const Triangulation& mesh, const Numbers& values) {
  const std::size_t n = values.size();
  std::vector<std::array<Direction, 2>> across(n);
  const auto at = [&](std::size_t i) { return direction_of(place_at(mesh.places, i)); };
  for (std::size_t i = 0; i < n; ++i) {
    const Direction axis = std::fabs(at(i).x) < 0.5 ? Direction{1, 0, 0} : Direction{0, 1, 0};
    const Direction x = cross(axis, at(i));
    const double length = std::sqrt(dot(x, x));
    across[i][0] = {x.x / length, x.y / length, x.z / length};
    across[i][1] = cross(at(i), across[i][0]);
  }
  std::vector<Numbers> rows(2 * n, Numbers(2 * n + 1, 0));
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const auto u = static_cast<std::size_t>(mesh.triangles[c / 3 * 3 + (c + 1) % 3]),
               v = static_cast<std::size_t>(mesh.triangles[c / 3 * 3 + (c + 2) % 3]);
    const double cosine = dot(at(u), at(v)), length = std::acos(cosine);
    const auto tangent = [&](const Direction& from, const Direction& to) {
      const double scale = length / std::sin(length);
      return Direction{scale * (to.x - cosine * from.x), scale * (to.y - cosine * from.y),
                       scale * (to.z - cosine * from.z)};
    };
    // Each arc is there in both directions.
    const Direction e = tangent(at(u), at(v)), back = tangent(at(v), at(u)), on = {-back.x, -back.y, -back.z};
    for (std::size_t i = 0; i < 2; ++i) {
      const double slope = dot(e, across[u][i]) / std::pow(length, 3);
      for (std::size_t j = 0; j < 2; ++j) {
        rows[2 * u + i][2 * u + j] += 4 * slope * dot(e, across[u][j]);
        rows[2 * u + i][2 * v + j] += 2 * slope * dot(on, across[v][j]);
      }
      rows[2 * u + i][2 * n] += 6 * slope * (values[v] - values[u]);
    }
  }
  for (std::size_t i = 0; i < 2 * n; ++i) {
    for (std::size_t j = 0; j < 2 * n; ++j) {
      if (i == j) continue;
      const double factor = rows[j][i] / rows[i][i];
      for (std::size_t k = i; k <= 2 * n; ++k) rows[j][k] -= factor * rows[i][k];
    }
  }
  Numbers gradients;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = rows[2 * i][2 * n] / rows[2 * i][2 * i],
                 y = rows[2 * i + 1][2 * n] / rows[2 * i + 1][2 * i + 1];
    const auto& [a, b] = across[i];
    gradients.insert(gradients.end(), {x * a.x + y * b.x, x * a.y + y * b.y, x * a.z + y * b.z});
  }
  return gradients;
}

TEST(Sphere, GradientsBendLeast) {
  const Triangulation mesh = triangulated(random_directions(40, 5), kDirections);
  Locator locator(testing::triangulator(), mesh);
  Numbers values;
  for (std::size_t i = 0; i < 40; ++i) values.push_back(static_cast<double>(i * 7 % 11));
  const Numbers expected = least_curved(mesh, values);
  GradientOptions exact;
  exact.tolerance = 0;
  const Numbers found = locator.gradients(values.data(), 1, exact);
  ASSERT_EQ(expected.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(expected[i], found[i], 1e-9);
}

TEST(Sphere, SmoothInterpolationHasAContinuousGradient) {
  const Numbers points = random_directions(80, 17);
  const Triangulation mesh = triangulated(points, kDirections);
  const Numbers own = directions_of(mesh.places);
  Locator locator(testing::triangulator(), mesh);
  Numbers values, gradients;
  const auto height = [](const double* p) { return 2 * p[0] - p[1] + p[0] * p[2]; };
  for (std::size_t i = 0; i < own.size(); i += 3) {
    const double* const p = &own[i];
    values.push_back(height(p));
    const Direction slope = {2 + p[2], -1, p[0]};
    const double radial = slope.x * p[0] + slope.y * p[1] + slope.z * p[2];
    gradients.insert(gradients.end(),
                     {slope.x - radial * p[0], slope.y - radial * p[1], slope.z - radial * p[2]});
  }
  InterpolationOptions options;
  options.method = Interpolation::clough_tocher;
  EXPECT_EQ(values, locator.interpolate(values.data(), points.data(), values.size(), options));
  // With the right gradients nearer to the function, but never linear as that in triangles.
  const Numbers elsewhere = random_directions(500, 2);
  const auto error_of = [&](const InterpolationOptions& by) {
    const Numbers found = locator.interpolate(values.data(), elsewhere.data(), 500, by);
    double most = 0;
    for (std::size_t q = 0; q < 500; ++q) {
      double p[3], length = 0;
      for (std::size_t k = 0; k < 3; ++k) length += elsewhere[3 * q + k] * elsewhere[3 * q + k];
      for (std::size_t k = 0; k < 3; ++k) p[k] = elsewhere[3 * q + k] / std::sqrt(length);
      most = std::max(most, std::fabs(found[q] - height(p)));
    }
    return most;
  };
  const double linear = error_of({}), estimated = error_of(options);
  options.gradients = gradients.data();
  const double given = error_of(options);
  EXPECT_LT(4 * estimated, linear);
  EXPECT_LT(8 * given, linear);
  options.gradients = nullptr;
  // Slopes before and behind each arc and corner that a circle crosses.
  constexpr std::size_t kSteps = 200000;
  Numbers queries;
  for (std::size_t i = 0; i <= kSteps; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / kSteps;
    for (std::size_t k = 0; k < 3; ++k)
      queries.push_back(std::cos(angle) * own[k] + std::sin(angle) * (k == 1));
  }
  const Numbers found = locator.interpolate(values.data(), queries.data(), kSteps + 1, options);
  const double step = 2 * std::numbers::pi / kSteps;
  for (std::size_t i = 1; i < kSteps; ++i)
    ASSERT_NEAR(found[i] - found[i - 1], found[i + 1] - found[i], 1e-2 * step) << i;
  // Of a hemisphere alone.
  Numbers north;
  for (std::size_t i = 0; i < own.size(); i += 3) {
    if (own[i + 2] > 0.1)
      north.insert(north.end(), own.begin() + static_cast<std::ptrdiff_t>(i),
                   own.begin() + static_cast<std::ptrdiff_t>(i + 3));
  }
  const Numbers ones(north.size() / 3, 1);
  Locator half(testing::triangulator(), triangulated(north, kDirections));
  const double pole[] = {0, 0, 1};
  EXPECT_NEAR(1, half.interpolate(ones.data(), pole, 1, options)[0], 1e-14);
}

TEST(Sphere, ErrorsSayWhatIsWrong) {
  testing::expect_error(ErrorKind::input, "point 1: the latitude 90.5", [] {
    triangulated({0, 0, 7, 90.5}, kDegrees);
  });
  testing::expect_error(ErrorKind::input, "point 1 is the vector 0", [] {
    triangulated({0, 0, 7, 0, 0, 0}, kDirections);
  });
  testing::expect_error(ErrorKind::input, "point 0 is not finite", [] {
    triangulated({HUGE_VAL, 0}, kDegrees);
  });
  testing::expect_error(ErrorKind::usage, "NULL",
                        [] { testing::triangulator().triangulate(nullptr, 3, Space::sphere(kDegrees)); });
  testing::expect_error(ErrorKind::usage, "offsets", [] {
    const double points[] = {1, 2, 3, 4};
    testing::triangulator().triangulate(points, {1, 2}, Space::sphere(kDegrees));
  });
  Triangulation mesh = triangulated(random_directions(9, 1), kDirections);
  Locator locator(testing::triangulator(), mesh);
  const double query[] = {0, 100};
  testing::expect_error(ErrorKind::input, "query 0: the latitude 100", [&] {
    locator.set_coordinates(kDegrees);
    locator.nearest(query, 1);
  });
  // A second copy of a triangle, to which no other one leads: walks around its corners would not come back.
  Triangulation twice = mesh;
  twice.triangles.insert(twice.triangles.begin(), mesh.triangles.begin(), mesh.triangles.begin() + 3);
  twice.neighbors.insert(twice.neighbors.begin(), mesh.neighbors.begin(), mesh.neighbors.begin() + 3);
  for (std::int32_t& t : twice.neighbors) ++t;
  ++twice.triangle_offsets.back();
  testing::expect_error(ErrorKind::usage, "triangulation on the sphere",
                        [&] { Locator(testing::triangulator(), twice); });
  mesh.neighbors[4] = (mesh.neighbors[4] + 1) % 14;
  testing::expect_error(ErrorKind::usage, "triangulation on the sphere",
                        [&] { testing::triangulator().voronoi(mesh); });
  testing::expect_error(ErrorKind::usage, "triangulation on the sphere",
                        [&] { Locator(testing::triangulator(), mesh); });
}

TEST(Sphere, ManyPointsHaveAllTriangles) {
  // A hull of 3,000 points around the pole, and as many elsewhere.
  Numbers points = random_directions(3000, 21);
  for (int k = 0; k < 3000; ++k) {
    const double angle = k * 2 * std::numbers::pi / 3000;
    points.insert(points.end(), {std::cos(angle), std::sin(angle), -20.0});
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.size(); i += 3) {
    const double length =
        std::sqrt(points[i] * points[i] + points[i + 1] * points[i + 1] + points[i + 2] * points[i + 2]);
    if (points[i + 2] < -20 / std::sqrt(401) * length && points[i + 2] != -20) continue;
    std::copy_n(&points[i], 3, &points[kept]);
    kept += 3;
  }
  points.resize(kept);
  const Triangulation mesh = triangulated(points, kDirections);
  EXPECT_EQ(2 * kept / 3 - 4, mesh.triangles.size() / 3);
  const Voronoi dual = testing::triangulator().voronoi(mesh);
  double area = 0;
  for (const double each : dual.areas) area += each;
  EXPECT_NEAR(4 * std::numbers::pi, area, 1e-10);
  EXPECT_EQ("", problem_of(mesh, points, kDirections));
  // Each edge is locally convex, exactly, and the surface closed: so it is the hull.
  const std::vector<Exact> exact_points = exact_places(mesh);
  for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
    const auto at = [&](std::size_t k) -> const Exact& {
      return exact_points[static_cast<std::size_t>(mesh.triangles[3 * t + k])];
    };
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t* const w = &mesh.triangles[3 * static_cast<std::size_t>(mesh.neighbors[3 * t + k])];
      for (std::size_t j = 0; j < 3; ++j) {
        ASSERT_LE(outside(at(0), at(1), at(2), exact_points[static_cast<std::size_t>(w[j])]), 0);
      }
    }
  }
}

/// A closed surface, of which edges can be replaced by others.
class Surface {
 public:
  explicit Surface(const Triangulation& mesh) : mesh_(mesh), twins_(mesh.triangles.size()) {
    for (std::size_t e = 0; e < twins_.size(); ++e) {
      twins_[e] = 3 * static_cast<std::size_t>(mesh.neighbors[e]);
      while (mesh_.triangles[next(twins_[e])] != mesh_.triangles[previous(e)] ||
             mesh_.triangles[previous(twins_[e])] != mesh_.triangles[next(e)])
        ++twins_[e];
    }
  }

  /// The edge opposite to corner e becomes the other diagonal, unless the surface is too narrow there.
  void flip(std::size_t e) {
    Ids& corner = mesh_.triangles;
    const std::size_t f = twins_[e], beyond_e = twins_[next(f)], beyond_f = twins_[next(e)];
    for (const std::size_t beyond : {beyond_e, beyond_f}) {
      if (corner[e] == corner[f] || beyond / 3 == e / 3 || beyond / 3 == f / 3) return;
    }
    corner[previous(e)] = corner[f];
    corner[previous(f)] = corner[e];
    join(e, beyond_e);
    join(f, beyond_f);
    join(next(e), next(f));
  }

  /// Triangles from their smallest corners on, and their neighbours.
  Triangulation mesh() const {
    Triangulation result = mesh_;
    for (std::size_t t = 0; t < twins_.size(); t += 3) {
      const auto first = static_cast<std::size_t>(
          std::min_element(&mesh_.triangles[t], &mesh_.triangles[t] + 3) - mesh_.triangles.data());
      std::size_t e = first;
      for (std::size_t k = 0; k < 3; ++k, e = next(e)) {
        result.triangles[t + k] = mesh_.triangles[e];
        result.neighbors[t + k] = static_cast<std::int32_t>(twins_[e] / 3);
      }
    }
    return result;
  }

 private:
  static std::size_t next(std::size_t e) { return e % 3 == 2 ? e - 2 : e + 1; }
  static std::size_t previous(std::size_t e) { return next(next(e)); }
  void join(std::size_t e, std::size_t f) {
    twins_[e] = f;
    twins_[f] = e;
  }

  Triangulation mesh_;
  std::vector<std::size_t> twins_;
};

/// What does not depend on the order of triangles: the corners of each, and of its neighbours.
auto contents(const Triangulation& mesh) {
  std::multiset<Ids> result;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    Ids triangle(&mesh.triangles[t], &mesh.triangles[t] + 3);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t* const other = &mesh.triangles[3 * static_cast<std::size_t>(mesh.neighbors[t + k])];
      triangle.insert(triangle.end(), other, other + 3);
    }
    result.insert(triangle);
  }
  return result;
}

TEST(Sphere, VerifyRefusesOtherSurfaces) {
  testing::FixtureRandom random(11);
  std::size_t right = 0, wrong = 0;
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const Triangulation hull = triangulated(c.points, c.coordinates);
    if (hull.triangles.empty()) continue;
    const auto expected = contents(hull);
    Surface surface(hull);
    for (int step = 0; step < 1000; ++step) {
      if (random.integer(0, 9) == 0) surface = Surface(hull);
      surface.flip(
          static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(hull.triangles.size()) - 1)));
      const Triangulation mesh = surface.mesh();
      const bool is_right = contents(mesh) == expected;
      ASSERT_EQ(is_right, problem_of(mesh, c.points, c.coordinates).empty()) << step;
      ++(is_right ? right : wrong);
    }
  }
  EXPECT_GT(right, 100u);
  EXPECT_GT(wrong, 10000u);
}

/// A closed surface of triangles whose edges occur once in each direction.
Triangulation surface_of(const Ids& triangles, Triangulation mesh) {
  mesh.triangles = triangles;
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> at_edge;
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const std::size_t t = c - c % 3;
    at_edge[{triangles[t + (c + 1) % 3], triangles[t + (c + 2) % 3]}] = static_cast<std::int32_t>(c / 3);
  }
  EXPECT_EQ(triangles.size(), at_edge.size());
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const std::size_t t = c - c % 3;
    mesh.neighbors[c] = at_edge.at({triangles[t + (c + 2) % 3], triangles[t + (c + 1) % 3]});
  }
  return mesh;
}

TEST(Sphere, VerifyRefusesSurfacesThatWindTwice) {
  // Two pyramids over a polygon around each axis, whose corners are visited in steps of one or of two: all
  // edges are convex, too.
  const std::vector<Direction> axes = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {3, -4, 8}, {3, 9, -2}};
  for (const int corners : {5, 7, 9}) {
    for (const Direction& axis : axes) {
      const Direction across = cross(axis, {1, 2, 3}), up = cross(axis, across);
      const double height = std::sqrt(dot(axis, axis));
      Numbers points = {axis.x, axis.y, axis.z, -axis.x, -axis.y, -axis.z};
      for (int k = 0; k < corners; ++k) {
        const double angle = 2 * std::numbers::pi * k / corners, u = height * std::cos(angle),
                     v = std::sin(angle);
        points.insert(points.end(),
                      {u * across.x + v * up.x, u * across.y + v * up.y, u * across.z + v * up.z});
      }
      const Triangulation mesh = triangulated(points, kDirections);
      for (const int step : {1, 2}) {
        Ids triangles;
        for (int k = 0; k < corners; ++k) {
          const std::int32_t from = 2 + k * step % corners, to = 2 + (k + 1) * step % corners;
          triangles.insert(triangles.end(), {0, from, to, 1, to, from});
        }
        const std::string problem = problem_of(surface_of(triangles, mesh), points, kDirections);
        EXPECT_EQ(step == 1, problem.empty()) << problem;
      }
    }
  }
}

TEST(Sphere, VerifyFindsWhatIsWrong) {
  using Mesh = Triangulation;
  for (const double pole : {0.0, 1.0}) {
    Numbers points = random_directions(70, 3);
    points.insert(points.end(), {pole, 0, -1, points[0], points[1], points[2]});
    const Mesh right = triangulated(points, kDirections);
    const auto expect_problem = [&](const char* part, const auto& change) {
      Mesh wrong = right;
      change(wrong);
      const std::string problem = problem_of(wrong, points, kDirections);
      EXPECT_NE("", problem);
      EXPECT_NE(std::string::npos, problem.find(part)) << problem << " has no " << part;
    };
    EXPECT_EQ("", problem_of(right, points, kDirections));
    expect_problem("point 3 has a wrong place", [](Mesh& mesh) { mesh.places[6] += 0x1p-40; });
    expect_problem("point 71 has a wrong representative", [](Mesh& mesh) { mesh.representatives[71] = 1; });
    expect_problem("point 71 has a wrong representative", [](Mesh& mesh) { mesh.representatives[71] = 71; });
    expect_problem("point 5 has a wrong representative", [](Mesh& mesh) { mesh.representatives[5] = -1; });
    expect_problem("another point represents",
                   [](Mesh& mesh) { std::replace(mesh.triangles.begin(), mesh.triangles.end(), 0, 71); });
    expect_problem("smallest index", [](Mesh& mesh) {
      std::rotate(mesh.triangles.begin(), mesh.triangles.begin() + 1, mesh.triangles.begin() + 3);
    });
    expect_problem("two equal corners", [](Mesh& mesh) { mesh.triangles[1] = mesh.triangles[2]; });
    expect_problem("", [](Mesh& mesh) { std::swap(mesh.triangles[1], mesh.triangles[2]); });
    expect_problem("not neighbors", [](Mesh& mesh) { std::swap(mesh.neighbors[0], mesh.neighbors[1]); });
    expect_problem("has 137 triangles, not 138", [](Mesh& mesh) {
      mesh.triangles.resize(mesh.triangles.size() - 3);
      mesh.neighbors.resize(mesh.triangles.size());
      for (std::int32_t& t : mesh.neighbors) t = std::min(t, 136);
      mesh.triangle_offsets[1] = 137;
    });
    expect_problem("sets", [](Mesh& mesh) {
      mesh.point_offsets = {0, 1, 72};
      mesh.triangle_offsets = {0, 0, 138};
    });
    // All triangles inside out.
    expect_problem("", [](Mesh& mesh) {
      for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
        std::swap(mesh.triangles[t + 1], mesh.triangles[t + 2]);
        std::swap(mesh.neighbors[t + 1], mesh.neighbors[t + 2]);
      }
    });
    testing::expect_error(ErrorKind::usage, "triangulation on the sphere", [&] {
      Mesh wrong = right;
      wrong.neighbors.pop_back();
      problem_of(wrong, points, kDirections);
    });
  }
  // Two points with one place.
  const Numbers twice = {1, 2, 3, 1, 2, 3};
  Mesh equal = triangulated(twice, kDirections);
  equal.representatives[1] = 1;
  EXPECT_NE("", problem_of(equal, twice, kDirections));
}

}  // namespace
}  // namespace flaunay::sphere
