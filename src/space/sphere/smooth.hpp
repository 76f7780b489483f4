// Interpolation on the sphere with a continuous gradient.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "space/sphere/measures.hpp"
#include "space/sphere/walk.hpp"

namespace flaunay::sphere {

/// Estimates gradients as interpolate::estimate does in the plane: the curvature along all arcs of triangles
/// that are seen is least. Returns x, y and z per number, of a vector that is tangent to the sphere; NaN at
/// points that are no corners of these. O(t columns) per iteration.
std::vector<double> estimate_gradients(host::Runtime& runtime, const Walker& walker,
                                       const Triangulation& mesh, const double* values, std::size_t columns,
                                       std::size_t iterations);

/// A place in a triangle, where values are interpolated from those and from gradients at the corners (Renka,
/// 1984): a mean of three cubics along great circles, each from a corner by the place to the opposite arc. On
/// an arc there is a cubic, too, and the slope across it is linear, so that triangles fit together.
class SmoothPlace {
 public:
  SmoothPlace(const Walker& walker, const Found& found, Point query);
  double value(const std::array<double, 3>& values, const std::array<Direction, 3>& gradients) const;

 private:
  // A part of a great circle: its length, the tangents at both ends, and the share of it before a place.
  struct Arc {
    double length, share;
    Direction begin, end;
  };
  static Arc arc(const Direction& from, const Direction& to, const Direction& chord, const Direction& place);

  // One per corner. `opposite` is the arc opposite to it, across which `normal` leads, and where it is met
  // `tangent` along it.
  std::array<double, 3> weights_{};
  std::array<Arc, 3> opposite_{}, along_{};
  std::array<Direction, 3> normal_{}, tangent_{};
  std::ptrdiff_t corner_;  // whose value counts; -1 elsewhere
};

}  // namespace flaunay::sphere
