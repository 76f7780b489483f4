// Regular triangulations on a torus or a cylinder, beside those of copies of the points in the plane.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "flaunay/verify.hpp"
#include "flaunay/weighted.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/same.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing::weighted_tori {
namespace {

using Numbers = std::vector<double>;
using Ids = std::vector<std::int32_t>;
using Offsets = std::vector<std::size_t>;

struct WeightedPoints {
  std::string name;
  Coordinates coordinates;
  Numbers weights;

  std::size_t size() const { return weights.size(); }
};

/// A corner: its point, and where it is in periods.
using Corner = std::array<int, 3>;
/// From the smallest corner on, which has the periods 0, 0.
using Triangle = std::array<Corner, 3>;

Triangle from_smallest(const Triangle& corners) {
  Triangle least{};
  for (std::size_t first = 0; first < 3; ++first) {
    Triangle row{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Corner& c = corners[(first + k) % 3];
      row[k] = {c[0], c[1] - corners[first][1], c[2] - corners[first][2]};
    }
    least = first == 0 ? row : std::min(least, row);
  }
  return least;
}

Triangle triangle_of(const Triangulation& mesh, std::size_t t) {
  Triangle corners{};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t c = 3 * t + k;
    corners[k] = {mesh.triangles[c], mesh.corner_offsets[2 * c], mesh.corner_offsets[2 * c + 1]};
  }
  return from_smallest(corners);
}

std::multiset<Triangle> triangles_of(const Triangulation& mesh) {
  std::multiset<Triangle> all;
  for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) all.insert(triangle_of(mesh, t));
  return all;
}

/// Copies of all points in the plane, so many on each side along the axes that have a period; first those in
/// the middle.
struct Copies {
  Copies(const WeightedPoints& points, const Numbers& in_middle, const Period& period, int sides)
      : n(points.size()) {
    const int across = std::isfinite(period.x) ? sides : 0, up = std::isfinite(period.y) ? sides : 0;
    for (int x = -across; x <= across; ++x) {
      for (int y = -up; y <= up; ++y) {
        if (x != 0 || y != 0) copies.push_back({x, y});
      }
    }
    Numbers weights;
    for (const auto& [x, y] : copies) {
      for (std::size_t i = 0; i < n; ++i) {
        places.push_back(x == 0 ? in_middle[2 * i] : in_middle[2 * i] + x * period.x);
        places.push_back(y == 0 ? in_middle[2 * i + 1] : in_middle[2 * i + 1] + y * period.y);
        weights.push_back(points.weights[i]);
      }
    }
    mesh = triangulator().triangulate(places.data(), weights.size(),
                                      Space::plane().with_weights(weights.data()));
  }

  Triangle triangle(std::size_t t) const {
    Triangle corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(mesh.triangles[3 * t + k]);
      corners[k] = {static_cast<int>(v % n), copies[v / n][0], copies[v / n][1]};
    }
    return from_smallest(corners);
  }
  bool is_in_middle(std::int32_t v) const { return static_cast<std::size_t>(v) < n; }
  /// Those with a corner in the middle.
  std::multiset<Triangle> triangles() const {
    std::set<Triangle> different;
    for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
      const std::int32_t* const corners = &mesh.triangles[3 * t];
      if (std::any_of(corners, corners + 3, [&](std::int32_t v) { return is_in_middle(v); }))
        different.insert(triangle(t));
    }
    return {different.begin(), different.end()};
  }
  Ids hidden() const {
    Ids there;
    std::copy_if(mesh.hidden.begin(), mesh.hidden.end(), std::back_inserter(there),
                 [&](std::int32_t v) { return is_in_middle(v); });
    return there;
  }
  /// What the points have, by copy.
  Numbers repeated(const Numbers& values) const {
    Numbers all;
    for (std::size_t k = 0; k < copies.size(); ++k) all.insert(all.end(), values.begin(), values.end());
    return all;
  }

  std::size_t n;
  std::vector<std::array<int, 2>> copies = {{0, 0}};
  Numbers places;
  Triangulation mesh;
};

Triangulation triangulated(const WeightedPoints& points, const Period& period) {
  return triangulator().triangulate(points.coordinates.data(), points.size(),
                                    Space::torus(period).with_weights(points.weights.data()));
}

