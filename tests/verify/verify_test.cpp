// The checker must accept every right triangulation and reject every wrong one: all other tests rely on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <random>
#include <string>

#include "prove/delaunay_proof.hpp"
#include "prove/exact.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/sanitized.hpp"

namespace flaunay {
namespace {

using testing::flat_triangles;
using testing::grid_points;
using testing::random_integer_points;
using testing::reference_delaunay;
using testing::reference_incircle;
using testing::reference_neighbors;
using testing::reference_orient2d;
using testing::sorted_triangles;
using testing::TriangleSet;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSmallestSubnormal = std::numeric_limits<double>::denorm_min();

// -----------------------------------------------------------------------------------------------------------
// Exact predicates

/// The sanitizers are an order of magnitude slower, and need no large samples.
const int kSampleShare = testing::is_sanitized() ? 20 : 1;

/// Four points to try a predicate on.
using FourPoints = std::array<double, 8>;

class ExactPredicatesTest : public ::testing::Test {
 protected:
  /// Compares both predicates with GMP's answer, and checks that permutations have the right sign.
  void check(const FourPoints& points) {
    const double *a = &points[0], *b = &points[2], *c = &points[4], *d = &points[6];
    const int turn = predicates_.orient2d(a, b, c);
    const int side = predicates_.incircle(a, b, c, d);
    if (turn == 0) ++collinear_;
    if (side == 0) ++cocircular_;
    ++checked_;
    const bool right = turn == reference_orient2d(a, b, c) && side == reference_incircle(a, b, c, d) &&
                       turn == predicates_.orient2d(b, c, a) && turn == -predicates_.orient2d(b, a, c) &&
                       side == predicates_.incircle(c, a, b, d) && side == -predicates_.incircle(a, b, d, c);
    if (right) return;
    std::string text;
    for (const double value : points) {
      char buffer[40];
      std::snprintf(buffer, sizeof buffer, "%a ", value);
      text += buffer;
    }
    ADD_FAILURE() << "orient2d " << turn << ", incircle " << side << " are wrong for " << text;
  }

  double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

  /// Any finite double: random bits, so all magnitudes from subnormal to largest.
  double any_finite() {
    for (;;) {
      const std::uint64_t bits = random_();
      double value;
      std::memcpy(&value, &bits, sizeof value);
      if (std::isfinite(value)) return value;
    }
  }

  /// Moves one coordinate by a few units in the last place.
  void nudge(FourPoints& points) {
    double& value = points[integer(0, 7)];
    for (int steps = integer(0, 3); steps > 0; --steps) value = std::nextafter(value, uniform() * 1e308);
  }

