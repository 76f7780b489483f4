// Whether two segments cross, and where: compared exactly, and correctly rounded.
#pragma once

#include <algorithm>
#include <cmath>

#include "geometry/predicates.hpp"

namespace flaunay::constrained {

struct Line {
  geometry::Point a, b;
};

/// Whether two segments have exactly one common point, which is inside of both. Each begins with its
/// lexicographically smaller end.
bool cross(const geometry::Predicates& predicates, const Line& p, const Line& q);

/// The sign of x - value at the place where two segments cross, or with `vertical`, of y - value. The value
/// is the sum of two doubles. The segments must cross: have exactly one common point, which is inside of
/// both.
int compare_crossing(const Line& first, const Line& second, bool vertical, kernel::double2 value);

/// The place where two segments cross, rounded to the nearest point whose coordinates are doubles and
/// multiples of a power of two, the unit. If two points are equally near, the one with the even last bit is
/// taken. So the place depends on both lines alone. Coordinates must be multiples of the unit, which is at
/// least 2^-255, and below 2^250.
geometry::Point round_crossing(const Line& first, const Line& second, double unit);

/// A rectangle.
struct Box {
  geometry::Point low, high;
};

/// Whether a segment may have a point whose distance from one of a box is at most `reach` in both
/// coordinates. The answer is yes, too, for some that are a little farther away. reach: at least 2^-50 of the
/// largest magnitude of a coordinate. Then it makes up for the rounding of the cross product, which is less
/// than 7 times 2^-53 of that magnitude times the extents of the segment.
inline bool may_be_near(const Box& box, const Line& segment, double reach) {
  const auto [a, b] = segment;
  if (std::min(a.x, b.x) > box.high.x + reach || std::max(a.x, b.x) < box.low.x - reach ||
      std::min(a.y, b.y) > box.high.y + reach || std::max(a.y, b.y) < box.low.y - reach) {
    return false;
  }
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double x = 0.5 * (box.low.x + box.high.x), y = 0.5 * (box.low.y + box.high.y);
  return std::fabs(dx * (y - a.y) - dy * (x - a.x)) <=
         std::fabs(dx) * (0.5 * (box.high.y - box.low.y) + reach) +
             std::fabs(dy) * (0.5 * (box.high.x - box.low.x) + reach);
}

}  // namespace flaunay::constrained
