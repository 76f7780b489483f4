// Certificates of rounds (blocks/certify.h) and heights along seams (blocks/seams.h) in single precision:
// against rational numbers, and how many triangles have a certificate in double precision alone.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "app/files/generate.hpp"
#include "flaunay/research.hpp"
#include "tests/support/fixed_cases.hpp"
#include "tests/support/fixed_point.hpp"
#include "tests/support/rounding.hpp"

namespace flaunay::testing {
namespace {

TEST(SmallFixedCertify, IsNeverWrong) {
  std::mt19937_64 random(1);
  std::size_t free_circles = 0, free_half_planes = 0, said_circles[2] = {}, said_half_planes[2] = {};
  const Device devices[] = {{"to nearest", FE_TONEAREST, false},
                            {"to nearest, flushes", FE_TONEAREST, true},
                            {"toward zero, flushes", FE_TOWARDZERO, true}};
  for (int trial = 0; trial < 60000; ++trial) {
    Integer p[6];
    three_points(random, p);
    const FixedFrame frame = frame_around(random, p);
    const bool circle = circle_is_free(frame, p), half_plane = half_plane_is_free(frame, p);
    free_circles += circle;
    free_half_planes += half_plane;
    std::size_t k = 0;
    for (const FixedPredicates* const reading : all_fixed_predicates()) {
      for (const Device& device : devices) {
        const Rounding rounding(device.direction, device.flushes);
        const bool says_circle = reading->is_circle_inside(frame, p);
        const bool says_half_plane = reading->is_half_plane_inside(frame, p);
        ASSERT_TRUE(circle || !says_circle) << reading->name << ", " << device.name << ", trial " << trial;
        ASSERT_TRUE(half_plane || !says_half_plane)
            << reading->name << ", " << device.name << ", trial " << trial;
        if (device.direction == FE_TONEAREST && !device.flushes) {
          said_circles[k] += says_circle;
          said_half_planes[k] += says_half_plane;
        }
      }
      ++k;
    }
  }
  for (std::size_t k = 0; k < all_fixed_predicates().size(); ++k) {
    std::printf("  circles %zu of %zu, half-planes %zu of %zu\n", said_circles[k], free_circles,
                said_half_planes[k], free_half_planes);
    // Many a side is next to a circle, nearer than a float can tell, and many a triangle is nearly a line.
    EXPECT_GT(10 * said_circles[k], 5 * free_circles);
    EXPECT_GT(10 * said_half_planes[k], 7 * free_half_planes);
  }
  EXPECT_GT(free_circles, 5000U);
  EXPECT_GT(free_half_planes, 1000U);
}

// Of coordinates at the ends of the range, circles are so large that numbers are infinite: then the answer is
// no.
TEST(SmallFixedCertify, OfTheLargestTriangles) {
  std::mt19937_64 random(2);
  int free = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Integer p[6];
    for (Integer& x : p) {
      const Integer ends[] = {kLargest, -kLargest, 0, number(random, 62)};
      x = limited(ends[random() % 4] + between(random, -2, 2));
    }
    FixedFrame frame{
        {-kLargest, -kLargest}, {kLargest, kLargest}, {-kLargest, -kLargest}, {kLargest, kLargest}};
    if (trial % 2 == 0) frame.low[0] = -kInfinite;
    if (trial % 3 == 0) frame.high[1] = kInfinite;
    const bool is_free = circle_is_free(frame, p), is_free_half_plane = half_plane_is_free(frame, p);
    free += is_free;
    for (const FixedPredicates* const reading : all_fixed_predicates()) {
      ASSERT_TRUE(is_free || !reading->is_circle_inside(frame, p));
      ASSERT_TRUE(is_free_half_plane || !reading->is_half_plane_inside(frame, p));
    }
  }
  EXPECT_LT(free, 20000);
}

TEST(SmallFixedCertify, SidesAlongTheHullAreDecided) {
  // A border on an axis: no point is beyond the line, and some are on it.
  const FixedFrame frame{{-kInfinite, -kInfinite}, {1000, kInfinite}, {0, 0}, {5000, 5000}};
  const Integer along[] = {20, 0, 10, 0}, against[] = {10, 0, 20, 0};
  for (const FixedPredicates* const reading : all_fixed_predicates()) {
    EXPECT_FALSE(reading->is_half_plane_inside(frame, along));
    EXPECT_TRUE(reading->is_half_plane_inside(frame, against));
  }
}

// -----------------------------------------------------------------------------------------------------------
// How many triangles of blocks have a certificate

/// Points of a distribution in fixed point, with at most 53 bits.
std::vector<Integer> points_of(const std::string& distribution, std::size_t n) {
  const auto points = io::generate(distribution, n, 5).coordinates;
  double most = 0;
  for (const double x : points) most = std::max(most, std::fabs(x));
  std::vector<Integer> integers;
  for (const double x : points) {
    integers.push_back(static_cast<Integer>(std::nearbyint(std::ldexp(x, 52 - std::ilogb(most)))) * (1 << 9));
  }
  return integers;
}

struct Certificates {
  std::size_t triangles = 0, in_doubles = 0, in_floats = 0, free = 0;
};

/// Halves a part along its longer extent until it is a block, and asks for the certificates of its triangles.
void certify_blocks(const std::vector<Integer>& points, std::vector<std::size_t> part, FixedFrame frame,
                    std::size_t block, Certificates& found) {
  if (part.size() > block) {
    Integer extent[2];
    for (int axis = 0; axis < 2; ++axis) {
      const auto less = [&](std::size_t i, std::size_t j) {
        return points[2 * i + axis] < points[2 * j + axis];
      };
      const auto [least, most] = std::minmax_element(part.begin(), part.end(), less);
      extent[axis] = points[2 * *most + axis] - points[2 * *least + axis];
    }
    const int axis = extent[1] > extent[0];
    const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
    std::nth_element(part.begin(), middle, part.end(), [&](std::size_t i, std::size_t j) {
      return points[2 * i + axis] < points[2 * j + axis];
    });
    FixedFrame low = frame, high = frame;
    low.high[axis] = high.low[axis] = points[2 * *middle + axis];
    certify_blocks(points, {part.begin(), middle}, low, block, found);
    certify_blocks(points, {middle, part.end()}, high, block, found);
    return;
  }
  std::vector<double> coordinates;
  for (const std::size_t i : part) {
    coordinates.push_back(static_cast<double>(points[2 * i]));
    coordinates.push_back(static_cast<double>(points[2 * i + 1]));
  }
  research::Options options;
  options.mode = research::Mode::dwyer;
  const auto mesh = research::triangulate_on_host(coordinates.data(), {0, part.size()}, options);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    Integer p[6];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = part[static_cast<std::size_t>(mesh.triangles[t + k])];
      p[2 * k] = points[2 * i];
      p[2 * k + 1] = points[2 * i + 1];
    }
    ++found.triangles;
    const bool in_doubles = is_circle_inside_in_doubles(frame, p);
    const bool in_floats = fixed_predicates().is_circle_inside(frame, p);
    found.in_doubles += in_doubles;
    found.in_floats += in_floats;
    ASSERT_TRUE(in_doubles || !in_floats || circle_is_free(frame, p));
  }
}

