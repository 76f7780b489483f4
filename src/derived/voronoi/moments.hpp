// Areas and centroids of cells.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "geometry/predicates.hpp"

namespace flaunay::voronoi {

using geometry::Point;

struct Moments {
  double area = 0;
  Point centroid{NAN, NAN};
};

/// The moments of a convex polygon, by triangles from its first corner; 0 and NaN if rounding leaves no area.
inline Moments moments_of(const std::vector<Point>& polygon) {
  double twice = 0, x = 0, y = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Point o = polygon[0], p = polygon[k - 1], q = polygon[k];
    const double part = (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
    twice += part;
    x += part * ((p.x - o.x) + (q.x - o.x));
    y += part * ((p.y - o.y) + (q.y - o.y));
  }
  if (!(twice > 0)) return {};
  return {twice / 2, {polygon[0].x + x / (3 * twice), polygon[0].y + y / (3 * twice)}};
}

}  // namespace flaunay::voronoi
