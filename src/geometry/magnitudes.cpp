#include "geometry/magnitudes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "arithmetic/bit_account.h"
#include "arithmetic/numbers.h"
#include "flaunay/flaunay.hpp"
#include "predicates/bounds.h"

namespace flaunay::geometry {
namespace {

// Doubles of larger exponents may have differences that overflow, where integers in fixed point would not.
constexpr int kLargestOfFiniteDifferences = 1021;

[[noreturn]] void throw_range(const double* coordinates, std::size_t first, std::size_t last,
                              const Magnitudes& magnitudes) {
  const RangeEnds ends = find_ends(coordinates, first, last, magnitudes);
  throw range_error(ends.largest, ends.finest, magnitudes);
}

}  // namespace

int lowest_bit(double x) {
  kernel::bit_account bits = kernel::no_bits();
  kernel::account_for(kernel::as_ulong(x) & MAGNITUDE_BITS, &bits);
  return bits.lowest;
}

Magnitudes inspect(const double* coordinates, std::size_t first, std::size_t last) {
  kernel::bit_account bits = kernel::no_bits();
  int bad = kernel::NO_BAD;
  for (std::size_t i = 2 * first; i < 2 * last && bad == kernel::NO_BAD; ++i) {
    const kernel::uint64 magnitude = kernel::as_ulong(coordinates[i]) & MAGNITUDE_BITS;
    if (magnitude < INFINITE_BITS) {
      kernel::account_for(magnitude, &bits);
    } else {
      bad = static_cast<int>(i / 2);
    }
  }
  return {kernel::largest_exponent(bits), bits.lowest, bad};
}

Magnitudes joined(const Magnitudes& a, const Magnitudes& b) {
  return {std::max(a.largest, b.largest), std::min(a.lowest, b.lowest), std::min(a.bad, b.bad)};
}

RangeEnds find_ends(const double* coordinates, std::size_t first, std::size_t last,
                    const Magnitudes& magnitudes) {
  RangeEnds ends;
  for (std::size_t i = 2 * first; i < 2 * last; ++i) {
    const double x = coordinates[i];
    if (x == 0) continue;
    const NamedCoordinate named{i / 2, i % 2 != 0, x};
    if (std::ilogb(x) == magnitudes.largest) ends.largest = named;
    if (lowest_bit(x) == magnitudes.lowest) ends.finest = named;
  }
  return ends;
}

Error range_error(const NamedCoordinate& largest, const NamedCoordinate& finest,
                  const Magnitudes& magnitudes) {
  return Error(
      ErrorKind::input,
      fmt::format(
          "the coordinates' magnitudes differ too much to be exact: point {} has {} = {:.17g} and point "
          "{} has {} = {:.17g}, whose bits span {} binary places; {} are supported",
          largest.point, largest.is_y ? "y" : "x", largest.value, finest.point, finest.is_y ? "y" : "x",
          finest.value, bits_of(magnitudes), kernel::MOST_BITS));
}

Error not_finite(std::uint64_t point, double x, double y) {
  return Error(ErrorKind::input, fmt::format("point {} is not finite: ({}, {})", point, x, y));
}

int bits_of(const Magnitudes& magnitudes) {
  return magnitudes.lowest <= magnitudes.largest ? magnitudes.largest - magnitudes.lowest + 1 : 0;
}

bool differ_too_much(const Magnitudes& magnitudes) {
  return magnitudes.bad == kernel::NO_BAD && bits_of(magnitudes) > kernel::MOST_BITS;
}

Scaling scaling_for(const double* coordinates, std::size_t first, std::size_t last,
                    const Magnitudes& magnitudes) {
  if (magnitudes.bad != kernel::NO_BAD) {
    const double x = coordinates[2 * magnitudes.bad];
    const double y = coordinates[2 * magnitudes.bad + 1];
    throw not_finite(magnitudes.bad, x, y);
  }
  if (differ_too_much(magnitudes)) throw_range(coordinates, first, last, magnitudes);
  return scaling_for(magnitudes);
}

Scaling scaling_for(const Magnitudes& magnitudes) {
  Scaling scaling;
  const int bits = bits_of(magnitudes);
  if (bits > 0) {
    if (magnitudes.largest > kernel::LARGEST_EXPONENT)
      scaling.shift = kernel::LARGEST_EXPONENT - magnitudes.largest;
    if (magnitudes.lowest < kernel::LOWEST_EXPONENT)
      scaling.shift = kernel::LOWEST_EXPONENT - magnitudes.lowest;
  }
  scaling.bounds.hull = bits <= kernel::COARSE_HULL_BITS ? 0 : HULL_DEPTH_BOUND;
  scaling.bounds.orient = bits <= kernel::COARSE_ORIENT_BITS ? 0 : ORIENT_BOUND;
  scaling.bounds.circle = bits <= kernel::COARSE_CIRCLE_BITS ? 0 : CIRCLE_BOUND;
  return scaling;
}

std::string TooWide::reason() const {
  return fmt::format("coordinates whose bits span {} binary places up to 2^{} (fixed point has {})",
                     bits_of(magnitudes), magnitudes.largest + 1, kernel::COORDINATE_BITS);
}

bool fits_fixed_point(const Magnitudes& magnitudes) {
  return bits_of(magnitudes) <= kernel::COORDINATE_BITS && magnitudes.largest <= kLargestOfFiniteDifferences;
}

int fixed_point_shift(const Magnitudes& magnitudes) {
  return bits_of(magnitudes) == 0 ? 0 : kernel::COORDINATE_BITS - 1 - magnitudes.largest;
}

Bounds fixed_point_bounds(int bits) {
  return {0, ORIENT_BOUND_FOR(SINGLE_ROUNDOFF), CIRCLE_BOUND_FOR(SINGLE_ROUNDOFF),
          bits <= kernel::COARSE_FIXED_BITS};
}

SetScalings set_scalings(const double* coordinates, const std::vector<std::size_t>& offsets,
                         const std::vector<Magnitudes>& by_set) {
  SetScalings scalings;
  scalings.shifts.reserve(by_set.size());
  for (std::size_t s = 0; s < by_set.size(); ++s) {
    const Scaling scaling = scaling_for(coordinates, offsets[s], offsets[s + 1], by_set[s]);
    scalings.shifts.push_back(scaling.shift);
    scalings.bounds.hull = std::max(scalings.bounds.hull, scaling.bounds.hull);
    scalings.bounds.orient = std::max(scalings.bounds.orient, scaling.bounds.orient);
    scalings.bounds.circle = std::max(scalings.bounds.circle, scaling.bounds.circle);
  }
  return scalings;
}

}  // namespace flaunay::geometry
