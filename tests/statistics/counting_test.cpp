// Holds the weights of src/statistics to the predicates' own text, read once more with a number
// type that counts what is done with it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "flaunay/flaunay.hpp"
#include "geometry/predicates.hpp"
#include "statistics/counter.hpp"
#include "tests/support/bounds.hpp"

namespace flaunay::testing {
namespace counted {

struct Tally {
  std::uint64_t plain = 0;        // arithmetic that the value itself takes
  std::uint64_t bound = 0;        // arithmetic that its error bound takes
  std::uint64_t comparisons = 0;  // the first decides by the value, the others are due to the bound
};
Tally tally;

// What descends from a magnitude or from the filter's factor belongs to the bound. Changes of sign are free.
struct Counted {
  Counted(double v = 0, bool b = false) : value(v), of_bound(b) {}
  double value;
  bool of_bound;
};

Counted result(double value, Counted a, Counted b) {
  const bool of_bound = a.of_bound || b.of_bound;
  ++(of_bound ? tally.bound : tally.plain);
  return {value, of_bound};
}
Counted operator+(Counted a, Counted b) { return result(a.value + b.value, a, b); }
Counted operator-(Counted a, Counted b) { return result(a.value - b.value, a, b); }
Counted operator*(Counted a, Counted b) { return result(a.value * b.value, a, b); }
Counted operator-(Counted a) { return {-a.value, a.of_bound}; }
bool operator<(Counted a, Counted b) { return ++tally.comparisons, a.value < b.value; }
bool operator>(Counted a, Counted b) { return ++tally.comparisons, a.value > b.value; }
bool operator==(Counted a, Counted b) { return ++tally.comparisons, a.value == b.value; }
bool operator!=(Counted a, Counted b) { return ++tally.comparisons, a.value != b.value; }
bool operator>=(Counted a, Counted b) { return ++tally.comparisons, a.value >= b.value; }
Counted fabs(Counted a) { return {std::fabs(a.value), true}; }
Counted fma(Counted a, Counted b, Counted c) {
  return result(std::fma(a.value, b.value, c.value), result(0, a, b), c);
}

struct double2 {
  Counted x, y;
};
double2 operator-(double2 a, double2 b) { return {a.x - b.x, a.y - b.y}; }
double2 operator-(double2 a) { return {-a.x, -a.y}; }

// The numbers of arithmetic/numbers.h, which is not read again.
using coordinate = Counted;
using real = Counted;
using filter_bound = Counted;
using coordinate2 = double2;
using real2 = double2;
using coordinate_pair = double2;
using real_pair = double2;
Counted difference(Counted a, Counted b) { return a - b; }
double2 difference2(double2 a, double2 b) { return a - b; }
double2 pair_difference(double2 a, double2 b) { return a - b; }
Counted error_within(Counted bound, Counted magnitude) { return bound * magnitude; }
double2 operator+(double2 a, double2 b) { return {a.x + b.x, a.y + b.y}; }
double2 operator*(double2 a, double2 b) { return {a.x * b.x, a.y * b.y}; }
double2 as_pair(double2 p) { return p; }
Counted low(double2 p) { return p.x; }
Counted high(double2 p) { return p.y; }
double2 swapped(double2 p) { return {p.y, p.x}; }
double2 lows(double2 p, double2 q) { return {p.x, q.x}; }
double2 highs(double2 p, double2 q) { return {p.y, q.y}; }
double2 high_negated(double2 p) { return {p.x, -p.y}; }
double2 magnitudes(double2 p) { return {fabs(p.x), fabs(p.y)}; }

// For the exact tests, which are read but not counted.
using kernel::as_long;
using kernel::as_ulong;
using kernel::high_product;
using kernel::int64;
using kernel::uint64;
inline uint64 as_ulong(Counted x) { return as_ulong(x.value); }
inline Counted as_double(uint64 bits) { return kernel::as_double(bits); }
inline long convert_long(Counted x) { return kernel::convert_long(x.value); }
inline Counted convert_double(long x) { return kernel::convert_double(x); }

}  // namespace counted
}  // namespace flaunay::testing