/// Places of few bits, so that all copies are exact.
WeightedPoints any_points(FixtureRandom& random, std::size_t n, double bits, int kind) {
  const double unit = std::exp2(-bits), share = 1 / static_cast<double>(n);
  WeightedPoints points{
      "kind " + std::to_string(kind) + " of " + std::to_string(n) + ", bits " + std::to_string(bits), {}, {}};
  for (std::size_t i = 0; i < n; ++i) {
    const double x = std::floor(random.unit() / unit) * unit, y = std::floor(random.unit() / unit) * unit;
    points.coordinates.insert(points.coordinates.end(), {x, y});
    const double any = random.unit();
    points.weights.push_back(kind == 0   ? any * share
                             : kind == 1 ? static_cast<double>(random.integer(0, 3)) * unit * unit
                             : kind == 2 ? x * x + y * y
                             : kind == 3 ? (random.integer(0, 9) == 0 ? 1 : 0.01) * any - 3
                                         : any * 20);
  }
  return points;
}

const std::vector<Period> kPeriods = {{1, 1}, {1, 0.5}, {0.25, 2}, {1, HUGE_VAL}, {HUGE_VAL, 0.5}};

TEST(WeightedPeriodic, IsThatOfCopiesInThePlane) {
  FixtureRandom random(1);
  std::size_t hidden = 0, triangles = 0;
  for (int round = 0; round < 500; ++round) {
    const std::size_t n = static_cast<std::size_t>(random.integer(1, round % 10 == 0 ? 150 : 14));
    const double bits = round % 3 == 0 ? 3 : round % 3 == 1 ? 5 : 40;
    const WeightedPoints points = any_points(random, n, bits, round % 5);
    const Period period = kPeriods[static_cast<std::size_t>(round / 5) % kPeriods.size()];
    SCOPED_TRACE(points.name + ", " + std::to_string(period.x) + " " + std::to_string(period.y));
    const Triangulation mesh = triangulated(points, period);
    ASSERT_EQ("", verify(mesh.places.data(), mesh.point_offsets,
                         mesh.space.with_weights(points.weights.data()), mesh));
    for (const int sides : {1, 2}) {
      const Copies copies(points, mesh.places, period, sides);
      ASSERT_EQ(copies.hidden(), mesh.hidden);
      ASSERT_TRUE(copies.triangles() == triangles_of(mesh));
    }
    hidden += mesh.hidden.size();
    triangles += mesh.triangles.size() / 3;
  }
  EXPECT_GT(hidden, 2000u);
  EXPECT_GT(triangles, 4000u);
}

TEST(WeightedPeriodic, QueriesAreThoseOfCopiesInThePlane) {
  FixtureRandom random(5);
  std::size_t inside = 0, outside = 0;
  for (int round = 0; round < 200; ++round) {
    const auto n = static_cast<std::size_t>(random.integer(1, round % 10 == 0 ? 400 : 14));
    const WeightedPoints points = any_points(random, n, round % 3 == 0 ? 5 : 30, round % 5);
    const Period period = kPeriods[static_cast<std::size_t>(round / 5) % kPeriods.size()];
    SCOPED_TRACE(points.name + ", " + std::to_string(period.x) + " " + std::to_string(period.y));
    const Triangulation mesh = triangulated(points, period);
    Locator locator(triangulator(), mesh, points.weights.data());
    const Copies copies(points, mesh.places, period, 3);
    Locator plane(triangulator(), copies.places.data(), copies.places.size() / 2, copies.mesh);
    Numbers queries, values, slopes;
    constexpr std::size_t kQueries = 30;
    for (std::size_t i = 0; i < kQueries; ++i)
      queries.insert(queries.end(),
                     {random.unit() * std::min(period.x, 1.0), random.unit() * std::min(period.y, 1.0)});
    for (std::size_t i = 0; i < n; ++i) {
      values.push_back(random.unit());
      slopes.insert(slopes.end(), {random.unit(), random.unit()});
    }
    const Ids found = locator.locate(queries.data(), kQueries),
              expected = plane.locate(queries.data(), kQueries);
    for (std::size_t i = 0; i < kQueries; ++i) {
      ASSERT_EQ(expected[i] < 0, found[i] < 0);
      ++(found[i] < 0 ? outside : inside);
      if (found[i] < 0) continue;
      ASSERT_EQ(copies.triangle(static_cast<std::size_t>(expected[i])),
                triangle_of(mesh, static_cast<std::size_t>(found[i])));
    }
    const Numbers all_values = copies.repeated(values), all_slopes = copies.repeated(slopes);
    InterpolationOptions options;
    options.fill = -1;
    for (const Interpolation method : {Interpolation::linear, Interpolation::clough_tocher}) {
      options.method = method;
      options.gradients = all_slopes.data();
      const Numbers in_plane = plane.interpolate(all_values.data(), queries.data(), kQueries, options);
      options.gradients = slopes.data();
      const Numbers on_torus = locator.interpolate(values.data(), queries.data(), kQueries, options);
      for (std::size_t i = 0; i < kQueries; ++i) ASSERT_NEAR(in_plane[i], on_torus[i], 1e-9) << i;
    }
    // Hidden points have no gradients, and have no part in others.
    const Numbers gradients = locator.gradients(values.data());
    for (std::size_t i = 0; i < n; ++i) {
      const auto v = static_cast<std::int32_t>(i);
      ASSERT_EQ(std::count(mesh.triangles.begin(), mesh.triangles.end(), v) == 0,
                std::isnan(gradients[2 * i]));
    }
    options.gradients = gradients.data();
    const Numbers given = locator.interpolate(values.data(), queries.data(), kQueries, options);
    options.gradients = nullptr;
    EXPECT_EQ(given, locator.interpolate(values.data(), queries.data(), kQueries, options));
  }
  EXPECT_GT(inside, 2000u);
  EXPECT_GT(outside, 200u);
}

