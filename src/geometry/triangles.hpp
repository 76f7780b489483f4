// Exact tests of single triangles: their turns, angles and circumcircles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/predicates.hpp"

namespace flaunay::geometry {

/// Triangles of points that are scaled so that predicates are exact. Refers to the arrays that it is made of.
class Triangles {
 public:
  /// corners: 3 indices of points per triangle. Throws Error(input) for points that are not finite or whose
  /// magnitudes differ too much. O(n).
  Triangles(const double* coordinates, std::size_t n, const std::vector<std::int32_t>& corners);

  std::size_t size() const { return corners_.size() / 3; }

  /// 1 if the corners of triangle t turn left, -1 if they turn right, 0 if they are collinear.
  int turn(std::size_t t) const;
  /// The area, rounded to the nearest double; negative if the corners turn right.
  double area(std::size_t t) const;
  /// 1 if the angle at corner k of triangle t is acute, -1 if it is obtuse, 0 if it is right.
  int angle(std::size_t t, int k) const;
  /// The radius of the circumcircle, with a relative error below 2^-45: infinite if it exceeds all doubles,
  /// or if the corners are collinear.
  double circumradius(std::size_t t) const;
  /// 1 if the vertex opposite to this halfedge, 3 to a triangle, lies inside the circumcircle of triangle t,
  /// or if the corners of t are collinear; -1 if it lies outside, 0 if on it.
  int circle(std::size_t t, std::size_t halfedge) const;
  /// Whether two triangles with a common edge have the same circumcircle.
  bool have_same_circle(std::size_t t, std::size_t other) const;

 private:
  Point point(std::int32_t i) const;
  Point corner(std::size_t t, int k) const { return point(corners_[3 * t + k % 3]); }

  const double* coordinates_;
  const std::vector<std::int32_t>& corners_;
  int shift_ = 0;
  kernel::scaling scale_{};
  Predicates predicates_{};
};

/// Writes for each triangle the smallest one that has the same circumcircle and is connected to it by
/// triangles that have it, too. neighbors: the triangle opposite to each corner, -1 for none. O(t).
void find_same_circles(const Triangles& triangles, const std::vector<std::int32_t>& neighbors,
                       std::int32_t* first);

}  // namespace flaunay::geometry