TEST(FixedCertify, FewTrianglesWaitForSinglePrecision) {
  for (const char* const distribution : {"uniform", "kuzmin", "line", "normal"}) {
    const std::size_t n = 60000;
    const auto points = points_of(distribution, n);
    for (const std::size_t block : {64, 1024}) {
      Certificates found;
      FixedFrame frame{
          {-kInfinite, -kInfinite}, {kInfinite, kInfinite}, {kInfinite, kInfinite}, {-kInfinite, -kInfinite}};
      for (std::size_t k = 0; k < 2 * n; ++k) {
        frame.all_low[k % 2] = std::min(frame.all_low[k % 2], points[k]);
        frame.all_high[k % 2] = std::max(frame.all_high[k % 2], points[k]);
      }
      std::vector<std::size_t> all(n);
      std::iota(all.begin(), all.end(), 0);
      certify_blocks(points, all, frame, block, found);
      const auto lost = static_cast<double>(found.in_doubles) - static_cast<double>(found.in_floats);
      std::printf(
          "  %-8s blocks of %4zu: %zu triangles, certified %.4f%% in doubles, %.4f%% in floats: %.1f of 10^5 "
          "lost\n",
          distribution, block, found.triangles,
          100.0 * static_cast<double>(found.in_doubles) / found.triangles,
          100.0 * static_cast<double>(found.in_floats) / found.triangles, 1e5 * lost / found.in_doubles);
      EXPECT_LT(lost, 3e-3 * static_cast<double>(found.in_doubles)) << distribution;
    }
  }
}

// -----------------------------------------------------------------------------------------------------------
// Heights

TEST(SmallFixedSeams, HeightsAreWithinTheirError) {
  std::mt19937_64 random(3);
  double largest = 0;
  for (int trial = 0; trial < 100000; ++trial) {
    const int axis = trial % 2;
    const int bits = between(random, 0, 60), along = between(random, 0, 60);
    // A point on the cut; one of the low side and one of the high side.
    Integer p[6];
    for (int k = 0; k < 3; ++k) {
      const Integer from_cut = std::abs(number(random, bits)) >> (random() % 4 == 0 ? 40 : 0);
      p[2 * k + axis] = k == 0 ? 0 : k == 1 ? -from_cut : from_cut;
      p[2 * k + 1 - axis] = number(random, along);
    }
    const Integer by = number(random, 60);
    for (Integer& x : p) x += by;
    const Rational before = rational(p[axis]) - rational(p[2 + axis]),
                   run = rational(p[4 + axis]) - rational(p[2 + axis]);
    // Upwards is along y, or against x.
    const int up = 1 - axis, sign = axis == 0 ? 1 : -1;
    const Rational low = sign * (rational(p[2 + up]) - rational(p[up])),
                   high = sign * (rational(p[4 + up]) - rational(p[up]));
    const Rational share = run > 0 ? Rational(before / run) : Rational(1, 2);
    const Rational height = low + share * (high - low);
    for (const FixedPredicates* const reading : all_fixed_predicates()) {
      for (const Device& device :
           {Device{"to nearest", FE_TONEAREST, false}, Device{"toward zero", FE_TOWARDZERO, true}}) {
        FixedHeight found{};
        {
          const Rounding rounding(device.direction, device.flushes);
          found = reading->height_at_cut(p, axis);
        }
        const double wrong = std::fabs(Rational(Rational(found.at_cut) - height).get_d());
        const double allowed = found.error * found.largest;
        ASSERT_LE(wrong, allowed) << reading->name << ", " << device.name;
        if (allowed > 0) largest = std::max(largest, wrong / allowed);
      }
    }
  }
  std::printf("  heights wrong by at most %.3f of their bound\n", largest);
  EXPECT_GT(largest, 0.02);
}

}  // namespace
}  // namespace flaunay::testing
