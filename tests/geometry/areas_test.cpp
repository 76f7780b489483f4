// The kernel's text for areas, as doubles and as integers, against exact numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "predicates/rounded_area.h"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/same.hpp"

namespace flaunay::testing {
namespace {

using Coordinates = std::vector<double>;
constexpr double kMost = std::numeric_limits<double>::max(),
                 kLeast = std::numeric_limits<double>::denorm_min();

double by_kernel(const Coordinates& corners) {
  const auto* const bits = reinterpret_cast<const kernel::double_bits*>(corners.data());
  return kernel::as_double(kernel::rounded_area(bits, 0, 1, 2));
}

// What devices without double precision compute.
double by_integers(const Coordinates& corners) {
  kernel::uint64 x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    x[k] = kernel::as_ulong(corners[2 * k]);
    y[k] = kernel::as_ulong(corners[2 * k + 1]);
  }
  return kernel::as_double(kernel::area_by_integers(x, y));
}

void expect_rounded(const Coordinates& corners) {
  const double expected = reference_areas(corners, {0, 1, 2})[0];
  EXPECT_EQ(by_kernel(corners), expected);
  EXPECT_EQ(by_integers(corners), expected);
}

Coordinates triangle_of(const std::function<double()>& make) {
  Coordinates corners;
  for (int k = 0; k < 6; ++k) corners.push_back(make());
  return corners;
}

TEST(SmallAreas, OfAllMagnitudes) {
  FixtureRandom random(1);
  const auto of_bits = [&] {
    const auto bits = static_cast<kernel::uint64>(random.unit() * 0x1p53) << 11 |
                      static_cast<kernel::uint64>(random.unit() * 0x1p11);
    const double number = kernel::as_double(bits);
    return std::isfinite(number) ? number : 1.0;
  };
  for (int i = 0; i < 3000; ++i) expect_rounded(triangle_of(of_bits));
}

TEST(SmallAreas, OfNearMagnitudes) {
  FixtureRandom random(2);
  for (int i = 0; i < 3000; ++i) {
    const int exponent = static_cast<int>(random.unit() * 2096) - 1074;
    expect_rounded(triangle_of([&] { return std::ldexp(random.unit() - 0.5, exponent); }));
    // With few bits, so that areas lie half-way between two doubles, or are 0.
    expect_rounded(triangle_of([&] { return std::ldexp(std::floor(random.unit() * 64), exponent - 60); }));
    expect_rounded(triangle_of([&] { return std::floor(random.unit() * 0x1p30); }));
  }
}

// By a unit in the last place beside a line.
TEST(SmallAreas, OfSlivers) {
  FixtureRandom random(3);
  for (int i = 0; i < 3000; ++i) {
    const double x = random.unit(), y = random.unit(), dx = random.unit(), dy = random.unit();
    expect_rounded({x, y, x + dx, y + dy, x + dx / 3, std::nextafter(y + dy / 3, i % 2 == 0 ? 2.0 : -2.0)});
    expect_rounded({x, y, x + dx, y + dy, x + dx * 0x1p-40, y + dy * 0x1p-40});
  }
}

TEST(SmallAreas, AtTheEndsOfTheRange) {
  for (const double a : {kMost, kMost / 2, 0x1p512, 0x1p511, 0x1.fffffffffffffp511, 1.0, 0x1p-500, kLeast}) {
    for (const double b : {kMost, 0x1p512, 0x1p-1022, 0x1p-537, 0x1p-538, 0x1.8p-537, kLeast, 3 * kLeast}) {
      for (const double c : {0.0, a, -a, b}) {
        expect_rounded({c, 0, c == a ? -a : a, 0, c, b});
        expect_rounded({0, c, b, c, 0, c == a ? -a : a});
      }
    }
  }
  EXPECT_EQ(by_kernel({-kMost, -kMost, kMost, -kMost, 0, kMost}), std::numeric_limits<double>::infinity());
  EXPECT_EQ(by_kernel({0, 0, 0x1p-537, 0, 0, 0x1p-537}), 0.0);
  EXPECT_EQ(by_kernel({0, 0, 0x1.8p-537, 0, 0, 0x1p-537}), kLeast);
  EXPECT_EQ(by_kernel({0, 0, 1, 1, 2, 2}), 0.0);
}

}  // namespace
}  // namespace flaunay::testing
