// The exact predicates of kernels/predicates/planar.h as the host reads them, against GMP. On the device:
// predicates_test.cpp.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "geometry/predicates.hpp"
#include "tests/support/bounds.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/whole.hpp"

namespace flaunay::testing {
namespace {

using geometry::Point;

Point point_of(const Coordinates& points, std::size_t i) { return {points[2 * i], points[2 * i + 1]}; }

int reference_orient(const Coordinates& points, std::size_t a, std::size_t b, std::size_t c) {
  return reference_orient2d(&points[2 * a], &points[2 * b], &points[2 * c]);
}

/// Both exact in-circle tests, the second one only where it is meant to be used.
void expect_circle(const Coordinates& p, int expected) {
  const Point a = point_of(p, 0), b = point_of(p, 1), c = point_of(p, 2), d = point_of(p, 3);
  ASSERT_EQ(kernel::circle_exact(a, b, c, d), expected) << text_of(p);
  if (kernel::circle_filtered(a, b, c, d, CIRCLE_BOUND) != UNDECIDED &&
      kernel::angle_compared(kernel::angle_at(d, a, b), kernel::angle_at(c, a, b), ANGLE_BOUND) !=
          UNDECIDED) {
    return;
  }
  ASSERT_EQ(kernel::circle_undecided(a, b, c, d, CIRCLE_BOUND), expected) << text_of(p);
}

// Kernels get bounds as floats, which must not be smaller than what docs/exactness.md derives.
TEST(Bounds, AreFloatsThatAreLargeEnough) {
  constexpr double e = 0x1p-53, u = 0x1p-23 + 0x1p-43;
  static_assert(DOUBLE_ROUNDOFF == e && double{SINGLE_ROUNDOFF} == u);
  const auto expect = [](double bound, double derived) {
    EXPECT_EQ(double{static_cast<float>(bound)}, bound);
    EXPECT_GE(bound, derived);
    EXPECT_LT(bound, 1.00002 * derived);
  };
  expect(ORIENT_BOUND, (3 + 16 * e) * e);
  expect(CIRCLE_BOUND, (10 + 96 * e) * e);
  expect(ORIENT_BOUND_FOR(SINGLE_ROUNDOFF), 3.0000095 * u);
  expect(CIRCLE_BOUND_FOR(SINGLE_ROUNDOFF), 10.00002 * u);
  expect(HULL_DEPTH_BOUND, 10 * e);
  expect(ANGLE_BOUND, 11 * e);
  expect(NEARNESS_BOUND, 6 * e);
  expect(CENTRE_SIDE_BOUND, 12 * e);
}

TEST(ExactPredicates, TiesAndNearlyTies) {
  FixtureRandom random(10);
  int ties = 0;
  for (int round = 0; round < 20000; ++round) {
    // Corners of a rectangle, or three points on a line and one beside; of any number of bits, some of them
    // moved by next to nothing.
    const auto bits = static_cast<int>(random.integer(1, 70));
    const auto number = [&] { return std::floor((random.unit() - 0.5) * std::ldexp(1, bits)); };
    const double x = number(), y = number(), dx = number(), dy = number();
    Coordinates p = {x, y, x + dx, y + dy, x + dx - dy, y + dy + dx, x - dy, y + dx};
    if (random.integer(0, 1)) p = {x, y, x + dx, y + dy, x + 2 * dx, y + 2 * dy, x - dy, y + dx};
    for (double& c : p) {
      if (random.integer(0, 19) == 0)
        c += std::ldexp(random.unit(), static_cast<int>(random.integer(-90, 3)));
    }
    const int exponent = static_cast<int>(random.integer(-80, 80));
    for (double& c : p) c = std::ldexp(c, exponent);
    const auto point = [&p](std::size_t k) { return point_of(p, k); };
    const int orient = reference_orient(p, 0, 1, 2);
    ASSERT_EQ(kernel::orient_exact(point(0), point(1), point(2)), orient) << text_of(p);
    if (orient == 0) ++ties;
    if (orient < 0) continue;
    const int circle = reference_incircle(&p[0], &p[2], &p[4], &p[6]);
    ASSERT_NO_FATAL_FAILURE(expect_circle(p, circle));
    if (circle == 0) ++ties;
  }
  EXPECT_GT(ties, 5000);
}

// Points of a circle that are rounded, the origin among them, whose differences no integers hold; and
// rectangles.
TEST(ExactPredicates, WithTwiceThePrecision) {
  FixtureRandom random(15);
  int decided = 0, left = 0;
  for (int round = 0; round < 20000; ++round) {
    const int exponent = static_cast<int>(random.integer(-200, 200));
    const double scale = std::ldexp(1 + random.unit(), exponent);
    Coordinates p;
    for (int k = 0; k < 4; ++k) {
      const double angle = 2 * M_PI * random.unit() * std::ldexp(1, -static_cast<int>(random.integer(0, 20)));
      p.push_back(scale * std::sin(angle));
      p.push_back(scale * (1 - std::cos(angle)));
    }
    if (round % 4 == 0) p = {p[0], p[1], p[2], p[1], p[2], p[3], p[0], p[3]};
    const Point a = point_of(p, 0), b = point_of(p, 1), c = point_of(p, 2), d = point_of(p, 3);
    const kernel::circle_differences from = kernel::differences_from(d, a, b, c);
    const int expected = reference_incircle(&p[0], &p[2], &p[4], &p[6]);
    const int sign = kernel::circle_closely(&from, a, b, c);
    if (sign != 0) {
      ASSERT_EQ(sign, expected) << text_of(p);
      ++decided;
    } else {
      ++left;
    }
    ASSERT_NO_FATAL_FAILURE(expect_circle(p, expected));
  }
  EXPECT_GT(decided, 10000);
  EXPECT_GT(left, 4000);
}

// All coordinates as large as they can be, or next to it, or 0: sums and products at the limits of integers.
TEST(ExactPredicates, OfTheLargestIntegers) {
  FixtureRandom random(14);
  int ties = 0;
  for (int round = 0; round < 40000; ++round) {
    const auto bits = static_cast<int>(random.integer(24, 64));
    Coordinates p;
    for (int k = 0; k < 8; ++k) {
      const double largest =
          std::ldexp(1, bits) - std::ldexp(static_cast<double>(random.integer(0, 2)), std::max(0, bits - 53));
      p.push_back(static_cast<double>(random.integer(-1, 1)) * largest);
    }
    const auto point = [&p](std::size_t k) { return point_of(p, k); };
    ASSERT_EQ(kernel::orient_exact(point(0), point(1), point(2)), reference_orient(p, 0, 1, 2)) << text_of(p);
    const int circle = reference_incircle(&p[0], &p[2], &p[4], &p[6]);
    ASSERT_NO_FATAL_FAILURE(expect_circle(p, circle));
    if (circle == 0) ++ties;
    // Below a chord, as the in-circle test of its ends, their mirror images in the line, and the point.
    const double q = 0;
    if (p[1] > p[3]) std::swap(p[1], p[3]);
    if (p[5] < p[1] || p[5] > p[3] || p[0] == 0 || p[1] == p[3]) continue;
    const double left[] = {-std::fabs(p[0]), p[1]}, right[] = {std::fabs(p[0]), p[1]};
    ASSERT_EQ(kernel::hull_depth_sign(point(0), point(1), point(2), q, 0),
              reference_incircle(left, right, &p[2], &p[4]))
        << text_of(p);
  }
  EXPECT_GT(ties, 5000);
}

// ---------------------------------------------------------------------------------------------------------
// Integers of 128 and 256 bits

mpz_class value_of(kernel::integer128 x) {
  return (whole(kernel::as_long(x.high)) << 64) + whole_unsigned(x.low);
}

mpz_class value_of(kernel::integer256 x) {
  return (value_of(x.high) << 128) + (whole_unsigned(x.low.high) << 64) + whole_unsigned(x.low.low);
}

/// Modulo 2^bits, between -2^(bits - 1) and 2^(bits - 1).
mpz_class wrapped(const mpz_class& x, unsigned bits) {
  const mpz_class modulus = mpz_class(1) << bits;
  mpz_class rest;
  mpz_fdiv_r(rest.get_mpz_t(), x.get_mpz_t(), modulus.get_mpz_t());
  return rest >= modulus / 2 ? mpz_class(rest - modulus) : rest;
}

TEST(WideIntegers, AreThoseOfGmp) {
  FixtureRandom random(15);
  const auto limb = [&random]() -> std::uint64_t {
    const auto any = static_cast<std::uint64_t>(random.integer(0, INT64_MAX - 1)) * 2 + 1;
    constexpr std::uint64_t one = 1, ones = ~std::uint64_t{0};
    const std::uint64_t limbs[] = {0, 1, ones, ones >> 1, one << 63, one << 32, (one << 32) - 1, any};
    return limbs[random.integer(0, 7)];
  };
  for (int round = 0; round < 100000; ++round) {
    namespace kernel = kernel;
    const kernel::integer128 a{limb(), limb()}, b{limb(), limb()}, c{limb(), limb()};
    ASSERT_EQ(value_of(kernel::sum_128(a, b)), wrapped(value_of(a) + value_of(b), 128));
    ASSERT_EQ(value_of(kernel::difference_128(a, b)), wrapped(value_of(a) - value_of(b), 128));
    ASSERT_EQ(kernel::sign_of_128(a), sgn(value_of(a)));
    const std::int64_t x = kernel::as_long(a.low), y = kernel::as_long(b.low);
    ASSERT_EQ(value_of(kernel::widened(x)), whole(x));
    ASSERT_EQ(value_of(kernel::product_128(x, y)), whole(x) * whole(y));
    const kernel::integer256 product = kernel::product_256(a, b), other = kernel::product_256(b, c);
    ASSERT_EQ(value_of(product), value_of(a) * value_of(b));
    ASSERT_EQ(kernel::sign_of_256(product), sgn(value_of(product)));
    ASSERT_EQ(value_of(kernel::low_product(a, b)), wrapped(value_of(product), 128));
    ASSERT_EQ(value_of(kernel::sum_256(product, other)), wrapped(value_of(product) + value_of(other), 256));
  }
}

TEST(WideIntegers, DifferencesAreOnesOrNot) {
  namespace kernel = kernel;
  FixtureRandom random(16);
  int integers = 0;
  for (int round = 0; round < 100000; ++round) {
    const auto exponent = static_cast<int>(random.integer(-190, 180));
    const auto number = [&] {
      const auto bits = static_cast<int>(random.integer(1, 53));
      const auto size = static_cast<double>(random.integer(-(1LL << bits) + 1, (1LL << bits) - 1));
      return std::ldexp(size, exponent + static_cast<int>(random.integer(0, 64 - bits)));
    };
    const double a = number(), b = number();
    const kernel::double2 difference = kernel::two_sum(a, -b);
    if (difference.x == 0) continue;
    for (const int bits : {NARROW_BITS, MIDDLE_BITS, WIDE_BITS}) {
      const double factor = kernel::unit_factor(std::fabs(difference.x), bits);
      const double scaled = std::fabs(difference.x * factor);
      ASSERT_TRUE(std::ldexp(1, bits - 1) <= scaled && scaled < std::ldexp(1, bits));
      mpq_class exact(a);
      exact = (exact - mpq_class(b)) * mpq_class(factor);
      std::int64_t integer = 0;
      const bool is_one = exact.get_den() == 1;
      ASSERT_EQ(kernel::is_integer(difference, factor, &integer) != 0, is_one) << text_of({a, b});
      std::int64_t same = integer;
      if (bits <= 53) {
        ASSERT_EQ(kernel::is_short_integer(difference, factor, &same) != 0, is_one) << text_of({a, b});
      }
      if (!is_one) continue;
      ++integers;
      ASSERT_EQ(exact.get_num(), whole(integer)) << text_of({a, b});
      ASSERT_EQ(integer, same) << text_of({a, b});
    }
  }
  EXPECT_GT(integers, 50000);
}

// ---------------------------------------------------------------------------------------------------------
// circle_canonical

using Integers = std::array<std::int64_t, 2>;

/// Of four different integer points, a, b, c counter-clockwise, by the definition: the in-circle determinant,
/// and if that is 0 the same with the first point's height less by 1. It is linear in that, and zero without:
/// any amount has the sign of an infinitesimal one.
int canonical_by_definition(const std::array<Integers, 4>& p) {
  for (const std::int64_t lowered : {0, 1}) {
    const Integers first = std::min({p[0], p[1], p[2], p[3]});
    std::array<std::array<std::int64_t, 3>, 4> lifted{};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto [x, y] = p[k];
      lifted[k] = {x, y, x * x + y * y - (p[k] == first ? lowered : 0)};
    }
    std::int64_t r[3][3];
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) r[k][i] = lifted[k][i] - lifted[3][i];
    }
    const std::int64_t determinant = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) -
                                     r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0]) +
                                     r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    if (determinant != 0) return determinant > 0 ? 1 : -1;
  }
  return 0;
}

