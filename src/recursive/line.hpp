// Frames and what is placed in them.
#pragma once

#include <cstdint>
#include <vector>

#include "recursive/predicates.hpp"

namespace flaunay::recursive {

/// The line that cuts a region; or with one of the planar axes of kernels/shared/frame.h what takes the lower
/// or the upper hull of a whole set.
struct Line {
  int axis = AXIS_X;
  double q = 0;  ///< the line is s = q

  bool planar() const { return kernel::is_planar(axis); }
  /// (s, u): across the line and along it.
  Point place(Point p) const { return kernel::to_frame(p, axis); }
  /// Whether, of two places of equal u, p projects lower than v.
  bool is_lower(Point p, Point v) const { return kernel::is_lower(p, v, q, planar()); }
};

/// A point in a line's frame.
struct HullPoint {
  std::int32_t id;
  Point place;

  double s() const { return place.x; }
  double u() const { return place.y; }
};

/// Vertices ascending in u.
using Path = std::vector<HullPoint>;

}  // namespace flaunay::recursive