TEST(WeightedPeriodic, EqualWeightsGiveTheBytesOfTheDelaunayTriangulation) {
  FixtureRandom random(2);
  for (const Period& period : kPeriods) {
    for (const std::size_t n : {0, 1, 2, 5, 50, 3000}) {
      const WeightedPoints points = any_points(random, n, n == 50 ? 3 : 52, 0);
      for (const double weight : {0.0, -7.5, 0x1p20}) {
        const Numbers weights(n, weight);
        const Triangulation mesh = triangulator().triangulate(
            points.coordinates.data(), n, Space::torus(period).with_weights(weights.data()));
        const Triangulation plain =
            triangulator().triangulate(points.coordinates.data(), n, Space::torus(period));
        EXPECT_TRUE(mesh.hidden.empty());
        EXPECT_TRUE(same(mesh.places, plain.places));
        EXPECT_TRUE(same(mesh.triangles, plain.triangles));
        EXPECT_TRUE(same(mesh.corner_offsets, plain.corner_offsets));
        EXPECT_TRUE(same(mesh.neighbors, plain.neighbors));
        EXPECT_TRUE(same(mesh.representatives, plain.representatives));
        EXPECT_EQ(mesh.triangle_offsets, plain.triangle_offsets);
        EXPECT_EQ(mesh.images, plain.images);
        EXPECT_EQ("", verify(mesh.places.data(), mesh.point_offsets, mesh.space.with_weights(weights.data()),
                             mesh));
      }
    }
  }
}

TEST(WeightedPeriodic, ManyPointsAndSetsThatNeedWiderMargins) {
  FixtureRandom random(3);
  WeightedPoints all{"sets", {}, {}};
  Offsets offsets{0};
  // One heavy point beside which most are hidden, so that images from farther away are needed; and even ones.
  for (const double heavy : {0.0, 0.1, 0.02, 0.3}) {
    WeightedPoints points = any_points(random, 4000, 52, 0);
    points.weights[7] = heavy;
    all.coordinates.insert(all.coordinates.end(), points.coordinates.begin(), points.coordinates.end());
    all.weights.insert(all.weights.end(), points.weights.begin(), points.weights.end());
    offsets.push_back(all.size());
  }
  for (const Period& period : {Period{1, 1}, {1, HUGE_VAL}}) {
    const Triangulation mesh = triangulator().triangulate(
        all.coordinates.data(), offsets, Space::torus(period).with_weights(all.weights.data()));
    EXPECT_EQ("", verify(mesh.places.data(), mesh.point_offsets, mesh.space.with_weights(all.weights.data()),
                         mesh));
    std::size_t hidden = 0, images = 0, even_images = 0;
    for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
      const auto begin = static_cast<std::ptrdiff_t>(offsets[s]),
                 end = static_cast<std::ptrdiff_t>(offsets[s + 1]);
      const WeightedPoints own{"",
                               {all.coordinates.begin() + 2 * begin, all.coordinates.begin() + 2 * end},
                               {all.weights.begin() + begin, all.weights.begin() + end}};
      const Triangulation alone = triangulated(own, period);
      ASSERT_EQ(alone.triangles.size(), 3 * (mesh.triangle_offsets[s + 1] - mesh.triangle_offsets[s]));
      for (std::size_t c = 0; c < alone.triangles.size(); ++c)
        ASSERT_EQ(alone.triangles[c] + begin, mesh.triangles[3 * mesh.triangle_offsets[s] + c]);
      for (const std::int32_t i : alone.hidden) ASSERT_EQ(i + begin, mesh.hidden[hidden++]);
      images += alone.images;
      if (s == 0) even_images = alone.images;
      // Its margin was too small at first.
      if (s == 3) {
        EXPECT_GT(alone.images, 4 * even_images);
      }
      const Copies copies(own, alone.places, period, 1);
      ASSERT_EQ(copies.hidden(), alone.hidden);
      ASSERT_TRUE(copies.triangles() == triangles_of(alone));
    }
    EXPECT_EQ(hidden, mesh.hidden.size());
    EXPECT_GT(hidden, 3000u);
    EXPECT_GE(mesh.images, images);
  }
}