/// All quadruples, in all orders whose first three turn left.
void expect_definition(const std::vector<Integers>& points, double bound, std::size_t least_ties) {
  std::size_t ties = 0;
  const std::size_t n = points.size();
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      for (std::size_t c = 0; c < n; ++c) {
        const auto turn = (points[b][0] - points[a][0]) * (points[c][1] - points[a][1]) -
                          (points[b][1] - points[a][1]) * (points[c][0] - points[a][0]);
        if (turn <= 0) continue;
        for (std::size_t d = 0; d < n; ++d) {
          if (d == a || d == b || d == c) continue;
          const std::array<Integers, 4> p = {points[a], points[b], points[c], points[d]};
          std::array<Point, 4> q{};
          for (std::size_t k = 0; k < 4; ++k)
            q[k] = {static_cast<double>(p[k][0]), static_cast<double>(p[k][1])};
          ties += kernel::circle_sign(q[0], q[1], q[2], q[3], bound) == 0;
          ASSERT_EQ(kernel::circle_canonical(q[0], q[1], q[2], q[3], bound), canonical_by_definition(p))
              << text_of({q[0].x, q[0].y, q[1].x, q[1].y, q[2].x, q[2].y, q[3].x, q[3].y});
        }
      }
    }
  }
  EXPECT_GE(ties, least_ties);
}