  std::mt19937_64 random_{20240611};
  ExactPredicates predicates_;
  std::size_t checked_ = 0, collinear_ = 0, cocircular_ = 0;
};

TEST_F(ExactPredicatesTest, HaveTheDocumentedSigns) {
  const double origin[] = {0, 0}, east[] = {1, 0}, north[] = {0, 1}, inside[] = {0.6, 0.6},
               outside[] = {1.1, 1};
  const double corner[] = {1, 1}, far_east[] = {2, 0};
  EXPECT_EQ(predicates_.orient2d(origin, east, north), 1);
  EXPECT_EQ(predicates_.orient2d(origin, north, east), -1);
  EXPECT_EQ(predicates_.incircle(origin, east, north, inside), 1);
  EXPECT_EQ(predicates_.incircle(origin, east, north, outside), -1);
  EXPECT_EQ(predicates_.exact_evaluations(), 0u);
  EXPECT_EQ(predicates_.orient2d(origin, east, far_east), 0);
  EXPECT_EQ(predicates_.incircle(origin, east, north, corner), 0);
  EXPECT_EQ(predicates_.exact_evaluations(), 2u);
  EXPECT_EQ(reference_orient2d(origin, east, north), 1);
  EXPECT_EQ(reference_incircle(origin, east, north, inside), 1);
}

TEST_F(ExactPredicatesTest, AreRightForRandomPoints) {
  for (int i = 0; i < 150000 / kSampleShare; ++i) {
    FourPoints points;
    for (double& value : points) value = uniform();
    check(points);
  }
  EXPECT_LT(predicates_.exact_evaluations(), 10u) << "the filter should decide nearly all of these";
}

TEST_F(ExactPredicatesTest, AreRightForSmallIntegers) {
  for (int i = 0; i < 200000 / kSampleShare; ++i) {
    FourPoints points;
    for (double& value : points) value = integer(-4, 4);
    check(points);
  }
  EXPECT_GT(collinear_, 10000u / kSampleShare);
  EXPECT_GT(cocircular_, 10000u / kSampleShare);
}

TEST_F(ExactPredicatesTest, AreRightForNearlyCollinearPoints) {
  for (int i = 0; i < 200000 / kSampleShare; ++i) {
    const double x = uniform(), y = uniform(), dx = uniform(), dy = uniform();
    FourPoints points;
    for (int p = 0; p < 4; ++p) {
      const double t = uniform();
      points[2 * p] = x + t * dx;
      points[2 * p + 1] = y + t * dy;
    }
    check(points);
  }
  EXPECT_GT(predicates_.exact_evaluations(), 10000u / kSampleShare);
}

TEST_F(ExactPredicatesTest, AreRightForNearlyCocircularPoints) {
  for (int i = 0; i < 200000 / kSampleShare; ++i) {
    const double x = uniform(), y = uniform(), radius = std::ldexp(uniform(), integer(-30, 4));
    FourPoints points;
    for (int p = 0; p < 4; ++p) {
      const double angle = 4 * uniform();
      points[2 * p] = x + radius * std::cos(angle);
      points[2 * p + 1] = y + radius * std::sin(angle);
    }
    check(points);
  }
  EXPECT_GT(predicates_.exact_evaluations(), 10000u / kSampleShare);
}

// Rectangles and symmetric trapezoids at all magnitudes, exact or off by a few units in the last place.
TEST_F(ExactPredicatesTest, AreRightForExactlyDegeneratePointsAndTheirSurroundings) {
  for (int i = 0; i < 200000 / kSampleShare; ++i) {
    const double scale = std::ldexp(1, integer(-1074, 1000));
    const double x = integer(-1000, 1000) * scale, y = integer(-1000, 1000) * scale;
    const double half = integer(1, 1000) * scale, other_half = integer(1, 1000) * scale;
    const double height = half == other_half ? integer(1, 1000) * scale : 0;
    FourPoints points = {x - half, y, x + half, y, x + other_half, y + height, x - other_half, y + height};
    if (integer(0, 1) == 0) points = {x - half, y, x + half, y, x + half, y + half, x - half, y + half};
    nudge(points);
    check(points);
  }
  EXPECT_GT(cocircular_, 10000u / kSampleShare);
  EXPECT_GT(collinear_, 10000u / kSampleShare);
}

TEST_F(ExactPredicatesTest, AreRightForExtremeMagnitudes) {
  const double values[] = {0,
                           -0.0,
                           kSmallestSubnormal,
                           1e-310,
                           -1e-310,
                           3e-308,
                           1e-200,
                           -1e-162,
                           1e-154,
                           -1e-100,
                           1e-75,
                           -1e-50,
                           1,
                           -1,
                           1 + 0x1p-52,
                           1e50,
                           -1e75,
                           1e77,
                           -1e100,
                           1e150,
                           1e154,
                           -1e155,
                           1e300,
                           -1e300,
                           std::numeric_limits<double>::max(),
                           std::numeric_limits<double>::lowest()};
  const int count = sizeof values / sizeof *values;
  for (int i = 0; i < 40000 / kSampleShare; ++i) {
    FourPoints points;
    for (double& value : points) value = i % 2 == 0 ? values[integer(0, count - 1)] : any_finite();
    if (i % 4 == 0) nudge(points);
    check(points);
  }
}

// The filter's own danger zone: products around the smallest numbers, where rounding is absolute.
TEST_F(ExactPredicatesTest, AreRightWhereProductsUnderflowOrOverflow) {
  for (const int exponent : {-1074, -1050, -540, -530, -510, -460, -450, -270, -255, -140, -125, 240, 249,
                             250, 256, 340, 511, 1000}) {
    for (int i = 0; i < 3000 / kSampleShare; ++i) {
      FourPoints points;
      for (double& value : points) {
        // One or two axes on another scale, so that one product underflows and another does not.
        const int shift = integer(0, 3) == 0 ? integer(-300, 20) : 0;
        value = std::ldexp(integer(-8, 8) + (i % 2) * uniform(), std::max(exponent + shift, -1074));
      }
      check(points);
    }
  }
}

// The true products are within rounding of each other and of 1.5 * 2^-1074, so that one may round to 2^-1074
// and the other to twice that, whichever is larger: the filter's bounds do not hold there.
TEST_F(ExactPredicatesTest, AreRightWhereProductsRoundToSubnormalNumbers) {
  const double scale = 0x1p-537;
  for (int i = 0; i < 20000 / kSampleShare; ++i) {
    const double u = 1.25 + uniform() / 4, v = 1.25 + uniform() / 4;
    const double px = u * scale, py = v * scale, qx = 1.5 / v * scale, qy = 1.5 / u * scale;
    // Below rounding of the others' coordinates, so that differences from it are inexact.
    const double ox = uniform() * scale * 0x1p-53, oy = uniform() * scale * 0x1p-53;
    check({px, py, qx, qy, ox, oy, 1, 0});
    check({0x1p400, uniform(), px, py, qx, qy, ox,
           oy});  // a far point, whose lift magnifies the error in the minor
  }
}

// -----------------------------------------------------------------------------------------------------------
// Accepting

using Coordinates = std::vector<double>;

Coordinates random_points(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  Coordinates coordinates(2 * n);
  for (double& value : coordinates) value = uniform(random);
  return coordinates;
}

/// The 12 points of integer coordinates on the circle of radius 5, and its centre if asked for.
Coordinates circle_points(bool centre) {
  Coordinates coordinates = {5,  0, 4,  3,  3,  4,  0, 5,  -3, 4,  -4, 3,
                             -5, 0, -4, -3, -3, -4, 0, -5, 3,  -4, 4,  -3};
  if (centre) coordinates.insert(coordinates.end(), {0, 0});
  return coordinates;
}

VerifyReport verify_points(const Coordinates& coordinates, const std::vector<std::int32_t>& triangles) {
  return verify(coordinates.data(), coordinates.size() / 2, triangles);
}

/// Verifies the reference triangulation of the points, with neighbours.
VerifyReport verify_reference(const Coordinates& coordinates) {
  const auto triangles = flat_triangles(reference_delaunay(coordinates));
  return verify(coordinates.data(), coordinates.size() / 2, triangles, reference_neighbors(triangles));
}

TEST(VerifyAccepts, RandomPoints) {
  for (std::size_t n = 3; n <= 300; n += 11) {
    const VerifyReport report = verify_reference(random_points(n, n));
    EXPECT_TRUE(report.ok) << report.problem;
    EXPECT_EQ(report.problem, "");
    EXPECT_EQ(report.points, n);
    EXPECT_EQ(report.distinct_points, n);
    EXPECT_EQ(report.triangles, 2 * n - 2 - report.hull_vertices);
    EXPECT_EQ(report.cocircular_edges, 0u);
  }
}

TEST(VerifyAccepts, SmallIntegerPointsWithManyTies) {
  for (int i = 0; i < 600; ++i) {
    const VerifyReport report = verify_reference(random_integer_points(3 + i % 60, 1 + i % 13, i));
    EXPECT_TRUE(report.ok) << "set " << i << ": " << report.problem;
  }
}

TEST(VerifyAccepts, GridAndCountsItsTies) {
  const VerifyReport report = verify_reference(grid_points(9, 7));
  EXPECT_TRUE(report.ok) << report.problem;
  EXPECT_EQ(report.distinct_points, 63u);
  EXPECT_EQ(report.triangles, 2u * 8 * 6);
  EXPECT_EQ(report.hull_vertices, 2u * (8 + 6));
  EXPECT_EQ(report.cocircular_edges, 8u * 6);
  EXPECT_GE(report.exact_evaluations, 8u * 6);
}

TEST(VerifyAccepts, Circles) {
  VerifyReport report = verify_reference(circle_points(false));
  EXPECT_TRUE(report.ok) << report.problem;
  EXPECT_EQ(report.triangles, 10u);
  EXPECT_EQ(report.cocircular_edges, 9u);
  report = verify_reference(circle_points(true));
  EXPECT_TRUE(report.ok) << report.problem;
  EXPECT_EQ(report.triangles, 12u);
  EXPECT_EQ(report.cocircular_edges, 0u);
}

TEST(VerifyAccepts, DuplicatesWhicheverRepresentsThem) {
  const Coordinates coordinates = {0, 0, 1, 0, 0, 1, 1, 0, 0, 0, -0.0, 0, 2, 3, 2, 3};
  const VerifyReport report = verify_reference(coordinates);
  EXPECT_TRUE(report.ok) << report.problem;
  EXPECT_EQ(report.points, 8u);
  EXPECT_EQ(report.distinct_points, 4u);
  for (const int a : {0, 4, 5}) {
    for (const int b : {1, 3}) {
      for (const int d : {6, 7}) {
        const VerifyReport other = verify_points(coordinates, {a, b, 2, b, d, 2});
        EXPECT_TRUE(other.ok) << other.problem;
      }
    }
  }
}

TEST(VerifyAccepts, ExtremeMagnitudes) {
  const Coordinates coordinates = {0,      0,     1e300,   0,        0, 1e300, 1e-310, 1e-310,
                                   -1e308, 1e308, 1.7e308, -1.7e308, 1, 1,     1e-5,   -1e-310};
  const VerifyReport report = verify_reference(coordinates);
  EXPECT_TRUE(report.ok) << report.problem;
  EXPECT_GT(report.exact_evaluations, 0u);
  Coordinates tiny = grid_points(4, 4);
  for (double& value : tiny) value *= kSmallestSubnormal;
  EXPECT_TRUE(verify_reference(tiny).ok) << verify_reference(tiny).problem;
}

TEST(VerifyAccepts, NoTrianglesForCollinearPoints) {
  EXPECT_TRUE(verify(nullptr, 0, {}).ok);
  const std::vector<Coordinates> sets = {{1, 2},
                                         {1, 2, 3, 4},
                                         {1, 2, 1, 2},
                                         {1, 2, 1, 2, 1, 2, 1, 2},
                                         {0, 0, 1, 1, 3, 3, 2, 2},
                                         {0, 1, 0, 5, 0, -3},
                                         {0, 0, 1e300, 1e300, 1e-310, 1e-310, -5, -5},
                                         {0, 0, 0.1, 0.3, 0, 0}};
  for (const Coordinates& coordinates : sets) {
    EXPECT_TRUE(reference_delaunay(coordinates).empty());
    const VerifyReport report = verify_reference(coordinates);
    EXPECT_TRUE(report.ok) << report.problem;
    EXPECT_EQ(report.hull_vertices, report.distinct_points);
  }
}

TEST(Reference, TakesFansFromTheSmallestCornerOfEachCell) {
  EXPECT_EQ(reference_delaunay({1, 1, 0, 1, 1, 0, 0, 0}), (TriangleSet{{0, 1, 3}, {0, 3, 2}}));
  EXPECT_EQ(reference_delaunay({0, 0, 1, 0, 0, 1}), (TriangleSet{{0, 1, 2}}));
  EXPECT_EQ(sorted_triangles({3, 0, 1, 2, 0, 3}), (TriangleSet{{0, 1, 3}, {0, 3, 2}}));
  // Twelve points of a circle: all triangles have (-5, 0), which is point 6.
  for (const auto& triangle : reference_delaunay(circle_points(false))) {
    EXPECT_TRUE(std::count(triangle.begin(), triangle.end(), 6) == 1);
  }
}

// -----------------------------------------------------------------------------------------------------------
// Rejecting

void expect_rejected(const VerifyReport& report, const std::string& part_of_problem) {
  EXPECT_FALSE(report.ok);
  EXPECT_NE(report.problem.find(part_of_problem), std::string::npos)
      << "the problem is: " << report.problem << "\nbut should contain: " << part_of_problem;
}

/// A square's corners, its centre moved to the right, and their triangulation, to be damaged.
class VerifyRejects : public ::testing::Test {
 protected:
  const Coordinates coordinates_ = {0, 0, 4, 0, 4, 4, 0, 4, 2.5, 2};
  const std::vector<std::int32_t> triangles_ = {0, 1, 4, 1, 2, 4, 2, 3, 4, 0, 4, 3};
  const std::vector<std::int32_t> neighbors_ = {1, 3, -1, 2, 0, -1, 3, 1, -1, 2, -1, 0};