TEST(WeightedPeriodic, VerificationFindsWhatIsWrong) {
  FixtureRandom random(4);
  std::size_t heavier = 0;
  for (int round = 0; round < 60; ++round) {
    const Period period = kPeriods[static_cast<std::size_t>(round) % kPeriods.size()];
    const WeightedPoints points =
        any_points(random, round % 6 == 0 ? 6 : 60, round % 2 == 0 ? 4 : 52, round % 4);
    const Triangulation good = triangulated(points, period);
    ASSERT_EQ("", verify(good.places.data(), good.point_offsets,
                         good.space.with_weights(points.weights.data()), good));
    Triangulation bad = good;
    if (!good.hidden.empty()) {
      const auto at = static_cast<std::size_t>(random.integer(0, std::ssize(good.hidden) - 1));
      bad.hidden.erase(bad.hidden.begin() + static_cast<std::ptrdiff_t>(at));
      EXPECT_NE("", verify(bad.places.data(), bad.point_offsets,
                           bad.space.with_weights(points.weights.data()), bad));
      // A hidden point that becomes heavy is not hidden any more.
      Numbers weights = points.weights;
      weights[static_cast<std::size_t>(good.hidden[at])] += 50;
      EXPECT_NE(
          "", verify(good.places.data(), good.point_offsets, good.space.with_weights(weights.data()), good));
      ++heavier;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::binary_search(good.hidden.begin(), good.hidden.end(), static_cast<std::int32_t>(i))) continue;
      bad = good;
      bad.hidden.insert(std::lower_bound(bad.hidden.begin(), bad.hidden.end(), static_cast<std::int32_t>(i)),
                        static_cast<std::int32_t>(i));
      ASSERT_NE("", verify(bad.places.data(), bad.point_offsets,
                           bad.space.with_weights(points.weights.data()), bad))
          << i;
    }
  }
  EXPECT_GT(heavier, 20u);
  // Points on a circle, of which the middle one is hidden, or not.
  const Coordinates line = {0, 0, 0.25, 0, 0.5, 0};
  for (const double weight : {-0.0625, -0.06}) {
    const Numbers weights = {0, weight, 0};
    Triangulation mesh =
        triangulator().triangulate(line.data(), 3, Space::torus({1, HUGE_VAL}).with_weights(weights.data()));
    EXPECT_TRUE(mesh.triangles.empty());
    EXPECT_EQ(mesh.hidden, weight == -0.0625 ? Ids{1} : Ids{});
    EXPECT_EQ("",
              verify(mesh.places.data(), mesh.point_offsets, mesh.space.with_weights(weights.data()), mesh));
    mesh.hidden = weight == -0.0625 ? Ids{} : Ids{1};
    EXPECT_NE("",
              verify(mesh.places.data(), mesh.point_offsets, mesh.space.with_weights(weights.data()), mesh));
    mesh.hidden = {0, 1, 2};
    EXPECT_NE("",
              verify(mesh.places.data(), mesh.point_offsets, mesh.space.with_weights(weights.data()), mesh));
  }
}

