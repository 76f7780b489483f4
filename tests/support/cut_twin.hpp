// The twin of the stage `cut`: where a region is cut, and where its path begins and ends.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "tests/support/exact_points.hpp"
#include "tests/support/regions.hpp"

namespace flaunay::testing {

/// alternate_axis: 0 or 1, or -1 for the longer interquartile range (as rounded to double).
inline Frame cut_twin(const ExactPoints& points, const Region& region, int alternate_axis) {
  const std::size_t count = region.x_list.size();
  Frame frame;
  frame.axis = alternate_axis;
  if (alternate_axis < 0) {
    const double x_range = points[region.x_list[3 * count / 4]].s[0] - points[region.x_list[count / 4]].s[0];
    const double y_range = points[region.y_list[3 * count / 4]].s[1] - points[region.y_list[count / 4]].s[1];
    frame.axis = y_range > x_range ? 1 : 0;
  }
  frame.q = frame.axis == 0 ? points[region.x_list[count / 2]].s[0] : points[region.y_list[count / 2]].s[1];
  return frame;
}

/// The border vertices of smallest and of largest u, the lowest of each.
inline std::pair<int, int> ends_twin(const ExactPoints& points, const Frame& frame, const Region& region) {
  std::vector<int> vertices;
  for (const Corner& corner : region.corners) vertices.push_back(corner.vertex);
  const std::vector<int> by_u = points.lowest_by_u(frame, vertices);
  return {by_u.front(), by_u.back()};
}

}  // namespace flaunay::testing
