// Lengths and areas on the sphere, rounded.
#pragma once

#include "space/sphere/places.hpp"

namespace flaunay::sphere {

inline double square_of(double x, double y) { return x * x + y * y; }
inline Direction operator*(double factor, const Direction& v) {
  return {factor * v.x, factor * v.y, factor * v.z};
}
inline Direction operator+(const Direction& a, const Direction& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Direction normalized(const Direction& v) {
  const double length = std::sqrt(dot(v, v));
  return {v.x / length, v.y / length, v.z / length};
}

/// From a to b in space, times a positive number: accurate also if they are near each other.
inline Direction chord(Point a, Point b) {
  // Starts from the one that is nearer to the origin, beside which nothing cancels.
  if (square_of(a.x, a.y) > square_of(b.x, b.y)) return Direction{0, 0, 0} - chord(b, a);
  if (is_pole(b)) return {-a.x, -a.y, -1};
  const double x = b.x - a.x, y = b.y - a.y, scale = 1 + a.x * a.x + a.y * a.y;
  const double square = x * (a.x + b.x) + y * (a.y + b.y);  // |b|^2 - |a|^2
  return {x * scale - a.x * square, y * scale - a.y * square, -square};
}

/// From a to b in space, with the length of the chord.
inline Direction whole_chord(Point a, Point b) {
  const auto stretched = [](Point p) { return is_pole(p) ? 1 : 1 + square_of(p.x, p.y); };
  return 2 / (stretched(a) * stretched(b)) * chord(a, b);
}

inline double angle_of_chord(const Direction& chord) {
  const double square = dot(chord, chord);
  return 2 * std::atan2(std::sqrt(square), std::sqrt(std::fmax(4 - square, 0)));
}

/// Vectors of unit length, across a unit vector and across each other.
struct Frame {
  explicit Frame(const Direction& up) {
    const Direction axis = std::fabs(up.z) < 0.5 ? Direction{0, 0, 1} : Direction{1, 0, 0};
    across = normalized(cross(axis, up));
    along = cross(up, across);
  }
  /// A vector whose share of the third axis is known.
  Direction seen(const Direction& v, double up) const { return {dot(v, across), dot(v, along), up}; }

  Direction across, along;
};

/// A sum of signed areas of triangles of unit vectors. Half of a triangle's area is the angle of a complex
/// number (Eriksson, 1990), and a sum of angles that of a product, so that most cells need one arctangent.
class AreaSum {
 public:
  void add(const Direction& a, const Direction& b, const Direction& c) {
    // A quarter, so that no product is beyond 1.
    const double y = dot(a, cross(b - a, c - a)) / 4, x = (1 + dot(a, b) + dot(b, c) + dot(c, a)) / 4;
    if (x < kLeast) {
      angle_ += std::atan2(y, x);
      return;
    }
    const double before = x_;
    x_ = x_ * x - y_ * y;
    y_ = before * y + y_ * x;
    // Both angles were less than a right one, so that their sum is less than half a turn.
    if (x_ < kLeast) take_angle();
  }
  double total() {
    take_angle();
    return 2 * angle_;
  }

 private:
  static constexpr double kLeast = 1.0 / 16;

  void take_angle() {
    angle_ += std::atan2(y_, x_);
    x_ = 1;
    y_ = 0;
  }

  double angle_ = 0, x_ = 1, y_ = 0;
};

}  // namespace flaunay::sphere
