// The natural neighbours of a query on the sphere: points that would have a cell beside it.
#pragma once

#include <cstdint>
#include <vector>

#include "space/sphere/walk.hpp"

namespace flaunay::sphere {

/// A point, and what it counts for.
struct Weighed {
  std::int32_t point;
  double weight;
};

/// Weighs the natural neighbours of a query by Sibson's areas or Laplace's edges; see Interpolation. found:
/// the triangle that has the query. The sum of weights is 1 but for rounding. The order of the neighbours,
/// and so every bit of the result, depends on places alone. O(k) for k neighbours, if few are on one circle.
std::vector<Weighed> natural_neighbors(const Walker& walker, const Found& found, Point query,
                                       Interpolation method);

}  // namespace flaunay::sphere
