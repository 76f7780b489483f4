// Regions of a set of points in flat arrays.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace flaunay::geometry {

/// Regions in flat arrays. The id of a point is its rank among the distinct points in the order of (x, y).
struct RegionArrays {
  /// Region r has the internal points points[point_offsets[r]..point_offsets[r + 1]), in ascending order.
  std::vector<std::int32_t> point_offsets;
  std::vector<std::int32_t> points;
  /// Region r has the corners corner_offsets[r]..corner_offsets[r + 1], in any order. A corner is 3 ids: the
  /// border's vertex before, the vertex, the vertex after. The region lies left of the edges between them.
  std::vector<std::int32_t> corner_offsets;
  std::vector<std::int32_t> corners;

  std::size_t size() const { return point_offsets.empty() ? 0 : point_offsets.size() - 1; }
};

}  // namespace flaunay::geometry
