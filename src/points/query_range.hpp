// The range of queries that can be answered exactly for a set of points, and their scaling
// (docs/exactness.md).
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/magnitudes.hpp"
#include "points/device_mesh.hpp"
#include "points/records.h"
#include "predicates/bounds.h"

namespace flaunay::points {

/// The points of a locator before scaling: their magnitudes, by set, and the shifts by which they are scaled.
struct PointRange {
  std::vector<geometry::Magnitudes> by_set;
  std::vector<int> shifts;  ///< the same for all, or one per set

  int shift(std::size_t set) const { return shifts[shifts.size() > 1 ? set : 0]; }
};

/// How queries are scaled.
struct QueryScaling {
  std::vector<kernel::query_frame> frames;  ///< by set
  float orient_bound = 0, nearness_bound = 0;
  /// In fixed point: whether some queries are finer than the grid of their set's points, or farther away than
  /// it reaches. Kernels first answer these for the nearest place of the grid
  /// (kernels/locate/fixed_point.cl).
  bool is_off_grid = false;
  geometry::Magnitudes both{};  ///< of points and queries of all sets
};

/// The range of predicates on points and queries: coordinates are multiples of 2^lowest below 2^(largest +
/// 1).
struct QueryLimits {
  int largest, lowest;

  int most_bits() const { return largest - lowest + 1; }
};
/// Orientations and comparisons of distances.
constexpr QueryLimits kOrientLimits{kernel::LARGEST_QUERY_EXPONENT, kernel::LOWEST_QUERY_EXPONENT};
/// In-circle tests, too.
constexpr QueryLimits kCircleLimits{kernel::LARGEST_EXPONENT, kernel::LOWEST_EXPONENT};

/// Inspects queries and chooses their scaling: the same for all sets, or if magnitudes differ too much, one
/// for each. Waits once, or twice. Throws Error(input), which names a query, if one is not finite, too fine
/// or too far away. In fixed point, queries that are very much finer or farther away than points do not fit.
geometry::Fitted<QueryScaling> query_scaling(host::Runtime& runtime, const PointRange& points,
                                             const host::Buffer<cl_double>& queries,
                                             const std::vector<std::size_t>& query_offsets,
                                             const QueryLimits& limits = kOrientLimits);

/// Chooses the scaling of one set in fixed point.
geometry::Fitted<QueryScaling> fixed_point_scaling(const geometry::Magnitudes& points,
                                                   const geometry::Magnitudes& of_queries, int point_shift);

/// Chooses the scaling of one set with doubles, whose points and queries together have accepted magnitudes.
QueryScaling query_scaling(const geometry::Magnitudes& both, int point_shift,
                           const QueryLimits& limits = kOrientLimits);

}  // namespace flaunay::points