/// Returns the triangulation.
Triangulation expect_cells(const WeightedPoints& points, const Period& period) {
  SCOPED_TRACE(points.name);
  const std::size_t n = points.size();
  const Triangulation mesh = triangulated(points, period);
  const ClippedVoronoi cells = triangulator().clipped_voronoi(mesh, points.weights.data());
  EXPECT_NEAR(std::accumulate(cells.areas.begin(), cells.areas.end(), 0.0), period.x * period.y, 1e-12);
  // The least power of a point's images.
  const auto power = [&](std::size_t i, double x, double y) {
    const double dx = std::remainder(mesh.places[2 * i] - x, period.x),
                 dy = std::remainder(mesh.places[2 * i + 1] - y, period.y);
    return dx * dx + dy * dy - points.weights[i];
  };
  double tiled = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (std::binary_search(mesh.hidden.begin(), mesh.hidden.end(), static_cast<std::int32_t>(i))) {
      EXPECT_EQ(cells.offsets[i], cells.offsets[i + 1]);
      EXPECT_EQ(cells.areas[i], 0);
    }
    for (std::int32_t v = cells.offsets[i]; v < cells.offsets[i + 1]; ++v) {
      const double x = cells.vertices[2 * v], y = cells.vertices[2 * v + 1];
      for (std::size_t j = 0; j < n; ++j) EXPECT_LE(power(i, x, y), power(j, x, y) + 1e-11);
      const std::int32_t w = v + 1 < cells.offsets[i + 1] ? v + 1 : cells.offsets[i];
      tiled += (x * cells.vertices[2 * w + 1] - y * cells.vertices[2 * w]) / 2;
    }
  }
  EXPECT_NEAR(tiled, period.x * period.y, 1e-12);
  return mesh;
}

TEST(WeightedPeriodic, CellsAreWhereThePowerIsLeast) {
  FixtureRandom random(5);
  for (const std::size_t n : {1, 2, 7, 200}) {
    for (const int kind : {0, 3, 4}) expect_cells(any_points(random, n, 52, kind), {1, n == 7 ? 0.25 : 1.5});
  }
  const WeightedPoints points = any_points(random, 300, 52, 0);
  const Numbers equal(300, 0.5);
  const auto in = [&](const Space& space) {
    return triangulator().triangulate(points.coordinates.data(), 300, space);
  };
  const Space torus = Space::torus({1, 1});
  const ClippedVoronoi power =
                           triangulator().clipped_voronoi(in(torus.with_weights(equal.data())), equal.data()),
                       voronoi = triangulator().clipped_voronoi(in(torus));
  EXPECT_TRUE(same(power.vertices, voronoi.vertices));
  EXPECT_TRUE(same(power.areas, voronoi.areas));
}

TEST(WeightedPeriodic, CellsOfPointsThatAreNearlyHiddenAndOnLines) {
  // Beside each second point of a column are two others nearly on a line with it, and at nearly the power
  // with which they would hide it.
  FixtureRandom random(6);
  constexpr int kRows = 16;
  WeightedPoints points{"columns", {}, {}};
  for (int column = 0; column < kRows; ++column) {
    Numbers weights(kRows);
    for (int k = 0; k < kRows; k += 2) weights[k] = 1e-4 * random.unit();
    for (int k = 1; k < kRows; k += 2)
      weights[k] =
          (weights[k - 1] + weights[(k + 1) % kRows]) / 2 - 1.0 / kRows / kRows + 1e-13 * random.unit();
    points.weights.insert(points.weights.end(), weights.begin(), weights.end());
    for (int k = 0; k < kRows; ++k) {
      const double x = static_cast<double>(column) / kRows + 1e-12 * random.unit();
      points.coordinates.insert(points.coordinates.end(), {x, static_cast<double>(k) / kRows});
    }
  }
  const Triangulation mesh = expect_cells(points, {1, 1});
  const ClippedVoronoi cells = triangulator().clipped_voronoi(mesh, points.weights.data());
  std::size_t slivers = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const std::int32_t* const v = &mesh.triangles[t];
    if (v[0] / kRows != v[1] / kRows || v[1] / kRows != v[2] / kRows) continue;
    ++slivers;
    // Its centre as seen from the first corner, exactly.
    std::array<mpq_class, 2> x, y, lift;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::int32_t w = v[k + 1];
      const std::int8_t* const offset = &mesh.corner_offsets[2 * (t + k + 1)];
      x[k] = mpq_class(mesh.places[2 * w]) + offset[0] - mesh.places[2 * v[0]];
      y[k] = mpq_class(mesh.places[2 * w + 1]) + offset[1] - mesh.places[2 * v[0] + 1];
      lift[k] = x[k] * x[k] + y[k] * y[k] + mpq_class(points.weights[v[0]]) - points.weights[w];
    }
    const mpq_class twice = 2 * (x[0] * y[1] - y[0] * x[1]),
                    across = (lift[0] * y[1] - lift[1] * y[0]) / twice,
                    up = (x[0] * lift[1] - x[1] * lift[0]) / twice;
    double nearest = HUGE_VAL;
    for (std::int32_t i = cells.offsets[v[0]]; i < cells.offsets[v[0] + 1]; ++i) {
      const double dx = cells.vertices[2 * i] - mesh.places[2 * v[0]] - across.get_d(),
                   dy = cells.vertices[2 * i + 1] - mesh.places[2 * v[0] + 1] - up.get_d();
      nearest = std::min(nearest, std::hypot(dx, dy));
    }
    EXPECT_LT(nearest, 1e-14);
  }
  EXPECT_GT(slivers, 5u);
}

