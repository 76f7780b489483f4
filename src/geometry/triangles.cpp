#include "geometry/triangles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/arguments.hpp"
#include "geometry/magnitudes.hpp"
#include "predicates/area.h"
#include "predicates/rounded_area.h"

namespace flaunay::geometry {
namespace {

using kernel::double2;

// A vector, each coordinate as a double and the part that rounding has cut off.
struct Side {
  double2 x, y;
  Side(Point from, Point to) : x(kernel::two_sum(to.x, -from.x)), y(kernel::two_sum(to.y, -from.y)) {}
  double size() const { return std::max(std::fabs(x.x), std::fabs(y.x)); }
  void scale(int exponent) {
    for (double* part : {&x.x, &x.y, &y.x, &y.y}) *part = std::ldexp(*part, exponent);
  }
  // Exact for coordinates of few bits.
  double square() const { return x.x * x.x + y.x * y.x; }
};

// The cross product of two sides, rounded from twice the precision.
double twofold_cross(const Side& u, const Side& v) {
  const double2 left = kernel::two_product(u.x.x, v.y.x), right = kernel::two_product(u.y.x, -v.x.x);
  const double2 sum = kernel::two_sum(left.x, right.x);
  const double crossed = (u.x.x * v.y.y + u.x.y * v.y.x) + (u.y.x * -v.x.y + u.y.y * -v.x.x);
  return sum.x + (sum.y + ((left.y + right.y) + crossed));
}

// A point turned by a right angle to the left about the origin.
Point turned(Point p) { return {-p.y, p.x}; }

// Where terms cancel to less than these parts of their magnitude, doubles lose too many bits, and twice the
// precision, in which products may underflow, too.
constexpr double kCancelled = 0x1p-4, kCancelledTwofold = 0x1p-50, kUnderflow = 1e-300;

}  // namespace

Triangles::Triangles(const double* coordinates, std::size_t n, const std::vector<std::int32_t>& corners)
    : coordinates_(coordinates), corners_(corners) {
  check_points(coordinates, n);
  const Scaling scaling = scaling_for(coordinates, 0, n, inspect(coordinates, 0, n));
  shift_ = scaling.shift;
  scale_ = scaling.powers();
  predicates_.bounds = scaling.bounds;
}

Point Triangles::point(std::int32_t i) const { return kernel::scaled_point(i, coordinates_, scale_); }

int Triangles::turn(std::size_t t) const {
  return predicates_.orient(corner(t, 0), corner(t, 1), corner(t, 2));
}

double Triangles::area(std::size_t t) const {
  const std::int32_t* const corner = &corners_[3 * t];
  const auto* const bits = reinterpret_cast<const kernel::double_bits*>(coordinates_);
  return kernel::as_double(kernel::rounded_area(bits, corner[0], corner[1], corner[2]));
}

int Triangles::angle(std::size_t t, int k) const {
  // A dot product is a cross product with one of the vectors turned.
  const Point here = corner(t, k);
  return kernel::cross_sign(here, corner(t, k + 1), turned(here), turned(corner(t, k + 2)));
}

double Triangles::circumradius(std::size_t t) const {
  const Point a = corner(t, 0), b = corner(t, 1), c = corner(t, 2);
  Side u(a, b), v(a, c), w(b, c);
  int exponent = 0;
  std::frexp(std::max(u.size(), v.size()), &exponent);
  // Sides of about 1 neither overflow nor underflow.
  for (Side* side : {&u, &v, &w}) side->scale(-exponent);
  const double left = u.x.x * v.y.x, right = u.y.x * v.x.x;
  const double magnitude = std::fabs(left) + std::fabs(right);
  double cross = left - right;
  if (std::fabs(cross) < kCancelled * magnitude) {
    cross = twofold_cross(u, v);
    if (std::fabs(cross) < kCancelledTwofold * magnitude + kUnderflow) {
      cross = std::ldexp(kernel::area_exact(b, c, a), -2 * exponent);
    }
  }
  const double product = std::sqrt(u.square() * v.square() * w.square());
  const double radius = std::ldexp(product / (2 * std::fabs(cross)), exponent - shift_);
  // No length over no area.
  return std::isnan(radius) ? std::numeric_limits<double>::infinity() : radius;
}

int Triangles::circle(std::size_t t, std::size_t halfedge) const {
  const int direction = turn(t);
  if (direction == 0) return 1;
  const Point beyond = corner(halfedge / 3, static_cast<int>(halfedge % 3) + 2);
  const int second = direction > 0 ? 1 : 2;
  return predicates_.circle(corner(t, 0), corner(t, second), corner(t, 3 - second), beyond);
}

bool Triangles::have_same_circle(std::size_t t, std::size_t other) const {
  const std::int32_t* const mine = &corners_[3 * t];
  int k = 0;
  while (k < 2 && std::find(mine, mine + 3, corners_[3 * other + k]) != mine + 3) ++k;
  return predicates_.circle(corner(t, 0), corner(t, 1), corner(t, 2), corner(other, k)) == 0;
}

void find_same_circles(const Triangles& triangles, const std::vector<std::int32_t>& neighbors,
                       std::int32_t* first) {
  const auto count = static_cast<std::int32_t>(triangles.size());
  const auto find = [first](std::int32_t t) {
    while (first[t] != t) t = first[t] = first[first[t]];
    return t;
  };
  for (std::int32_t t = 0; t < count; ++t) {
    first[t] = t;
    for (std::size_t h = 3 * std::size_t(t); h < 3 * std::size_t(t) + 3; ++h) {
      const std::int32_t other = neighbors[h];
      if (other < 0 || other > t || !triangles.have_same_circle(t, other)) continue;
      const std::int32_t one = find(t), two = find(other);
      first[std::max(one, two)] = std::min(one, two);
    }
  }
  for (std::int32_t t = 0; t < count; ++t) first[t] = first[first[t]];
}

}  // namespace flaunay::geometry
