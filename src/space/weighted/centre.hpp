// Corners of power cells.
#pragma once

#include <array>
#include <cmath>

#include "arithmetic/exact_arithmetic.h"
#include "geometry/predicates.hpp"

namespace flaunay::weighted {

/// Where the powers to three points are equal, which turn left, by determinants that are exact until they are
/// rounded, as seen from the first one.
inline geometry::Point power_centre(geometry::Point a, geometry::Point b, geometry::Point c,
                                    const std::array<double, 3>& weights) {
  using geometry::Point;
  const Point ab = {b.x - a.x, b.y - a.y}, ac = {c.x - a.x, c.y - a.y};
  const double left = ab.x * ac.y, right = ab.y * ac.x, area = left - right;
  const double b_square = ab.x * ab.x + ab.y * ab.y, c_square = ac.x * ac.x + ac.y * ac.y;
  const double b_lighter = weights[0] - weights[1], c_lighter = weights[0] - weights[2];
  const double b_lift = b_square + b_lighter, c_lift = c_square + c_lighter;
  const double b_size = b_square + std::fabs(b_lighter), c_size = c_square + std::fabs(c_lighter);
  const Point lever = {ac.y * b_lift - ab.y * c_lift, ab.x * c_lift - ac.x * b_lift};
  const double terms =
      (std::fabs(ac.x) + std::fabs(ac.y)) * b_size + (std::fabs(ab.x) + std::fabs(ab.y)) * c_size;
  // As in voronoi/voronoi.cl.
  constexpr double kCancelled = 4096;
  if (std::fabs(left) + std::fabs(right) <= kCancelled * area &&
      terms <= kCancelled * (std::fabs(lever.x) + std::fabs(lever.y)))
    return {a.x + lever.x / (2 * area), a.y + lever.y / (2 * area)};
  using kernel::double2;
  using kernel::two_sum;
  const double2 bx = two_sum(b.x, -a.x), by = two_sum(b.y, -a.y), cx = two_sum(c.x, -a.x),
                cy = two_sum(c.y, -a.y);
  const double2 b_weight = two_sum(weights[0], -weights[1]), c_weight = two_sum(weights[0], -weights[2]);
  kernel::expansion sum;
  kernel::expansion_cross(bx, by, cx, cy, &sum);
  kernel::expansion_compress(&sum);
  const double twice = 2 * kernel::expansion_value(&sum);
  // sum += f (|g|^2 + weight).
  const auto add_lifted = [&](double2 f, double2 gx, double2 gy, double2 lighter) {
    const double2 x[2] = {gx, gx}, y[2] = {gy, gy};
    kernel::expansion_add_products(&sum, f, x, 2);
    kernel::expansion_add_products(&sum, f, y, 2);
    kernel::expansion_add_products(&sum, f, &lighter, 1);
  };
  const auto negated = [](double2 f) { return double2{-f.x, -f.y}; };
  const auto quotient = [&](double2 f, double2 g) {
    sum.size = 0;
    add_lifted(f, bx, by, b_weight);
    add_lifted(g, cx, cy, c_weight);
    return kernel::expansion_value(&sum) / twice;
  };
  return {a.x + quotient(cy, negated(by)), a.y + quotient(negated(cx), bx)};
}

}  // namespace flaunay::weighted
