#include "geometry/magnitudes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "flaunay/flaunay.hpp"
#include "shared/bounds.h"

namespace flaunay::geometry {
namespace {

// The number of bits that the coordinates span; 0 if all are 0.
int bits_of(const Magnitudes& magnitudes) {
  return magnitudes.lowest <= magnitudes.largest ? magnitudes.largest - magnitudes.lowest + 1 : 0;
}

[[noreturn]] void throw_range(const double* coordinates, std::size_t n, const Magnitudes& magnitudes) {
  std::size_t largest = 0, finest = 0;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const double x = coordinates[i];
    if (x == 0) continue;
    if (std::ilogb(x) == magnitudes.largest) largest = i;
    if (lowest_bit(x) == magnitudes.lowest) finest = i;
  }
  throw Error(
      ErrorKind::input,
      fmt::format(
          "the coordinates' magnitudes differ too much to be exact: point {} has {} = {:.17g} and point "
          "{} has {} = {:.17g}, whose bits span {} binary places; {} are supported",
          largest / 2, largest % 2 ? "y" : "x", coordinates[largest], finest / 2, finest % 2 ? "y" : "x",
          coordinates[finest], bits_of(magnitudes), kernel::MOST_BITS));
}

}  // namespace

int lowest_bit(double x) {
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);
  auto mantissa = static_cast<std::uint64_t>(std::ldexp(std::fabs(fraction), 53));
  int low = exponent - 53;
  while ((mantissa & 1) == 0) {
    mantissa >>= 1;
    ++low;
  }
  return low;
}

bool can_be_exact(const Magnitudes& magnitudes, std::size_t n) {
  return magnitudes.bad >= static_cast<int>(n) && bits_of(magnitudes) <= kernel::MOST_BITS;
}

Scaling scaling_for(const double* coordinates, std::size_t n, const Magnitudes& magnitudes) {
  if (magnitudes.bad < static_cast<int>(n)) {
    const double x = coordinates[2 * magnitudes.bad];
    const double y = coordinates[2 * magnitudes.bad + 1];
    throw Error(ErrorKind::input, fmt::format("point {} is not finite: ({}, {})", magnitudes.bad, x, y));
  }
  Scaling scaling;
  const int bits = bits_of(magnitudes);
  if (bits > kernel::MOST_BITS) throw_range(coordinates, n, magnitudes);
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

kernel::scaling Scaling::powers() const {
  const int first = shift / 3, second = (shift - first) / 2;
  return {std::ldexp(1.0, first), std::ldexp(1.0, second), std::ldexp(1.0, shift - first - second)};
}

void check_offsets(const std::vector<std::size_t>& offsets) {
  if (offsets.empty() || offsets.front() != 0 || !std::is_sorted(offsets.begin(), offsets.end())) {
    throw Error(ErrorKind::usage, "offsets of point sets must begin with 0 and not decrease");
  }
}

void check_offsets(const std::vector<std::size_t>& offsets, std::size_t n) {
  check_offsets(offsets);
  if (offsets.back() != n) {
    throw Error(ErrorKind::usage,
                fmt::format("offsets of point sets end with {}, but there are {} points", offsets.back(), n));
  }
}

void check_coordinates(const void* coordinates, std::size_t n) {
  if (n > 0 && coordinates == nullptr) {
    throw Error(ErrorKind::usage, fmt::format("{} points, but no coordinates: the pointer is null", n));
  }
}

}  // namespace flaunay::geometry
