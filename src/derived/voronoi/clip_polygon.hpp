// The convex polygon to which Voronoi cells are clipped.
#pragma once

#include <cstddef>
#include <vector>

#include "geometry/magnitudes.hpp"

namespace flaunay::voronoi {

/// A convex polygon, counter-clockwise, without corners on the line through their neighbours.
struct ClipPolygon {
  std::vector<double> corners;  ///< x0 y0 x1 y1 ..., as the caller gave them
  geometry::Magnitudes magnitudes;

  std::size_t size() const { return corners.size() / 2; }
};

/// Checks a polygon of `count` corners and leaves out those on the line through their neighbours. Throws
/// Error(usage) for a null pointer and Error(input), which names a corner, if there are fewer than three or
/// more than 16,383, if one is not finite, or if the polygon is not convex and counter-clockwise. All that is
/// decided exactly. O(count).
ClipPolygon checked_polygon(const double* corners, std::size_t count);

/// The scaling of points and a polygon together. Throws Error(input), which names a corner of the polygon, if
/// their magnitudes differ too much.
geometry::Scaling scaling_with(const ClipPolygon& polygon, const geometry::Magnitudes& points);

}  // namespace flaunay::voronoi
