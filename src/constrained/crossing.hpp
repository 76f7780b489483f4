// Whether two segments cross, and where: compared exactly, and correctly rounded.
#pragma once

#include "geometry/predicates.hpp"

namespace flaunay::constrained {

using namespace geometry;

struct Line {
  Point a, b;
};

/// Whether two segments have exactly one common point, which is inside of both. Each begins with its
/// lexicographically smaller end.
bool cross(const Predicates& predicates, const Line& p, const Line& q);

/// The sign of x - value at the place where two segments cross, or with `vertical`, of y - value. The value
/// is the sum of two doubles. The segments must cross: have exactly one common point, which is inside of
/// both.
int compare_crossing(const Line& first, const Line& second, bool vertical, kernel::double2 value);

/// The place where two segments cross, rounded to the nearest point whose coordinates are doubles and
/// multiples of a power of two, the unit. Of two that are equally near, the one with the even last bit is
/// taken. So the place is a function of both lines alone. Coordinates must be multiples of the unit, which is
/// at least 2^-255, and below 2^250.
Point round_crossing(const Line& first, const Line& second, double unit);

}  // namespace flaunay::constrained