#undef FLAUNAY_CIRCLE_INTEGERS_H
#undef FLAUNAY_EXACT_ARITHMETIC_H
#undef FLAUNAY_EXACT_DOUBLES_H
#undef FLAUNAY_AXES_H
#undef FLAUNAY_HULL_HEIGHT_H
#undef FLAUNAY_INTEGER_ARITHMETIC_H
#undef FLAUNAY_PLANAR_H
#undef SHARED_NAMESPACE
#define SHARED_NAMESPACE flaunay::testing::counted
#define double Counted
#include "flattened/hull_height.h"
#include "predicates/planar.h"
#undef double

namespace flaunay::testing {
namespace counted {

// The filter of a depth, as the kernels have it where they call hull_depth.
int depth_filtered(double2 a, double2 b, double2 p, Counted bound) {
  const double2 d = hull_depth(a, b, p, 0);
  const Counted error = bound * d.y;
  return d.x > error ? 1 : d.x < -error ? 0 : UNDECIDED;
}

}  // namespace counted

namespace {

using counted::Counted;
using counted::tally;

Counted bound(double value) { return {value, true}; }

// One comparison decides a predicate.
void expect_weights(const research::OperationCounts& one) {
  EXPECT_EQ(tally.plain + 1, one.operations());
  EXPECT_EQ(tally.plain + tally.bound + tally.comparisons, one.operations_with_bounds());
}

research::OperationCounts count_of(void (statistics::Counter::*count)()) {
  statistics::Counter counter;
  (counter.*count)();
  return counter.counts();
}

// Each decides for a negative sign, which takes both comparisons.

TEST(Counting, Depth) {
  tally = {};
  EXPECT_EQ(counted::depth_filtered({1.0, 0.0}, {2.0, 4.0}, {49.0, 1.0}, bound(usual_bounds().hull)), 0);
  expect_weights(count_of(&statistics::Counter::depth));
  EXPECT_EQ(tally.plain + 1, kernel::DEPTH_OPERATIONS);
}

TEST(Counting, Projection) {
  tally = {};
  counted::project({3.0, 1.0}, 0.5, 0);
  EXPECT_EQ(tally.plain, kernel::PROJECT_OPERATIONS);
}

TEST(Counting, Orientation) {
  tally = {};
  EXPECT_EQ(counted::orient_filtered({0.0, 0.0}, {0.0, 1.0}, {1.0, 0.0}, bound(usual_bounds().orient)), -1);
  expect_weights(count_of(&statistics::Counter::orientation));
  EXPECT_EQ(tally.plain + 1, kernel::ORIENT_OPERATIONS);
}

// An angle takes an orientation and a dot product.
TEST(Counting, Angles) {
  tally = {};
  const counted::angle seen = counted::angle_at({0.0, 1.0}, {0.0, 0.0}, {1.0, 0.0});
  EXPECT_EQ(counted::angle_side(seen, bound(usual_bounds().orient)), 1);
  EXPECT_EQ(tally.plain + 1, kernel::ORIENT_OPERATIONS + kernel::DOT_OPERATIONS);
  const counted::angle other = counted::angle_at({0.5, 0.5}, {0.0, 0.0}, {1.0, 0.0});
  tally = {};
  counted::angle_compared(seen, other, counted::angle_bound(bound(usual_bounds().circle)));
  EXPECT_EQ(tally.plain + 1, kernel::ANGLE_OPERATIONS);
}

TEST(Counting, Circle) {
  tally = {};
  EXPECT_EQ(
      counted::circle_filtered({0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {5.0, 5.0}, bound(usual_bounds().circle)),
      -1);
  expect_weights(count_of(&statistics::Counter::circle));
}

TEST(Counting, StepsOfTheScanModel) {
  EXPECT_EQ(statistics::log2_ceiling(0), 0U);
  EXPECT_EQ(statistics::log2_ceiling(1), 0U);
  EXPECT_EQ(statistics::log2_ceiling(2), 1U);
  EXPECT_EQ(statistics::log2_ceiling(9), 4U);
  EXPECT_EQ(statistics::scan_depth(1024), 20U);
}

}  // namespace
}  // namespace flaunay::testing
