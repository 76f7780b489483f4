// Frames and what is placed in them.
#pragma once

#include <cstdint>
#include <vector>

#include "recursive/predicates.hpp"

namespace flaunay::recursive {

/// A point in a line's frame.
struct HullPoint {
  std::int32_t id;
  Point place;       ///< (s, u)
  Point projection;  ///< (h, u), rounded; see project in kernels/shared/hull_height.h

  double s() const { return place.x; }
  double u() const { return place.y; }
  double height() const { return projection.x; }
};

/// The line that cuts a region; or with one of the planar axes of kernels/shared/frame.h what takes the lower
/// or the upper hull of a whole set.
struct Line {
  int axis = AXIS_X;
  double q = 0;  ///< the line is s = q

  bool planar() const { return kernel::is_planar(axis); }
  /// (s, u): across the line and along it.
  Point place(Point p) const { return kernel::to_frame(p, axis); }
  /// What is at a place of the frame, projected.
  HullPoint at(std::int32_t id, Point place) const {
    return {id, place, kernel::project(place, q, planar())};
  }
  /// Whether, of two points of equal u, p projects lower than v.
  bool is_lower(const HullPoint& p, const HullPoint& v) const {
    return kernel::is_lower(p.place, v.place, q, planar());
  }
  /// Of p below the chord from a to b, a's u no greater than b's.
  Depth depth(const Predicates& predicates, const HullPoint& a, const HullPoint& b,
              const HullPoint& p) const {
    Depth depth = predicates.depth_filtered(a.projection, b.projection, p.projection, planar());
    if (depth.sign == UNDECIDED) {
      depth.sign = kernel::hull_depth_sign(a.place, b.place, p.place, q, planar());
    }
    return depth;
  }
};

/// Vertices ascending in u.
using Path = std::vector<HullPoint>;

/// The points of a region in the frame of its line.
struct HullPoints {
  Line line;
  HullPoint first, last;  ///< the hull's ends: least and greatest u, the lower of these if there are several
  std::vector<HullPoint> internal;  ///< sorted along the line, either way
  std::vector<HullPoint> corners;   ///< of the border, in any order, a vertex perhaps more than once
};

}  // namespace flaunay::recursive