  VerifyReport verify_triangles(const std::vector<std::int32_t>& triangles) {
    return verify_points(coordinates_, triangles);
  }
  VerifyReport verify_neighbors(const std::vector<std::int32_t>& neighbors) {
    return verify(coordinates_.data(), coordinates_.size() / 2, triangles_, neighbors);
  }
};

TEST_F(VerifyRejects, NothingInTheUndamagedExample) {
  EXPECT_EQ(verify_neighbors(neighbors_).problem, "");
  EXPECT_EQ(neighbors_, reference_neighbors(triangles_));
}

TEST_F(VerifyRejects, SizeThatIsNoMultipleOf3) {
  expect_rejected(verify_triangles({0, 1, 4, 1}), "4 indices, which is not a multiple of 3");
}

TEST_F(VerifyRejects, IndexOutOfRange) {
  expect_rejected(verify_triangles({0, 1, 4, 1, 5, 4, 2, 3, 4, 0, 4, 3}), "triangle 1 has a corner 5");
  expect_rejected(verify_triangles({0, 1, 4, 1, 2, 4, 2, 3, -1, 0, 4, 3}), "triangle 2 has a corner -1");
  expect_rejected(verify(nullptr, 0, {0, 1, 2}), "triangle 0 has a corner 0");
}

TEST_F(VerifyRejects, CoordinatesThatAreNotFinite) {
  for (const double bad : {kInfinity, -kInfinity, std::numeric_limits<double>::quiet_NaN()}) {
    Coordinates coordinates = coordinates_;
    coordinates[7] = bad;
    expect_rejected(verify_points(coordinates, triangles_), "point 3 at (0, ");
    expect_rejected(verify_points({0, 0, bad, 0}, {}), "is not finite");
  }
}

TEST_F(VerifyRejects, ClockwiseTriangle) {
  expect_rejected(verify_triangles({0, 1, 4, 1, 2, 4, 3, 2, 4, 0, 4, 3}),
                  "triangle 2 with points 3, 2, 4 at (0, 4), (4, 4), (2.5, 2) is clockwise");
}

TEST_F(VerifyRejects, DegenerateTriangle) {
  expect_rejected(verify_triangles({0, 1, 4, 1, 1, 4, 3, 2, 4}), "triangle 1 with points 1, 1, 4");
  expect_rejected(verify_points({0, 0, 1, 1, 2, 2}, {0, 1, 2}), "triangle 0 with points 0, 1, 2");
  expect_rejected(verify_points({0, 0, 0, 0, 2, 2}, {0, 1, 2}), "is degenerate");
}

TEST_F(VerifyRejects, NoTrianglesWherePointsAreNotCollinear) {
  expect_rejected(verify_triangles({}), "there are no triangles, but the points are not all collinear");
  expect_rejected(verify_points({0, 0, 1, 1, 3, 3, 2, std::nextafter(2, 3)}, {}), "point 3 at (2, 2.00000");
}

TEST_F(VerifyRejects, FlippedEdge) {
  const Coordinates kite = {0, 0, 4, -1, 8, 0, 4, 1};
  EXPECT_EQ(verify_points(kite, {0, 1, 3, 1, 2, 3}).problem, "");
  expect_rejected(
      verify_points(kite, {0, 1, 2, 0, 2, 3}),
      "triangle 0 with points 0, 1, 2 at (0, 0), (4, -1), (8, 0) is not Delaunay: its circle contains "
      "point 3 at (4, 1), a corner of triangle 1");
}

TEST_F(VerifyRejects, MissingTriangle) {
  // Each triangle of the example has a side on the hull.
  expect_rejected(verify_triangles({0, 1, 4, 1, 2, 4, 2, 3, 4}), "the boundary is not convex at point 4");
  // A hole that does not touch the hull: one of the cells in the middle of a grid, without a triangle or
  // both.
  const Coordinates grid = grid_points(4, 4);
  for (const std::size_t removed : {1, 2}) {
    std::vector<std::int32_t> triangles;
    std::size_t skipped = 0;
    for (const auto& triangle : reference_delaunay(grid)) {
      const bool middle = std::all_of(triangle.begin(), triangle.end(),
                                      [](int i) { return i == 5 || i == 6 || i == 9 || i == 10; });
      if (middle && skipped < removed) {
        ++skipped;
      } else {
        triangles.insert(triangles.end(), triangle.begin(), triangle.end());
      }
    }
    ASSERT_EQ(skipped, removed);
    expect_rejected(verify_points(grid, triangles),
                    "has no triangle beyond it, but is not on the outer boundary");
  }
}

TEST_F(VerifyRejects, MissingHullTriangle) {
  // The removed triangle has no corner of its own, so that all points are still used.
  expect_rejected(verify_triangles({0, 1, 4, 2, 3, 4, 0, 4, 3}), "not convex at point 4 at (2.5, 2)");
}

TEST_F(VerifyRejects, BoundaryThatTouchesItself) {
  expect_rejected(verify_triangles({0, 1, 4, 2, 3, 4}), "the boundary touches itself at point 4 at (2.5, 2)");
}

TEST_F(VerifyRejects, SeparatePieces) {
  expect_rejected(verify_points({0, 0, 1, 0, 0, 1, 5, 5, 6, 5, 5, 6}, {0, 1, 2, 3, 4, 5}),
                  "a separate piece");
}

TEST_F(VerifyRejects, DuplicateTriangle) {
  expect_rejected(verify_triangles({0, 1, 4, 1, 2, 4, 2, 3, 4, 0, 4, 3, 4, 1, 2}),
                  "triangle 4 with points 4, 1, 2 at (2.5, 2), (4, 0), (4, 4) has the edge from point ");
}

TEST_F(VerifyRejects, SecondLayer) {
  // Both ways of halving a square, one over the other.
  const Coordinates square = grid_points(2, 2);
  expect_rejected(verify_points(square, {0, 1, 3, 0, 3, 2, 0, 1, 2, 1, 3, 2}), "has the edge from point ");
}

TEST_F(VerifyRejects, BoundaryThatGoesAroundTwice) {
  // An annulus that overlaps itself would turn left everywhere; only monotonicity tells it from a convex
  // polygon.
  Coordinates coordinates;
  const double angles[] = {0.1, 1.5, 2.9, 4.3, 5.7, 7.1, 8.5, 9.9, 11.3};
  for (const double angle : angles) coordinates.insert(coordinates.end(), {std::cos(angle), std::sin(angle)});
  coordinates.insert(coordinates.end(), {0.01, 0.02});
  std::vector<std::int32_t> triangles;
  for (std::int32_t i = 0; i < 9; ++i) triangles.insert(triangles.end(), {i, (i + 1) % 9, 9});
  for (std::int32_t i = 0; i < 9; ++i) {
    ASSERT_EQ(reference_orient2d(&coordinates[2 * i], &coordinates[2 * ((i + 1) % 9)],
                                 &coordinates[2 * ((i + 2) % 9)]),
              1);
    ASSERT_EQ(reference_orient2d(&coordinates[2 * i], &coordinates[2 * ((i + 1) % 9)], &coordinates[18]), 1);
  }
  expect_rejected(verify_points(coordinates, triangles), "the boundary goes around more than once");
}

TEST_F(VerifyRejects, UnusedPoint) {
  // The point inside is missing from a triangulation that is right without it.
  expect_rejected(verify_triangles({0, 1, 2, 0, 2, 3}), "point 4 at (2.5, 2) is in no triangle");
  // A missing corner of the hull.
  expect_rejected(verify_triangles({0, 1, 4, 1, 2, 4}), "point 3 at (0, 4) is in no triangle");
  // A point on the hull's edge.
  expect_rejected(verify_points({0, 0, 2, 0, 1, 1, 1, 0}, {0, 1, 2}), "point 3 at (1, 0) is in no triangle");
  // Of a group of duplicates, the smallest index is named.
  expect_rejected(verify_points({5, 5, 0, 0, 1, 0, 0, 1, 5, 5}, {1, 2, 3}),
                  "point 0 at (5, 5) is in no triangle");
}

TEST_F(VerifyRejects, TwoRepresentatives) {
  const Coordinates coordinates = {0, 0, 1, 0, 0, 1, 1, 0, 2, 3};
  EXPECT_EQ(verify_points(coordinates, {0, 3, 2, 3, 4, 2}).problem, "");
  expect_rejected(
      verify_points(coordinates, {0, 1, 2, 3, 4, 2}),
      "triangle 1 with points 3, 4, 2 at (1, 0), (2, 3), (0, 1) uses point 3, but triangle 0 uses its "
      "duplicate, point 1");
}

TEST_F(VerifyRejects, WrongNeighbors) {
  std::vector<std::int32_t> neighbors = neighbors_;
  neighbors[4] = 3;
  expect_rejected(
      verify_neighbors(neighbors),
      "triangle 1 with points 1, 2, 4 at (4, 0), (4, 4), (2.5, 2) has neighbor 3 opposite to point 2, but "
      "it should be 0");
  neighbors = neighbors_;
  neighbors[2] = 0;
  expect_rejected(verify_neighbors(neighbors), "it should be -1");
  neighbors = neighbors_;
  neighbors[6] = -1;
  expect_rejected(verify_neighbors(neighbors), "has neighbor -1 opposite to point 2");
  neighbors = neighbors_;
  std::swap(neighbors[0], neighbors[1]);
  expect_rejected(verify_neighbors(neighbors), "triangle 0 ");
  neighbors.pop_back();
  expect_rejected(verify_neighbors(neighbors), "there are 11 neighbors");
  expect_rejected(verify(nullptr, 0, {}, {-1, -1, -1}), "there are 3 neighbors");
}

TEST_F(VerifyRejects, TheSmallestIndexFirst) {
  const Coordinates coordinates = random_points(60, 5);
  const auto triangles = flat_triangles(reference_delaunay(coordinates));
  auto damaged = triangles;
  for (const std::size_t t : {40, 20, 7}) {
    std::swap(damaged[3 * t], damaged[3 * t + 1]);
    expect_rejected(verify_points(coordinates, damaged), "triangle " + std::to_string(t) + " ");
  }
}

// -----------------------------------------------------------------------------------------------------------
// Property: a mutation is accepted only if it is another right triangulation

/// A brute-force judge for integer points, which shares nothing with verify: triangles with empty circles, as
/// many as a triangulation has, and no two overlapping, can only be a Delaunay triangulation.
class BruteForce {
 public:
  explicit BruteForce(const Coordinates& coordinates)
      : n_(static_cast<std::int32_t>(coordinates.size() / 2)), right_(reference_delaunay(coordinates)) {
    for (const double value : coordinates) values_.push_back(static_cast<std::int64_t>(value));
  }

