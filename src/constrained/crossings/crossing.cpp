#include "constrained/crossings/crossing.hpp"

#include <algorithm>
#include <cmath>

#include "predicates/area.h"

namespace flaunay::constrained {
using namespace geometry;

namespace {

using kernel::double2;
using kernel::expansion;
using kernel::two_product;
using kernel::two_sum;

double2 difference(double a, double b) { return two_sum(a, -b); }

// first x second, of differences.
expansion cross(double2 first_x, double2 first_y, double2 second_x, double2 second_y) {
  expansion product;
  kernel::expansion_cross(first_x, first_y, second_x, second_y, &product);
  kernel::expansion_compress(&product);
  return product;
}

// A coordinate of the crossing of a-b and c-d is a + (numerator / denominator) (b - a), with the coordinates
// of a and b, where the numerator is (c - a) x (d - c) and the denominator (b - a) x (d - c).
class ExactCrossing {
 public:
  ExactCrossing(const Line& first, const Line& second) : first_(first) {
    const double2 x = difference(second.b.x, second.a.x), y = difference(second.b.y, second.a.y);
    numerator_ = cross(difference(second.a.x, first.a.x), difference(second.a.y, first.a.y), x, y);
    denominator_ = cross(difference(first.b.x, first.a.x), difference(first.b.y, first.a.y), x, y);
  }

  int compare(bool vertical, double2 value) const {
    const expansion distance = scaled_distance(vertical, value);
    return kernel::expansion_sign(&distance) * kernel::expansion_sign(&denominator_);
  }

  double round(bool vertical, double unit) const {
    const expansion scaled = scaled_distance(vertical, {0, 0});
    // The quotient is wrong by a few units in the last place, so few steps follow.
    double rounded = kernel::expansion_value(&scaled) / kernel::expansion_value(&denominator_);
    if (std::fabs(rounded) < unit * 0x1p52) rounded = std::nearbyint(rounded / unit) * unit;
    while (is_nearer(rounded, step(rounded, HUGE_VAL, unit), vertical))
      rounded = step(rounded, HUGE_VAL, unit);
    while (is_nearer(rounded, step(rounded, -HUGE_VAL, unit), vertical)) {
      rounded = step(rounded, -HUGE_VAL, unit);
    }
    return rounded + 0.0;
  }

 private:
  // The coordinate minus the value, times the denominator.
  expansion scaled_distance(bool vertical, double2 value) const {
    const double a = vertical ? first_.a.y : first_.a.x, b = vertical ? first_.b.y : first_.b.x;
    expansion sum = denominator_, product = numerator_;
    const double from_value[3] = {a, -value.x, -value.y};
    const double2 along = difference(b, a);
    const double factor[2] = {along.x, along.y};
    kernel::expansion_multiply(&sum, from_value, 3);
    kernel::expansion_multiply(&product, factor, 2);
    for (int k = 0; k < product.size; ++k) kernel::expansion_add(&sum, product.part[k]);
    kernel::expansion_compress(&sum);
    return sum;
  }

  // The next number towards another one.
  static double step(double x, double towards, double unit) {
    const double next = std::nextafter(x, towards);
    return std::fabs(next - x) >= unit ? next : towards > x ? x + unit : x - unit;
  }

  // Whether the coordinate is to be rounded to the other one of two numbers that follow each other.
  bool is_nearer(double x, double other, bool vertical) const {
    const double spacing = other - x;
    const int side = compare(vertical, {x, 0.5 * spacing}) * (spacing > 0 ? 1 : -1);
    return side > 0 || (side == 0 && std::fmod(x / spacing, 2) != 0);
  }