TEST(WeightedPeriodic, ErrorsSayWhatIsWrong) {
  const Coordinates points = {0.1, 0.2, 0.6, 0.3, 0.4, 0.9, 0.5, 0.5};
  Numbers weights = {0, 0, 0, 0};
  const auto run = [&](const Period& period) {
    triangulator().triangulate(points.data(), {0, 2, 4}, Space::torus(period).with_weights(weights.data()));
  };
  weights[3] = NAN;
  expect_error(ErrorKind::input, "point 3 has a weight that is not finite", [&] { run({1, 1}); });
  weights[3] = 1e300;
  expect_error(ErrorKind::input, "point 3 has a weight, 1e+300, that is too large", [&] {
    run({1, HUGE_VAL});
  });
  weights[3] = 0;
  expect_error(ErrorKind::usage, "the period", [&] { run({0, 1}); });
  Triangulation mesh =
      triangulator().triangulate(points.data(), 4, Space::torus({1, 1}).with_weights(weights.data()));
  // Queries that a locator among points with weights has not.
  weights[3] = 0.5;
  const auto expect_no_more = [](Locator locator) {
    const Numbers query = {0.5, 0.5}, values(4, 1.0);
    InterpolationOptions options;
    EXPECT_EQ(Numbers{1}, locator.interpolate(values.data(), query.data(), 1, options));
    expect_error(ErrorKind::usage, "a tree of points", [&] { locator.nearest(query.data(), 1); });
    expect_error(ErrorKind::usage, "a tree of points", [&] { locator.natural_weights(query.data(), 1); });
    for (const Interpolation method :
         {Interpolation::nearest, Interpolation::sibson, Interpolation::laplace}) {
      options.method = method;
      expect_error(ErrorKind::usage, "natural neighbours",
                   [&] { locator.interpolate(values.data(), query.data(), 1, options); });
    }
  };
  const Triangulation heavy =
      triangulator().triangulate(points.data(), 4, Space::torus({1, 1}).with_weights(weights.data()));
  ASSERT_EQ(3u, heavy.hidden.size());
  expect_no_more(Locator(triangulator(), heavy, weights.data()));
  expect_error(ErrorKind::usage, "need these", [&] { Locator(triangulator(), heavy); });
  expect_error(ErrorKind::usage, "points with weights need these",
               [&] { Locator(triangulator(), mesh, weights.data()); });
  Triangulation wrong = mesh;
  wrong.hidden = {0};
  expect_error(ErrorKind::usage, "points with weights need these",
               [&] { Locator(triangulator(), wrong, weights.data()); });
  weights[3] = NAN;
  expect_error(ErrorKind::input, "point 3 has a weight that is not finite",
               [&] { Locator(triangulator(), mesh, weights.data()); });
  weights[3] = 0;
  const Coordinates triangle = {0, 0, 2, 0, 0, 2, 0.5, 0.5};
  const Numbers light = {0, 0, 0, -9};
  expect_no_more(
      Locator(triangulator(), triangle.data(), 4,
              triangulator().triangulate(triangle.data(), 4, Space::plane().with_weights(light.data()))));
  mesh.hidden = {2, 1};
  expect_error(ErrorKind::usage, "not those of a triangulation on a torus", [&] {
    verify(mesh.places.data(), mesh.point_offsets, mesh.space.with_weights(weights.data()), mesh);
  });
}

}  // namespace
}  // namespace flaunay::testing::weighted_tori