/// All integer points of a circle about the origin.
std::vector<Integers> integer_circle(std::int64_t square) {
  std::vector<Integers> points;
  for (std::int64_t x = -square; x * x <= square || x < 0; ++x) {
    if (x * x > square) continue;
    const auto y = static_cast<std::int64_t>(std::lround(std::sqrt(static_cast<double>(square - x * x))));
    if (x * x + y * y != square) continue;
    points.push_back({x, -y});
    if (y != 0) points.push_back({x, y});
  }
  return points;
}

TEST(CircleCanonical, IsItsDefinitionOnGrids) {
  std::vector<Integers> grid;
  for (std::int64_t x = 0; x < 5; ++x) {
    for (std::int64_t y = 0; y < 4; ++y) grid.push_back({x, y});
  }
  expect_definition(grid, usual_bounds().circle, 1000);
  expect_definition(grid, 0, 1000);
}

TEST(CircleCanonical, IsItsDefinitionOnCircles) {
  const auto circle = integer_circle(5 * 13 * 17);
  ASSERT_EQ(circle.size(), 32U);
  expect_definition(circle, usual_bounds().circle, 400000);
}

/// Triangles whose circle is empty, by circle_canonical.
TriangleSet canonical_triangles(const Coordinates& points) {
  TriangleSet triangles;
  const std::size_t n = points.size() / 2;
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      for (std::size_t c = a + 1; c < n; ++c) {
        if (c == b || reference_orient(points, a, b, c) <= 0) continue;
        bool empty = true;
        for (std::size_t d = 0; empty && d < n; ++d) {
          empty = d == a || d == b || d == c ||
                  kernel::circle_canonical(point_of(points, a), point_of(points, b), point_of(points, c),
                                           point_of(points, d), usual_bounds().circle) < 0;
        }
        if (empty) {
          triangles.push_back(
              {static_cast<std::int32_t>(a), static_cast<std::int32_t>(b), static_cast<std::int32_t>(c)});
        }
      }
    }
  }
  return triangles;
}