  bool accepts(const std::vector<std::int32_t>& corners) const {
    if (corners.size() != 3 * right_.size()) return false;
    std::map<std::pair<std::int64_t, std::int64_t>, std::int32_t> used;
    for (const std::int32_t i : corners) {
      if (i < 0 || i >= n_) return false;
      if (used.emplace(std::make_pair(values_[2 * i], values_[2 * i + 1]), i).first->second != i)
        return false;
    }
    for (std::size_t t = 0; t < corners.size(); t += 3) {
      if (turn(corners[t], corners[t + 1], corners[t + 2]) <= 0) return false;
      for (std::int32_t i = 0; i < n_; ++i) {
        if (inside(corners[t], corners[t + 1], corners[t + 2], i)) return false;
      }
    }
    for (std::size_t s = 0; s < corners.size(); s += 3) {
      for (std::size_t t = 0; t < s; t += 3) {
        if (!separated(&corners[s], &corners[t]) && !separated(&corners[t], &corners[s])) return false;
      }
    }
    return true;
  }

 private:
  std::int64_t turn(std::int32_t a, std::int32_t b, std::int32_t c) const {
    return (x(a) - x(c)) * (y(b) - y(c)) - (y(a) - y(c)) * (x(b) - x(c));
  }
  bool inside(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) const {
    return lift(a, d) * turn(b, c, d) + lift(b, d) * turn(c, a, d) + lift(c, d) * turn(a, b, d) > 0;
  }
  /// Whether a side of triangle s has all of triangle t on its right, or on it.
  bool separated(const std::int32_t* s, const std::int32_t* t) const {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = s[k], b = s[(k + 1) % 3];
      if (turn(a, b, t[0]) <= 0 && turn(a, b, t[1]) <= 0 && turn(a, b, t[2]) <= 0) return true;
    }
    return false;
  }
  std::int64_t lift(std::int32_t a, std::int32_t d) const {
    return (x(a) - x(d)) * (x(a) - x(d)) + (y(a) - y(d)) * (y(a) - y(d));
  }
  std::int64_t x(std::int32_t i) const { return values_[2 * i]; }
  std::int64_t y(std::int32_t i) const { return values_[2 * i + 1]; }

