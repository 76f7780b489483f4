#include "locate/query_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "points/inspect.hpp"
#include "shared/bounds.h"
#include "shared/coordinates.h"

namespace flaunay::locate {
namespace {

[[noreturn]] void throw_not_finite(host::Runtime& runtime, const Buffer<cl_double>& queries,
                                   std::size_t query) {
  double at[2];
  runtime.read(queries, 2 * query, 2, at);
  throw Error(ErrorKind::input, fmt::format("query {} is not finite: ({}, {})", query, at[0], at[1]));
}

Magnitudes together(const Magnitudes& a, const Magnitudes& b) {
  return {std::max(a.largest, b.largest), std::min(a.lowest, b.lowest), std::min(a.bad, b.bad)};
}

// Throws an error that names the one of the queries [first, last) whose magnitude exceeds that of the points
// by more.
[[noreturn]] void throw_range(host::Runtime& runtime, const Buffer<cl_double>& queries, std::size_t first,
                              std::size_t last, const Magnitudes& points, const Magnitudes& asked,
                              const QueryLimits& limits) {
  std::vector<double> all(2 * (last - first));
  runtime.read(queries, 2 * first, all.size(), all.data());
  const bool is_fine = points.lowest - asked.lowest > asked.largest - points.largest;
  const auto found = std::find_if(all.begin(), all.end(), [&](double x) {
    return x != 0 && (is_fine ? lowest_bit(x) == asked.lowest : std::ilogb(x) == asked.largest);
  });
  const auto i = static_cast<std::size_t>(found - all.begin());
  throw Error(
      ErrorKind::input,
      fmt::format("query {} is too {} to be exact: it has {} = {:.17g}; the bits of points and queries "
                  "together span {} binary places, {} are supported",
                  first + i / 2, is_fine ? "fine" : "far", i % 2 ? "y" : "x", *found,
                  bits_of(together(points, asked)), limits.most_bits()));
}

}  // namespace

QueryScaling query_scaling(const Magnitudes& both, int point_shift, const QueryLimits& limits) {
  int shift = point_shift;
  if (bits_of(both) > 0) {
    if (both.largest + point_shift > limits.largest) shift = limits.largest - both.largest;
    if (both.lowest + point_shift < limits.lowest) shift = limits.lowest - both.lowest;
  }
  QueryScaling scaling;
  scaling.frames.push_back({kernel::scale_of(shift), std::ldexp(1.0, shift - point_shift)});
  if (bits_of(both) > kernel::COARSE_QUERY_BITS) {
    scaling.orient_bound = ORIENT_BOUND;
    scaling.nearness_bound = NEARNESS_BOUND;
  }
  return scaling;
}

QueryScaling query_scaling(host::Runtime& runtime, const PointRange& points, const Buffer<cl_double>& queries,
                           const std::vector<std::size_t>& query_offsets, const QueryLimits& limits) {
  const std::size_t sets = query_offsets.size() - 1, m = query_offsets.back();
  const Magnitudes asked = inspect(runtime, queries, m);
  if (asked.bad != kernel::NO_BAD) throw_not_finite(runtime, queries, static_cast<std::size_t>(asked.bad));
  Magnitudes both = asked;
  for (const Magnitudes& of_set : points.by_set) both = together(both, of_set);
  if (points.shifts.size() == 1 && bits_of(both) <= limits.most_bits()) {
    QueryScaling scaling = query_scaling(both, points.shifts[0], limits);
    scaling.frames.resize(sets, scaling.frames[0]);
    return scaling;
  }
  QueryScaling scaling;
  scaling.frames.reserve(sets);
  const std::vector<Magnitudes> asked_by_set = inspect_sets(runtime, queries, query_offsets);
  for (std::size_t s = 0; s < sets; ++s) {
    both = together(points.by_set[s], asked_by_set[s]);
    if (bits_of(both) > limits.most_bits()) {
      throw_range(runtime, queries, query_offsets[s], query_offsets[s + 1], points.by_set[s], asked_by_set[s],
                  limits);
    }
    const QueryScaling of_set = query_scaling(both, points.shift(s), limits);
    scaling.frames.push_back(of_set.frames[0]);
    scaling.orient_bound = std::max(scaling.orient_bound, of_set.orient_bound);
    scaling.nearness_bound = std::max(scaling.nearness_bound, of_set.nearness_bound);
  }
  return scaling;
}

}  // namespace flaunay::locate