/// Some of the points, moved and scaled, in any order.
Coordinates some_of(std::vector<Integers> points, std::size_t count, FixtureRandom& random) {
  random.shuffle(points);
  points.resize(count);
  const auto bits = static_cast<int>(random.integer(0, 40));
  const std::int64_t x = random.integer(0, std::int64_t{1} << bits), y = random.integer(-100, 100);
  const auto exponent = static_cast<int>(random.integer(-100, 100));
  Coordinates result;
  for (const Integers& p : points) {
    result.push_back(std::ldexp(static_cast<double>(x + p[0]), exponent));
    result.push_back(std::ldexp(static_cast<double>(y + p[1]), exponent));
  }
  return result;
}

TEST(CircleCanonical, MakesOfCocircularPointsTheFanOfTheirFirst) {
  FixtureRandom random(11);
  const auto circle = integer_circle(5 * 5 * 13 * 17);
  for (int round = 0; round < 300; ++round) {
    const auto points = some_of(circle, static_cast<std::size_t>(random.integer(4, 10)), random);
    const TriangleSet triangles = canonical_triangles(points);
    ASSERT_EQ(triangles.size(), points.size() / 2 - 2) << text_of(points);
    ASSERT_EQ(triangles, reference_delaunay(points)) << text_of(points);
  }
}

TEST(CircleCanonical, MakesTheCanonicalTriangulation) {
  FixtureRandom random(12);
  std::vector<Integers> grid;
  for (std::int64_t x = 0; x < 5; ++x) {
    for (std::int64_t y = 0; y < 5; ++y) grid.push_back({x, y});
  }
  for (int round = 0; round < 300; ++round) {
    const auto points = some_of(grid, static_cast<std::size_t>(random.integer(4, 12)), random);
    ASSERT_EQ(canonical_triangles(points), reference_delaunay(points)) << text_of(points);
  }
}

// Ties that no filter decides: rectangles of 53 bits.
TEST(CircleCanonical, OfAnyRectangle) {
  FixtureRandom random(13);
  for (int round = 0; round < 2000; ++round) {
    const double x[] = {random.unit(), random.unit()};
    const double y[] = {random.unit() * std::ldexp(1, static_cast<int>(random.integer(-90, 90))),
                        random.unit()};
    const Coordinates points = {x[0], y[0], x[1], y[0], x[1], y[1], x[0], y[1]};
    ASSERT_EQ(canonical_triangles(points), reference_delaunay(points)) << text_of(points);
  }
}

}  // namespace
}  // namespace flaunay::testing
