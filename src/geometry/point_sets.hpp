// The stage `ingest` on the host: checks, scales and sorts points, finds duplicates, and numbers the distinct
// points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/predicates.hpp"

namespace flaunay::geometry {

/// The distinct points by id. The id of a point is its rank in the order of (set, x, y).
struct PointSets {
  std::vector<Point> points;  ///< scaled by a power of two
  std::vector<std::int32_t>
      source;  ///< per id, the smallest index of an input point of its set with these coordinates
  std::vector<std::int32_t> set_offsets;      ///< sets + 1 ids
  std::vector<std::int32_t> representatives;  ///< per input point, an index of the input
  Predicates predicates{};
};

/// Makes point sets. Throws Error(input) for points that are not finite, whose magnitudes differ too much, or
/// that are too many for 32-bit indices; Error(usage) for offsets that decrease or do not begin with 0.
/// O(n log n).
PointSets ingest(const double* coordinates, const std::vector<std::size_t>& offsets);

}  // namespace flaunay::geometry
