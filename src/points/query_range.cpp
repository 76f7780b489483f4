#include "points/query_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "arithmetic/coordinates.h"
#include "flaunay/flaunay.hpp"
#include "locate/off_grid.h"
#include "points/inspect.hpp"
#include "predicates/bounds.h"
#include "tuning/tuning.hpp"

namespace flaunay::points {
using namespace geometry;

namespace {

[[noreturn]] void throw_not_finite(host::Runtime& runtime, const Buffer<cl_double>& queries,
                                   std::size_t query) {
  double at[2];
  runtime.read(queries, 2 * query, 2, at);
  throw Error(ErrorKind::input, fmt::format("query {} is not finite: ({}, {})", query, at[0], at[1]));
}

// Queries that are farther away than points are off the grid, if all are not on it, unless by less than this.
constexpr int kPlacesBeyondPoints = 1;

// Coordinates of this many bits are exact as floats, and so are the differences and products of both filters,
// as for COARSE_QUERY_BITS.
constexpr int kCoarseBits = 10;

bool is_in_fixed_point(host::Runtime& runtime) { return runtime.capabilities().fixed_point; }

// The shift of points and queries together. If they do not fit, the shift of the points, with as many places
// as possible for finer queries.
int shift_together(const Magnitudes& points, const Magnitudes& of_queries) {
  constexpr int kLargest = kernel::COORDINATE_BITS - 1;
  const Magnitudes both = joined(points, of_queries);
  if (bits_of(both) == 0) return 0;
  if (bits_of(both) <= kernel::COORDINATE_BITS || bits_of(points) == 0) return kLargest - both.largest;
  return std::max(kLargest - std::min(both.largest, points.largest + kPlacesBeyondPoints), -points.lowest);
}

kernel::query_frame fixed_point_frame(int shift, int unit) {
  kernel::query_frame frame{};
  frame.unit = kernel::as_double(static_cast<kernel::uint64>(static_cast<kernel::int64>(unit)));
  frame.shift = shift;
  return frame;
}

// Throws an error that names the one of the queries [first, last) whose magnitude exceeds that of the points
// by more.
[[noreturn]] void throw_range(host::Runtime& runtime, const Buffer<cl_double>& queries, std::size_t first,
                              std::size_t last, const Magnitudes& points, const Magnitudes& of_queries,
                              const QueryLimits& limits) {
  std::vector<double> all(2 * (last - first));
  runtime.read(queries, 2 * first, all.size(), all.data());
  const bool is_fine = points.lowest - of_queries.lowest > of_queries.largest - points.largest;
  const auto found = std::find_if(all.begin(), all.end(), [&](double x) {
    return x != 0 && (is_fine ? lowest_bit(x) == of_queries.lowest : std::ilogb(x) == of_queries.largest);
  });
  const auto i = static_cast<std::size_t>(found - all.begin());
  throw Error(
      ErrorKind::input,
      fmt::format("query {} is too {} to be exact: it has {} = {:.17g}; the bits of points and queries "
                  "together span {} binary places, {} are supported",
                  first + i / 2, is_fine ? "fine" : "far", i % 2 ? "y" : "x", *found,
                  bits_of(joined(points, of_queries)), limits.most_bits()));
}

}  // namespace

QueryScaling query_scaling(const Magnitudes& both, int point_shift, const QueryLimits& limits) {
  int shift = point_shift;
  if (bits_of(both) > 0) {
    if (both.largest + point_shift > limits.largest) shift = limits.largest - both.largest;
    if (both.lowest + point_shift < limits.lowest) shift = limits.lowest - both.lowest;
  }
  QueryScaling scaling;
  scaling.frames.push_back({kernel::scale_of(shift), std::ldexp(1.0, shift - point_shift), 0, 0});
  if (bits_of(both) > kernel::COARSE_QUERY_BITS) {
    scaling.orient_bound = ORIENT_BOUND;
    scaling.nearness_bound = NEARNESS_BOUND;
  }
  return scaling;
}

Fitted<QueryScaling> fixed_point_scaling(const Magnitudes& points, const Magnitudes& of_queries,
                                         int point_shift) {
  const Magnitudes both = joined(points, of_queries);
  const int shift = shift_together(points, of_queries), bits = bits_of(both);
  QueryScaling scaling;
  scaling.frames.push_back(fixed_point_frame(shift, bits_of(points) == 0 ? 0 : shift - point_shift));
  scaling.is_off_grid = bits > kernel::COORDINATE_BITS;
  if (bits > kCoarseBits) {
    scaling.orient_bound = ORIENT_BOUND_FOR(SINGLE_ROUNDOFF);
    scaling.nearness_bound = NEARNESS_BOUND_FOR(SINGLE_ROUNDOFF);
  }
  if (scaling.is_off_grid && (of_queries.lowest + shift < -kernel::FINER_PLACES ||
                              of_queries.largest + shift >= kernel::FARTHER_PLACES)) {
    return TooWide{both};
  }
  return scaling;
}

Fitted<QueryScaling> query_scaling(host::Runtime& runtime, const PointRange& points,
                                   const Buffer<cl_double>& queries,
                                   const std::vector<std::size_t>& query_offsets, const QueryLimits& limits) {
  const std::size_t sets = query_offsets.size() - 1, m = query_offsets.back();
  const Magnitudes of_queries = inspect(runtime, queries, m);
  if (of_queries.bad != kernel::NO_BAD)
    throw_not_finite(runtime, queries, static_cast<std::size_t>(of_queries.bad));
  const bool is_fixed = is_in_fixed_point(runtime);
  Magnitudes both = of_queries;
  for (const Magnitudes& of_set : points.by_set) both = joined(both, of_set);
  if (points.shifts.size() == 1 &&
      bits_of(both) <= (is_fixed ? kernel::COORDINATE_BITS : limits.most_bits())) {
    // Points and queries fit the grid that they share.
    QueryScaling scaling = is_fixed ? *fixed_point_scaling(both, both, points.shifts[0])
                                    : query_scaling(both, points.shifts[0], limits);
    scaling.frames.resize(sets, scaling.frames[0]);
    scaling.both = both;
    return scaling;
  }
  QueryScaling scaling;
  scaling.both = both;
  scaling.frames.reserve(sets);
  const std::vector<Magnitudes> asked_by_set = inspect_sets(runtime, queries, query_offsets);
  for (std::size_t s = 0; s < sets; ++s) {
    both = joined(points.by_set[s], asked_by_set[s]);
    if (bits_of(both) > limits.most_bits()) {
      throw_range(runtime, queries, query_offsets[s], query_offsets[s + 1], points.by_set[s], asked_by_set[s],
                  limits);
    }
  }
  for (std::size_t s = 0; s < sets; ++s) {
    both = joined(points.by_set[s], asked_by_set[s]);
    const Fitted<QueryScaling> of_set =
        is_fixed ? fixed_point_scaling(points.by_set[s], asked_by_set[s], points.shift(s))
                 : query_scaling(both, points.shift(s), limits);
    if (!of_set) return of_set;
    scaling.frames.push_back(of_set->frames[0]);
    scaling.is_off_grid = scaling.is_off_grid || of_set->is_off_grid;
    scaling.orient_bound = std::max(scaling.orient_bound, of_set->orient_bound);
    scaling.nearness_bound = std::max(scaling.nearness_bound, of_set->nearness_bound);
  }
  return scaling;
}

}  // namespace flaunay::points
