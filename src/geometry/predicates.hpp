// The kernels' predicates on the host: the same files (kernels/predicates), compiled as C++.
#pragma once

#include "flattened/hull_height.h"
#include "geometry/magnitudes.hpp"
#include "predicates/planar.h"

namespace flaunay::geometry {

/// A point: (x, y), or (s, u) in the coordinates of a region's cut line; see kernels/flattened/axes.h.
using Point = kernel::double2;

inline bool operator==(Point a, Point b) { return a.x == b.x && a.y == b.y; }

/// The depth of a point's projection below a chord.
struct Depth {
  double value = 0;  ///< rounded; used to rank points
  int sign = 0;      ///< exact; UNDECIDED if only the filter was used and it could not decide
};

/// Predicates with exact signs: a floating-point filter first, and integers or expansions if it cannot
/// decide.
struct Predicates {
  Bounds bounds{};

  /// The depth of p below the chord from a to b, by the filter alone; positive if p lies strictly below. The
  /// points are projections (h, u) for one line, or with `planar` points of the plane; the u of a must not be
  /// greater than that of b. See kernels/flattened/hull_height.h.
  Depth depth_filtered(Point a, Point b, Point p, bool planar) const {
    const auto [depth, magnitude] = kernel::hull_depth(a, b, p, planar);
    const double error = bounds.hull * magnitude;
    return {depth, depth > error ? 1 : depth < -error ? -1 : bounds.hull == 0 ? 0 : UNDECIDED};
  }

  /// 1 if a, b, c turn left, -1 if they turn right, 0 if they are collinear.
  int orient(Point a, Point b, Point c) const { return kernel::orient_sign(a, b, c, bounds.orient); }
  /// Compares the angles under which p and other_point, both left of the edge from a to b, see that edge.
  /// seen, other: these angles. Returns 1 if the angle at p is wider, which means that p lies inside the
  /// circle through a, b and other_point; -1 if it lies outside, 0 if it lies on the circle.
  int wider_angle(Point a, Point b, Point p, const kernel::angle& seen, Point other_point,
                  const kernel::angle& other) const {
    const double bound = kernel::angle_bound(bounds.circle);
    const int sign = kernel::angle_compared(seen, other, bound);
    return sign == UNDECIDED ? kernel::circle_undecided(a, b, other_point, p, bound) : sign;
  }
  /// 1 if d lies inside the circle through a, b, c (counter-clockwise), -1 if outside, 0 if on it.
  int circle(Point a, Point b, Point c, Point d) const {
    return kernel::circle_sign(a, b, c, d, bounds.circle);
  }
};

}  // namespace flaunay::geometry