  std::int32_t n_;
  TriangleSet right_;
  std::vector<std::int64_t> values_;
};

class Mutator {
 public:
  explicit Mutator(std::uint64_t seed) : random_(seed) {}

  void mutate(std::vector<std::int32_t>& corners, std::int32_t n) {
    const std::size_t count = corners.size() / 3;
    const std::size_t t = 3 * below(count), s = 3 * below(count);
    switch (below(8)) {
      case 0:
        corners[t + below(3)] = static_cast<std::int32_t>(below(n));
        break;
      case 1:
        std::swap(corners[t], corners[t + 1 + below(2)]);
        break;
      case 2:
        std::rotate(&corners[t], &corners[t + 1], &corners[t] + 3);  // stays right
        break;
      case 3:
        std::swap_ranges(&corners[t], &corners[t] + 3, &corners[s]);  // stays right
        break;
      case 4:
        if (count > 1) corners.erase(corners.begin() + t, corners.begin() + t + 3);
        break;
      case 5:
        for (int k = 0; k < 3; ++k) corners.push_back(corners[s + k]);
        break;
      case 6:
        std::copy_n(&corners[s], 3, &corners[t]);
        break;
      default:
        flip(corners, t);
    }
  }

 private:
  std::size_t below(std::size_t bound) {
    return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random_);
  }

