#include "constrained/refinement/bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arithmetic/exact_arithmetic.h"
#include "flaunay/flaunay.hpp"

namespace flaunay::constrained {
namespace {

constexpr double kLargestAngle = 34, kLensAngle = 20;

/// Sums of two doubles, with about 100 bits.
using Pair = kernel::double2;

Pair sum(Pair a, Pair b) {
  const Pair high = kernel::two_sum(a.x, b.x);
  return kernel::fast_two_sum(high.x, high.y + (a.y + b.y));
}

Pair product(Pair a, Pair b) {
  const Pair high = kernel::two_product(a.x, b.x);
  return kernel::fast_two_sum(high.x, high.y + (a.x * b.y + a.y * b.x));
}

Pair quotient(Pair a, double b) {
  const double high = a.x / b;
  const Pair back = kernel::two_product(high, b);
  return kernel::fast_two_sum(high, (((a.x - back.x) - back.y) + a.y) / b);
}

/// Sums the Taylor series of the sine, rounded to a multiple of 2^-56 or to a unit in the last place.
double squared_sine_of(double degrees) {
  if (degrees == 0) return 0;
  const Pair degree{0x1.1df46a2529d39p-6, 0x1.5c1d8becdd291p-62};
  const Pair angle = product({degrees, 0}, degree), square = product(angle, -angle);
  Pair sine = angle, term = angle;
  for (int k = 2; k < 40; k += 2) {
    term = quotient(product(term, square), k * (k + 1));
    sine = sum(sine, term);
  }
  const double squared = product(sine, sine).x;
  // Doubles from here on are multiples of 2^-56.
  constexpr double kCoarse = 0.0625;
  return squared < kCoarse ? (squared + kCoarse) - kCoarse : squared;
}

}  // namespace

QualityBounds quality_bounds(double min_angle) {
  if (!(min_angle >= 0 && min_angle <= kLargestAngle)) {
    throw Error(ErrorKind::usage,
                fmt::format("the smallest angle is to be {} degrees, but it can be from 0 to {}", min_angle,
                            kLargestAngle));
  }
  const double squared = squared_sine_of(min_angle);
  // Triangle's factor; the square root of (1 + cos theta) / (1 - cos theta).
  const double off_centre = 0.475 * ((1 + std::sqrt(1 - squared)) / std::sqrt(squared));
  static const double of_lens = squared_sine_of(kLensAngle);
  const double cosine = 1 - 2 * (min_angle > kLensAngle ? squared : of_lens);
  return {squared, squared > 0 ? off_centre : 0, cosine * cosine};
}

void check_areas(const double* areas, std::size_t count, const char* what) {
  for (std::size_t i = 0; i < count; ++i) {
    if (areas[i] >= 0) continue;
    throw Error(ErrorKind::usage,
                fmt::format("{}{}: the largest area is {}, but it can be 0, for any, or more", what,
                            count > 1 ? fmt::format(" {}", i) : "", areas[i]));
  }
}

}  // namespace flaunay::constrained
