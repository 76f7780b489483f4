// Which queries can be decided exactly beside a set of points, and how they are scaled for that
// (docs/exactness.md).
#pragma once

#include <array>
#include <cstddef>

#include "derived/mesh.hpp"
#include "input/magnitudes.hpp"

namespace flaunay::derived {

/// Queries are multiplied by 2^shift, points that are scaled already by unit.
struct QueryScaling {
  int shift = 0;
  double unit = 1;
  double orient_bound = 0, nearness_bound = 0;

  std::array<double, 3> powers() const { return Scaling{shift, {}}.powers(); }
};

/// points: their magnitudes as given; point_shift: how they are scaled. Inspects m queries and waits once.
/// Throws Error(input) that names a query that is not finite, too fine or too far.
QueryScaling query_scaling(host::Runtime& runtime, const Magnitudes& points, int point_shift,
                           const Buffer<cl_double>& queries, std::size_t m);

}  // namespace flaunay::derived
