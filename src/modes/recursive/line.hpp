// The cut line of a region, the coordinates relative to it, and points in these coordinates.
#pragma once

#include <cstdint>
#include <vector>

#include "geometry/predicates.hpp"
#include "statistics/counter.hpp"

namespace flaunay::recursive {

/// A point in the coordinates of a line.
struct HullPoint {
  std::int32_t id;
  geometry::Point place;       ///< (s, u)
  geometry::Point projection;  ///< (h, u), rounded; see project in kernels/flattened/hull_height.h

  double s() const { return place.x; }
  double u() const { return place.y; }
  double height() const { return projection.x; }
};

/// The line that cuts a region. With one of the planar axes of kernels/flattened/axes.h, hulls are the lower
/// or the upper hull of the points in the plane.
struct Line {
  int axis = kernel::AXIS_X;
  double q = 0;  ///< the line is s = q

  bool planar() const { return kernel::is_planar(axis); }
  /// The coordinates (s, u) of p, across the line and along it.
  geometry::Point place(geometry::Point p) const { return kernel::to_frame(p, axis); }
  /// The point at this place, with its projection.
  HullPoint at(std::int32_t id, geometry::Point place) const {
    return {id, place, kernel::project(place, q, planar())};
  }
  /// Whether the projection of p is lower than that of v, for two points of equal u.
  bool is_lower(const HullPoint& p, const HullPoint& v) const {
    return kernel::is_lower(p.place, v.place, q, planar());
  }
  /// The depth of p below the chord from a to b. The u of a must not be greater than that of b.
  geometry::Depth depth(const geometry::Predicates& predicates, const HullPoint& a, const HullPoint& b,
                        const HullPoint& p) const {
    geometry::Depth depth = predicates.depth_filtered(a.projection, b.projection, p.projection, planar());
    if (depth.sign == UNDECIDED) {
      depth.sign = kernel::hull_depth_sign(a.place, b.place, p.place, q, planar());
    }
    return depth;
  }
};

/// Vertices ascending in u.
using Path = std::vector<HullPoint>;

/// The points of a region in the coordinates of its line.
struct HullPoints {
  Line line;
  HullPoint first, last;  ///< the ends of the hull: the lowest points with the least and the greatest u
  std::vector<HullPoint> internal;  ///< sorted along the line in either direction
  std::vector<HullPoint> corners;   ///< corners of the border in any order; a vertex may occur several times
};

}  // namespace flaunay::recursive
