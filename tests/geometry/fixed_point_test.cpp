// The predicates in fixed point (arithmetic/numbers.h), which filter in single precision, as C++ against GMP:
// at every scale and with every rounding that docs/exactness.md allows for. On devices:
// fixed_kernels_test.cpp.
#include "tests/support/fixed_point.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/support/fixed_cases.hpp"
#include "tests/support/rounding.hpp"

namespace flaunay::testing {
namespace {

constexpr int kUndecided = 2;

// -----------------------------------------------------------------------------------------------------------
// Roundings

/// What OpenCL devices do. Those of the embedded profile may round toward zero.
constexpr Device kDevices[] = {{"to nearest", FE_TONEAREST, false},
                               {"to nearest, flushes", FE_TONEAREST, true},
                               {"toward zero, flushes", FE_TOWARDZERO, true}};
/// And what bounds allow for but no device does.
constexpr Device kMoreDevices[] = {{"up", FE_UPWARD, true}, {"down", FE_DOWNWARD, true}};

/// Calls function(reading, device) for all readings of the headers and kinds of devices.
template <typename Function>
void for_each_device(const Function& function) {
  for (const FixedPredicates* const reading : all_fixed_predicates()) {
    for (const Device& device : kDevices) function(*reading, device);
  }
  for (const Device& device : kMoreDevices) {
    function(fixed_predicates(), device);
    function(fixed_predicates_contracted(), device);
  }
}

// -----------------------------------------------------------------------------------------------------------
// Signs

constexpr int kCases = 20000;

/// What a filter says, on all kinds of devices; the share that is undecided, to nearest.
void expect_signs(const Class& of, int points, const char* predicate, mpz_class (*exact)(const Integer*),
                  int (*FixedPredicates::*filter)(const Integer*),
                  const std::function<void(const FixedPredicates&, const Integer*, int, int)>& expect_more) {
  std::mt19937_64 random(points);
  std::vector<Integer> cases(static_cast<std::size_t>(2 * points * kCases));
  std::vector<int> expected(kCases);
  int zeros = 0, undecided = 0;
  for (int i = 0; i < kCases; ++i) {
    Integer* const p = &cases[static_cast<std::size_t>(2 * points * i)];
    of.make(random, p);
    expected[i] = sgn(exact(p));
    zeros += expected[i] == 0;
  }
  for_each_device([&](const FixedPredicates& reading, const Device& device) {
    for (int i = 0; i < kCases; ++i) {
      const Integer* const p = &cases[static_cast<std::size_t>(2 * points * i)];
      int sign = 0;
      {
        const Rounding rounding(device.direction, device.flushes);
        sign = (reading.*filter)(p);
      }
      ASSERT_TRUE(sign == expected[i] || sign == kUndecided)
          << predicate << " " << sign << ", " << of.name << ", " << reading.name << ", rounded "
          << device.name << ": " << text_of(p, 2 * points);
      if (&device == kDevices) {
        undecided += sign == kUndecided && &reading == &fixed_predicates();
        expect_more(reading, p, sign, expected[i]);
      }
    }
  });
  std::printf("  %-12s %-18s undecided %8.3f%%, zero %8.3f%%\n", predicate, of.name,
              100.0 * undecided / kCases, 100.0 * zeros / kCases);
  EXPECT_GE(zeros, of.zeros_least * kCases) << of.name;
}

TEST(SmallFixedPoint, Orientations) {
  const auto expect_exact = [](const FixedPredicates& reading, const Integer* p, int, int expected) {
    ASSERT_EQ(reading.orient_exact(p), expected) << text_of(p, 6);
  };
  for (const Class& of : orientation_classes()) {
    expect_signs(of, 3, "orientation", orientation, &FixedPredicates::orient_filtered, expect_exact);
    expect_signs(of, 3, "angle's side", orientation, &FixedPredicates::angle_side, expect_exact);
  }
}

TEST(SmallFixedPoint, CrossProducts) {
  const auto exact = [](const Integer* p) { return cross(p, p + 2, p + 4, p + 6); };
  for (const Class& of : circle_classes()) {
    expect_signs(
        {of.name, of.make, 0}, 4, "cross", exact, &FixedPredicates::cross_sign,
        [](const FixedPredicates&, const Integer*, int sign, int expected) { ASSERT_EQ(sign, expected); });
  }
}

/// Both exact tests; that of undecided cases of those that a filter leaves to it.
void expect_exact_circle(const FixedPredicates& reading, const Integer* p, int sign, int expected) {
  ASSERT_EQ(reading.circle_exact(p), expected) << text_of(p, 8);
  if (sign == kUndecided) {
    ASSERT_EQ(reading.circle_undecided(p), expected) << text_of(p, 8);
  }
}

TEST(SmallFixedPoint, Circles) {
  for (const Class& of : circle_classes()) {
    expect_signs(of, 4, "circle", in_circle, &FixedPredicates::circle_filtered, expect_exact_circle);
    expect_signs(of, 4, "angle", in_circle, &FixedPredicates::angle_compared, expect_exact_circle);
  }
}

// Differences of 25 to 40 bits, some beyond what circle_middle takes, on circles and next to them.
TEST(SmallFixedPoint, CirclesAtTheLimitsOfShortAndMiddleIntegers) {
  std::mt19937_64 random(7);
  int undecided = 0, zeros = 0;
  for (int i = 0; i < 60000; ++i) {
    Integer p[8];
    const long double radius = std::ldexp(1 + angle(random) / 6.2831854L, between(random, 24, 40));
    const Integer x = number(random, 61), y = number(random, 61);
    // Four of the eight points that are as far from the centre in either coordinate, or others next to the
    // circle.
    const bool is_regular = random() % 4 != 0;
    const long double first = angle(random);
    for (int k = 0; k < 4; ++k) {
      const long double at = is_regular ? first : angle(random);
      const Integer across = std::llrint(radius * std::cos(at)), up = std::llrint(radius * std::sin(at));
      const bool is_swapped = is_regular && (random() & 1) != 0;
      p[2 * k] = x + (k % 2 == 0 ? 1 : -1) * (is_swapped ? up : across);
      p[2 * k + 1] = y + (k < 2 ? 1 : -1) * (is_swapped ? across : up);
    }
    if ((random() & 1) != 0) nudge_one(random, p, 4);
    swap_points(random, p, 4);
    const int expected = sgn(in_circle(p));
    zeros += expected == 0;
    for (const FixedPredicates* const reading : all_fixed_predicates()) {
      ASSERT_EQ(reading->circle_exact(p), expected) << text_of(p, 8);
      if (reading->circle_filtered(p) == kUndecided || reading->angle_compared(p) == kUndecided) {
        ++undecided;
        ASSERT_EQ(reading->circle_undecided(p), expected) << text_of(p, 8);
      }
    }
  }
  EXPECT_GT(zeros, 15000);
  EXPECT_GT(undecided, 100000);
}

// The canonical form: what it says of four points on a circle does not depend on which three make the circle.
TEST(SmallFixedPoint, TiesAreBrokenOneWay) {
  std::mt19937_64 random(8);
  int ties = 0;
  for (int i = 0; i < 20000; ++i) {
    Integer p[8];
    exactly_round(random, p);
    const int turn = sgn(orientation(p));
    bool differ = turn != 0;
    for (int k = 0; k < 4; ++k) {
      for (int j = 0; j < k; ++j) differ &= p[2 * k] != p[2 * j] || p[2 * k + 1] != p[2 * j + 1];
    }
    if (!differ) continue;
    if (turn < 0) std::swap_ranges(p, p + 2, p + 2);
    ++ties;
    // Seen from d, of the triangle's vertices all three turns are the same; and from the other side of an
    // edge the answer is the same, too.
    Integer turned[8];
    std::rotate_copy(p, p + 2, p + 6, turned);
    std::copy(p + 6, p + 8, turned + 6);
    const int sign = fixed_predicates().circle_canonical(p);
    ASSERT_TRUE(sign == 1 || sign == -1);
    ASSERT_EQ(fixed_predicates().circle_canonical(turned), sign) << text_of(p, 8);
    const Integer beyond[8] = {p[0], p[1], p[6], p[7], p[2], p[3], p[4], p[5]};  // a, d, b and c
    if (sgn(orientation(beyond)) > 0) {
      ASSERT_EQ(fixed_predicates().circle_canonical(beyond), sign) << text_of(p, 8);
    }
  }
  EXPECT_GT(ties, 10000);
}

// A few in 10^5.
TEST(SmallFixedPoint, FewRandomPredicatesAreUndecided) {
  struct Filter {
    const char* name;
    int (*FixedPredicates::*sign)(const Integer*);
  };
  constexpr int kTrials = 1000000;
  for (const Filter& filter : {Filter{"orientation", &FixedPredicates::orient_filtered},
                               Filter{"angle", &FixedPredicates::angle_compared},
                               Filter{"circle", &FixedPredicates::circle_filtered}}) {
    for (const FixedPredicates* const reading : all_fixed_predicates()) {
      std::mt19937_64 random(9);
      int undecided = 0;
      for (int i = 0; i < kTrials; ++i) {
        Integer p[8];
        random_points(random, p, 4, 61);
        undecided += ((*reading).*filter.sign)(p) == kUndecided;
      }
      std::printf("  %-12s %-10s %6.2f of 10^5 random cases undecided\n", filter.name, reading->name,
                  1e5 * undecided / kTrials);
      EXPECT_LT(undecided, kTrials / 10000) << filter.name;
    }
  }
}

// -----------------------------------------------------------------------------------------------------------
// The worst cases that a search finds

struct Filter {
  const char* name;
  int angles, points;
  mpz_class (*exact)(const Integer*);
  FilteredValue (*FixedPredicates::*value)(const Integer*);
  double FixedPredicates::*bound;
};

/// Points of which the determinant is next to 0, by three or four numbers and a size.
using Shape = std::array<long double, 7>;

void place_points(const Filter& filter, const Shape& shape, Integer* p) {
  const long double size = std::ldexp(1, 60);
  if (filter.points == 3) {
    p[0] = std::llrint(size * (shape[0] - 0.5L));
    p[1] = std::llrint(size * (shape[1] - 0.5L));
    p[2] = std::llrint(size * (shape[2] - 0.5L));
    p[3] = std::llrint(size * (shape[3] - 0.5L));
    for (int axis = 0; axis < 2; ++axis) {
      const auto from = static_cast<long double>(p[axis]), to = static_cast<long double>(p[2 + axis]);
      p[4 + axis] = std::llrint(from + (shape[4] * 2 - 1) * (to - from));
    }
    return;
  }
  const long double radius = size * (0.25L + shape[4] / 4);
  for (int k = 0; k < 4; ++k) {
    const long double at = shape[k] * 6.283185307179586476925L;
    p[2 * k] = std::llrint(size * (shape[5] - 0.5L) + radius * std::cos(at));
    p[2 * k + 1] = std::llrint(size * (shape[6] - 0.5L) + radius * std::sin(at));
  }
}

/// How large a value of the wrong sign is, as a share of what the filter takes for an error. A filter decides
/// wrongly if it is more than 1.
double wrong_share(const FixedPredicates& reading, const Filter& filter, const Device& device,
                   const Integer* p) {
  FilteredValue found{};
  {
    const Rounding rounding(device.direction, device.flushes);
    found = (reading.*filter.value)(p);
  }
  const double exact = filter.exact(p).get_d();
  if (found.magnitude == 0) return 0;
  const double wrong = (found.value > 0 ? std::min(found.value, found.value - exact)
                                        : -std::max(found.value, found.value - exact));
  // Where the sign is right, by how much it is too large: which leads to where it is wrong.
  const double share = wrong / (reading.*filter.bound * found.magnitude);
  return exact == 0 || (exact > 0) != (found.value > 0) ? share : std::min(share, 0.0);
}

/// Climbs from random shapes.
double worst_share(const FixedPredicates& reading, const Filter& filter, const Device& device, int climbs,
                   int steps, std::mt19937_64& random) {
  double worst = 0;
  std::uniform_real_distribution<double> unit;
  for (int climb = 0; climb < climbs; ++climb) {
    Shape shape{};
    const long double spread = std::ldexp(1, -between(random, 0, 12));
    const long double first = unit(random);
    for (long double& x : shape)
      x = (random() & 1) != 0 ? unit(random) : std::fmod(first + spread * unit(random), 1.0L);
    Integer p[8] = {};
    place_points(filter, shape, p);
    double best = wrong_share(reading, filter, device, p);
    for (int step = 0; step < steps; ++step) {
      Shape next = shape;
      for (int changes = between(random, 1, 3); changes > 0; --changes) {
        long double& x = next[random() % next.size()];
        x = std::clamp(x + std::ldexp(unit(random) - 0.5, -between(random, 0, 40)), 0.0L, 1.0L);
      }
      place_points(filter, next, p);
      const double share = wrong_share(reading, filter, device, p);
      if (share >= best) {
        best = share;
        shape = next;
      }
    }
    worst = std::max(worst, best);
  }
  return worst;
}

// Set FLAUNAY_SEARCH to search so many times as long.
TEST(FixedPoint, NoSearchFindsAWrongSign) {
  const Filter filters[] = {
      {"orientation", 0, 3, orientation, &FixedPredicates::orient_value, &FixedPredicates::orient_bound},
      {"angle", 0, 4, in_circle, &FixedPredicates::angle_value, &FixedPredicates::angle_bound},
      {"circle", 0, 4, in_circle, &FixedPredicates::circle_value, &FixedPredicates::circle_bound}};
  const char* const longer = std::getenv("FLAUNAY_SEARCH");
  const int climbs = 4 * (longer != nullptr ? std::atoi(longer) : 1);
  std::mt19937_64 random(10);
  for (const Filter& filter : filters) {
    double largest = 0;
    for_each_device([&](const FixedPredicates& reading, const Device& device) {
      const double share = worst_share(reading, filter, device, climbs, 3000, random);
      std::printf("  %-12s %-10s %-22s largest error of a wrong sign %6.3f of the bound\n", filter.name,
                  reading.name, device.name, share);
      EXPECT_LT(share, 1) << filter.name << ", " << reading.name << ", " << device.name;
      largest = std::max(largest, share);
    });
    // The search comes near what the derivation allows for.
    EXPECT_GT(largest, 0.15) << filter.name;
  }
}

// -----------------------------------------------------------------------------------------------------------
// Numbers

TEST(SmallFixedPoint, DifferencesAsRealNumbers) {
  std::mt19937_64 random(11);
  for_each_device([&](const FixedPredicates& reading, const Device& device) {
    const Rounding rounding(device.direction, device.flushes);
    double largest = 0;
    const auto expect = [&](Integer difference) {
      const double found = std::ldexp(double{reading.real_of(difference)}, 33);
      // Both are exact: a float has 24 bits.
      const mpz_class error = abs(mpz_class(found) - integer(difference));
      if (difference == 0) {
        ASSERT_EQ(found, 0);
        return;
      }
      ASSERT_EQ(found > 0, difference > 0);
      const double share = error.get_d() / (reading.roundoff * std::fabs(integer(difference).get_d()));
      ASSERT_LE(share, 1) << difference << ", " << reading.name << ", rounded " << device.name;
      largest = std::max(largest, share);
    };
    for (int bits = 0; bits <= 62; ++bits) {
      for (int i = 0; i < 300; ++i) {
        expect(number(random, bits));
        // Next to powers of two, and to sums of two of them, which are between floats.
        const Integer power = Integer{1} << bits,
                      lower = Integer{1} << between(random, 0, std::max(0, bits - 1));
        expect(power - 1);
        expect(power + lower + number(random, 2));
        expect(-power - (bits < 62 ? lower - 1 : 0));
        expect(power - lower + number(random, 2));
        expect((power | (power - 1) >> 24) - number(random, 10));
      }
    }
    expect(2 * kLargest);
    expect(-2 * kLargest);
    EXPECT_GT(largest, 0.45) << reading.name << ", " << device.name;
    std::printf("  %-10s %-22s difference wrong by %5.3f of ROUNDOFF\n", reading.name, device.name, largest);
  });
}

TEST(SmallFixedPoint, DifferencesRoundedAsDoublesAre) {
  std::mt19937_64 random(12);
  int rounded = 0, ties = 0;
  const auto expect = [&](double a, double b) {
    const auto whole_a = static_cast<Integer>(a), whole_b = static_cast<Integer>(b);
    const auto expected = static_cast<Integer>(a - b);
    for (const FixedPredicates* const reading : all_fixed_predicates()) {
      ASSERT_EQ(reading->rounded_difference(whole_a, whole_b), expected) << whole_a << " - " << whole_b;
    }
    rounded += whole_a - whole_b != expected;
    const Integer off = std::abs(whole_a - whole_b - expected);
    ties += off != 0 && 2 * off == (Integer{1} << std::max(0, std::ilogb(a - b) - 52));
  };
  for (int i = 0; i < 200000; ++i) {
    // Doubles of at most 53 bits below 2^62.
    const auto any = [&] {
      const double mantissa = static_cast<double>(number(random, between(random, 1, 53)));
      return std::ldexp(mantissa, between(random, 0, 9));
    };
    const double a = any(), b = any();
    expect(a, b);
    // Ties: a last bit half a unit of the difference.
    const double unit = std::ldexp(1, between(random, 0, 9));
    expect(unit * 0x1p52 + unit * static_cast<double>(number(random, 20)),
           -unit * static_cast<double>(number(random, 52)));
    expect(unit * static_cast<double>(number(random, 53)), unit * static_cast<double>(number(random, 53)));
  }
  const double largest = 0x1p62 - 0x1p9;
  for (const double a : {largest, -largest, largest - 0x1p9, 0.0, 1.0, -1.0, 0x1p61}) {
    for (const double b : {largest, -largest, largest - 0x1p9, 0.0, 1.0, -1.0, 0x1p61}) expect(a, b);
  }
  EXPECT_GT(rounded, 10000);
  EXPECT_GT(ties, 1000);
}

double double_of(std::uint64_t bits) {
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}
std::uint64_t bits_of(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

TEST(SmallFixedPoint, CoordinatesFromTheBitsOfDoubles) {
  std::mt19937_64 random(13);
  const FixedPredicates& reading = fixed_predicates();
  for (int i = 0; i < 500000; ++i) {
    const int bits = between(random, 0, 53);
    const auto mantissa = static_cast<double>(number(random, bits));
    const int exponent = between(random, -1074, 1023 - bits);
    const double x = std::ldexp(mantissa, exponent);
    // Where the host may shift it: an integer below 2^62.
    const int top = x == 0 ? exponent : std::ilogb(x);
    const int shift = -exponent + between(random, 0, 61 - (top - exponent));
    ASSERT_EQ(reading.fixed_point(bits_of(x), shift),
              static_cast<Integer>(std::ldexp(mantissa, exponent + shift)))
        << x << " by " << shift;
  }
  EXPECT_EQ(reading.fixed_point(bits_of(-0.0), 0), 0);
  EXPECT_EQ(reading.fixed_point(bits_of(0x1p-1074), 1074 + 61), Integer{1} << 61);
  EXPECT_EQ(reading.fixed_point(bits_of(-std::nextafter(0x1p1023, 0.0)), 61 - 1022),
            -((Integer{1} << 62) - (1 << 9)));
}

TEST(SmallFixedPoint, FloatsAsDoubles) {
  std::mt19937_64 random(14);
  const auto expect = [](std::uint32_t bits) {
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    const std::uint64_t wide = fixed_predicates().widened_bits(bits);
    if (std::isnan(value)) {
      ASSERT_TRUE(std::isnan(double_of(wide))) << bits;
    } else {
      ASSERT_EQ(wide, bits_of(double{value})) << bits;
    }
  };
  for (const std::uint32_t sign : {0U, 0x80000000U}) {
    for (const std::uint32_t bits : {0U, 1U, 2U, 0x007fffffU, 0x00800000U, 0x00800001U, 0x3f800000U,
                                     0x7f7fffffU, 0x7f800000U, 0x7f800001U, 0x7fc00000U, 0x7fffffffU}) {
      expect(sign | bits);
    }
    for (int k = 0; k < 23; ++k) expect(sign | 1U << k);
  }
  for (int i = 0; i < 500000; ++i) {
    const auto bits = static_cast<std::uint32_t>(random());
    expect(bits);
    expect(bits & 0x807fffffU);  // subnormal
  }
}

}  // namespace
}  // namespace flaunay::testing
