#include "input/magnitudes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "flaunay/flaunay.hpp"

namespace flaunay {
namespace {

// Coordinates below 2^250 that are multiples of 2^-255: no product of four overflows, and none underflows.
constexpr int kLargestExponent = 249;
constexpr int kLowestExponent = -255;
constexpr int kMostBits = kLargestExponent - kLowestExponent + 1;
// Coordinates of so many bits make the filters exact: 3k + 4, 2k + 3 and 4k + 8 bits within 53.
constexpr int kCoarseHullBits = 16;
constexpr int kCoarseOrientBits = 25;
constexpr int kCoarseCircleBits = 11;

// As in the kernels' headers.
constexpr double kRoundoff = 0x1p-53;
constexpr double kHullBound = 10.0 * kRoundoff;
constexpr double kOrientBound = (3.0 + 16.0 * kRoundoff) * kRoundoff;
constexpr double kCircleBound = (10.0 + 96.0 * kRoundoff) * kRoundoff;

// That the coordinates span; 0 if all are 0.
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
          coordinates[finest], bits_of(magnitudes), kMostBits));
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
  return magnitudes.bad >= static_cast<int>(n) && bits_of(magnitudes) <= kMostBits;
}

Scaling scaling_for(const double* coordinates, std::size_t n, const Magnitudes& magnitudes) {
  if (magnitudes.bad < static_cast<int>(n)) {
    const double x = coordinates[2 * magnitudes.bad];
    const double y = coordinates[2 * magnitudes.bad + 1];
    throw Error(ErrorKind::input, fmt::format("point {} is not finite: ({}, {})", magnitudes.bad, x, y));
  }
  Scaling scaling;
  const int bits = bits_of(magnitudes);
  if (bits > kMostBits) throw_range(coordinates, n, magnitudes);
  if (bits > 0) {
    if (magnitudes.largest > kLargestExponent) scaling.shift = kLargestExponent - magnitudes.largest;
    if (magnitudes.lowest < kLowestExponent) scaling.shift = kLowestExponent - magnitudes.lowest;
  }
  scaling.bounds.hull = bits <= kCoarseHullBits ? 0 : kHullBound;
  scaling.bounds.orient = bits <= kCoarseOrientBits ? 0 : kOrientBound;
  scaling.bounds.circle = bits <= kCoarseCircleBits ? 0 : kCircleBound;
  return scaling;
}

std::array<double, 3> Scaling::powers() const {
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

}  // namespace flaunay