  /// Flips an edge of triangle t (given by its first corner's place), if it has a triangle beyond.
  void flip(std::vector<std::int32_t>& corners, std::size_t t) {
    std::rotate(&corners[t], &corners[t + below(3)], &corners[t] + 3);
    for (std::size_t s = 0; s < corners.size(); s += 3) {
      for (int k = 0; k < 3; ++k) {
        if (corners[s + k] != corners[t + 1] || corners[s + (k + 1) % 3] != corners[t]) continue;
        const std::int32_t a = corners[t], b = corners[t + 1], c = corners[t + 2],
                           d = corners[s + (k + 2) % 3];
        const std::int32_t first[] = {a, d, c}, second[] = {d, b, c};
        std::copy_n(first, 3, &corners[t]);
        std::copy_n(second, 3, &corners[s]);
        return;
      }
    }
  }

  std::mt19937_64 random_;
};

TEST(VerifyProperty, MutationsAreAcceptedOnlyIfTheyAreRight) {
  Mutator mutator(7);
  std::size_t accepted = 0, rejected = 0, other_choices = 0;
  for (int set = 0; set < 400; ++set) {
    const Coordinates coordinates = random_integer_points(4 + set % 17, 2 + set % 7, 1000 + set);
    const TriangleSet right = reference_delaunay(coordinates);
    if (right.empty()) continue;
    const BruteForce judge(coordinates);
    ASSERT_TRUE(judge.accepts(flat_triangles(right)));
    for (int i = 0; i < 100; ++i) {
      auto corners = flat_triangles(right);
      for (int mutations = 1 + i % 3; mutations > 0; --mutations) {
        mutator.mutate(corners, static_cast<std::int32_t>(coordinates.size() / 2));
      }
      const VerifyReport report = verify_points(coordinates, corners);
      ASSERT_EQ(report.ok, judge.accepts(corners)) << "set " << set << ": " << report.problem;
      ASSERT_EQ(report.ok, report.problem.empty());
      ++(report.ok ? accepted : rejected);
      if (report.ok && sorted_triangles(corners) != right) ++other_choices;
    }
  }
  EXPECT_GT(accepted, 1000u);
  EXPECT_GT(other_choices, 100u);
  EXPECT_GT(rejected, 10000u);
}

TEST(VerifyProperty, EveryFlipOfRandomPointsIsRejected) {
  const Coordinates coordinates = random_points(200, 99);
  const auto triangles = flat_triangles(reference_delaunay(coordinates));
  const auto neighbors = reference_neighbors(triangles);
  std::size_t flips = 0;
  for (std::size_t h = 0; h < triangles.size(); ++h) {
    if (neighbors[h] < 0) continue;
    const std::size_t t = h / 3, s = neighbors[h];
    const std::int32_t a = triangles[h], b = triangles[3 * t + (h + 1) % 3],
                       c = triangles[3 * t + (h + 2) % 3];
    std::int32_t d = -1;
    for (int k = 0; k < 3; ++k) {
      if (triangles[3 * s + k] != b && triangles[3 * s + k] != c) d = triangles[3 * s + k];
    }
    auto flipped = triangles;
    const std::int32_t first[] = {a, b, d}, second[] = {a, d, c};
    std::copy_n(first, 3, &flipped[3 * t]);
    std::copy_n(second, 3, &flipped[3 * s]);
    EXPECT_FALSE(verify_points(coordinates, flipped).ok);
    ++flips;
  }
  EXPECT_GT(flips, 1000u);
}

}  // namespace
}  // namespace flaunay
