#include "locate/query_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "points/inspect.hpp"
#include "shared/bounds.h"

namespace flaunay::locate {
namespace {

[[noreturn]] void throw_not_finite(host::Runtime& runtime, const Buffer<cl_double>& queries,
                                   std::size_t query) {
  double at[2];
  runtime.read(queries, 2 * query, 2, at);
  throw Error(ErrorKind::input, fmt::format("query {} is not finite: ({}, {})", query, at[0], at[1]));
}

// Throws an error that names the query whose magnitude exceeds that of the points by more.
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
                  kernel::MOST_QUERY_BITS));
}

}  // namespace

QueryScaling query_scaling(host::Runtime& runtime, const Magnitudes& points, int point_shift,
                           const Buffer<cl_double>& queries, std::size_t m) {
  const Magnitudes asked = inspect(runtime, queries, m);
  if (static_cast<std::size_t>(asked.bad) < m) throw_not_finite(runtime, queries, asked.bad);
  const Magnitudes both{std::max(points.largest, asked.largest), std::min(points.lowest, asked.lowest)};
  if (both.largest - both.lowest + 1 > kernel::MOST_QUERY_BITS)
    throw_range(runtime, queries, m, points, asked);
  return query_scaling(both, point_shift);
}

QueryScaling query_scaling(const Magnitudes& both, int point_shift) {
  QueryScaling scaling;
  scaling.shift = point_shift;
  const auto [largest, lowest, bad] = both;
  const int bits = largest - lowest + 1;
  if (lowest <= largest) {
    if (largest + point_shift > kernel::LARGEST_QUERY_EXPONENT)
      scaling.shift = kernel::LARGEST_QUERY_EXPONENT - largest;
    if (lowest + point_shift < kernel::LOWEST_QUERY_EXPONENT)
      scaling.shift = kernel::LOWEST_QUERY_EXPONENT - lowest;
  }
  scaling.unit = std::ldexp(1.0, scaling.shift - point_shift);
  if (bits > kernel::COARSE_QUERY_BITS) {
    scaling.orient_bound = ORIENT_BOUND;
    scaling.nearness_bound = NEARNESS_BOUND;
  }
  return scaling;
}

}  // namespace flaunay::locate
