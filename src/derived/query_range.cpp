#include "derived/query_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "input/inspect.hpp"

namespace flaunay::derived {
namespace {

// Coordinates below 2^509 that are multiples of 2^-511: no product of two differences overflows or
// underflows.
constexpr int kLargestExponent = 508;
constexpr int kLowestExponent = -511;
constexpr int kMostBits = kLargestExponent - kLowestExponent + 1;
// With so many bits nothing is rounded: 2k + 4 within 53.
constexpr int kCoarseBits = 24;

// As in the kernels' headers.
constexpr double kRoundoff = 0x1p-53;
constexpr double kOrientBound = (3.0 + 16.0 * kRoundoff) * kRoundoff;
constexpr double kNearnessBound = 6.0 * kRoundoff;

[[noreturn]] void throw_not_finite(host::Runtime& runtime, const Buffer<cl_double>& queries,
                                   std::size_t query) {
  double at[2];
  runtime.read(queries, 2 * query, 2, at);
  throw Error(ErrorKind::input, fmt::format("query {} is not finite: ({}, {})", query, at[0], at[1]));
}

// Names the query that goes further beyond the points' magnitudes.
[[noreturn]] void throw_range(host::Runtime& runtime, const Buffer<cl_double>& queries, std::size_t m,
                              const Magnitudes& points, const Magnitudes& asked) {
  std::vector<double> all(2 * m);
  runtime.read(queries, 0, all.size(), all.data());
  const bool is_fine = points.lowest - asked.lowest > asked.largest - points.largest;
  const auto found = std::find_if(all.begin(), all.end(), [&](double x) {
    return x != 0 && (is_fine ? lowest_bit(x) == asked.lowest : std::ilogb(x) == asked.largest);
  });
  const auto i = static_cast<std::size_t>(found - all.begin());
  throw Error(
      ErrorKind::input,
      fmt::format("query {} is too {} to be exact: it has {} = {:.17g}; the bits of points and queries "
                  "together span {} binary places, {} are supported",
                  i / 2, is_fine ? "fine" : "far", i % 2 ? "y" : "x", *found,
                  std::max(points.largest, asked.largest) - std::min(points.lowest, asked.lowest) + 1,
                  kMostBits));
}

}  // namespace

QueryScaling query_scaling(host::Runtime& runtime, const Magnitudes& points, int point_shift,
                           const Buffer<cl_double>& queries, std::size_t m) {
  const Magnitudes asked = inspect(runtime, queries, m);
  if (static_cast<std::size_t>(asked.bad) < m) throw_not_finite(runtime, queries, asked.bad);
  QueryScaling scaling;
  scaling.shift = point_shift;
  const int largest = std::max(points.largest, asked.largest);
  const int lowest = std::min(points.lowest, asked.lowest);
  const int bits = largest - lowest + 1;
  if (bits > kMostBits) throw_range(runtime, queries, m, points, asked);
  if (lowest <= largest) {
    if (largest + point_shift > kLargestExponent) scaling.shift = kLargestExponent - largest;
    if (lowest + point_shift < kLowestExponent) scaling.shift = kLowestExponent - lowest;
  }
  scaling.unit = std::ldexp(1.0, scaling.shift - point_shift);
  if (bits > kCoarseBits) {
    scaling.orient_bound = kOrientBound;
    scaling.nearness_bound = kNearnessBound;
  }
  return scaling;
}

}  // namespace flaunay::derived
