// The range of queries that can be answered exactly for a set of points, and their scaling
// (docs/exactness.md).
#pragma once

#include <cstddef>

#include "geometry/magnitudes.hpp"
#include "points/device_mesh.hpp"

namespace flaunay::locate {

using namespace geometry;
using namespace points;

/// Queries are multiplied by 2^shift, and points, which are scaled already, by `unit`.
struct QueryScaling {
  int shift = 0;
  double unit = 1;
  double orient_bound = 0, nearness_bound = 0;

  kernel::scaling powers() const { return Scaling{shift, {}}.powers(); }
};

/// Inspects m queries and chooses their scaling. points: the magnitudes of the points before scaling;
/// point_shift: their scaling. Waits once. Throws Error(input), which names a query, if one is not finite,
/// too fine or too far away.
QueryScaling query_scaling(host::Runtime& runtime, const Magnitudes& points, int point_shift,
                           const Buffer<cl_double>& queries, std::size_t m);

/// Chooses the scaling for accepted magnitudes of points and queries together.
QueryScaling query_scaling(const Magnitudes& both, int point_shift);

}  // namespace flaunay::locate