  Line first_;
  expansion numerator_, denominator_;
};

// A sum of two doubles that does not overlap, with a bound on its error.
struct Double2 {
  double2 value;
  double error;
};

// Sums and products of pairs have errors below 2^-100 of the magnitudes of their operands, and a quotient
// below 2^-99 of itself. The rest of the bound covers the rounding of bounds.
constexpr double kPairError = 0x1p-97;

double2 pair_product(double2 a, double2 b) {
  const double2 p = two_product(a.x, b.x);
  return kernel::fast_two_sum(p.x, p.y + (a.x * b.y + a.y * b.x));
}

double2 pair_sum(double2 a, double2 b) {
  const double2 high = two_sum(a.x, b.x), low = two_sum(a.y, b.y);
  const double2 sum = kernel::fast_two_sum(high.x, high.y + low.x);
  return kernel::fast_two_sum(sum.x, sum.y + low.y);
}

double2 pair_quotient(double2 a, double2 b) {
  const double first = a.x / b.x;
  const double2 rest = pair_sum(a, -pair_product({first, 0}, b));
  return kernel::fast_two_sum(first, rest.x / b.x);
}

Double2 cross_rounded(double2 first_x, double2 first_y, double2 second_x, double2 second_y) {
  const double2 p = pair_product(first_x, second_y), q = pair_product(first_y, second_x);
  return {pair_sum(p, -q), kPairError * (std::fabs(p.x) + std::fabs(q.x))};
}

// One coordinate, if it is certain how to round it. ratio: of the way from a to b, with its relative error.
bool round_certainly(double a, double b, const Double2& ratio, double unit, double& rounded) {
  const double2 way = pair_product(ratio.value, difference(b, a));
  const double2 sum = pair_sum({a, 0}, way);
  const double error =
      2 * (std::fabs(way.x) * (ratio.error + kPairError) + (std::fabs(a) + std::fabs(way.x)) * kPairError);
  rounded = std::fabs(sum.x) <= error ? 0 : sum.x;
  return std::fabs(sum.x) >= unit * 0x1p53 && sum.x + (sum.y + error) == sum.x &&
         sum.x + (sum.y - error) == sum.x;
}

bool is_multiple(double value, double unit) {
  const double quotient = value / unit;
  return quotient == std::rint(quotient);
}

bool is_on(const Line& line, Point p) { return kernel::orient_sign(line.a, line.b, p, ORIENT_BOUND) == 0; }

}  // namespace

bool cross(const Predicates& predicates, const Line& p, const Line& q) {
  const auto [a, b] = p;
  const auto [c, d] = q;
  if (std::max(a.x, c.x) > std::min(b.x, d.x) ||
      std::max(std::min(a.y, b.y), std::min(c.y, d.y)) > std::min(std::max(a.y, b.y), std::max(c.y, d.y))) {
    return false;
  }
  if (a == c || b == d) return false;
  return predicates.orient(a, b, c) * predicates.orient(a, b, d) < 0 &&
         predicates.orient(c, d, a) * predicates.orient(c, d, b) < 0;
}

int compare_crossing(const Line& first, const Line& second, bool vertical, double2 value) {
  return ExactCrossing(first, second).compare(vertical, value);
}

Point round_crossing(const Line& first, const Line& second, double unit) {
  const double2 x = difference(second.b.x, second.a.x), y = difference(second.b.y, second.a.y);
  const Double2 numerator =
      cross_rounded(difference(second.a.x, first.a.x), difference(second.a.y, first.a.y), x, y);
  const Double2 denominator =
      cross_rounded(difference(first.b.x, first.a.x), difference(first.b.y, first.a.y), x, y);
  Point rounded;
  // Larger relative errors are not worth their analysis.
  constexpr double kMostError = 0x1p-40;
  if (numerator.error < kMostError * std::fabs(numerator.value.x) &&
      denominator.error < kMostError * std::fabs(denominator.value.x)) {
    const Double2 ratio = {pair_quotient(numerator.value, denominator.value),
                           2 * (numerator.error / std::fabs(numerator.value.x) +
                                denominator.error / std::fabs(denominator.value.x))};
    const bool is_certain = round_certainly(first.a.x, first.b.x, ratio, unit, rounded.x) &
                            round_certainly(first.a.y, first.b.y, ratio, unit, rounded.y);
    if (is_certain) return rounded;
    if (is_multiple(rounded.x, unit) && is_multiple(rounded.y, unit) && is_on(first, rounded) &&
        is_on(second, rounded)) {
      return rounded;
    }
  }
  const ExactCrossing exact(first, second);
  return {exact.round(false, unit), exact.round(true, unit)};
}

}  // namespace flaunay::constrained
