// The angles of triangles in degrees, rounded, for reports.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace flaunay::constrained {

/// Corners relative to each other. Squares of their differences must be neither too large nor too small for
/// doubles: coordinates are scaled before.
struct Shape {
  Shape(const double* coordinates, const std::int32_t* corners) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double* const p = coordinates + 2 * static_cast<std::size_t>(corners[(k + 1) % 3]);
      const double* const q = coordinates + 2 * static_cast<std::size_t>(corners[(k + 2) % 3]);
      sides[k] = {q[0] - p[0], q[1] - p[1]};
    }
  }
  double doubled_area() const { return sides[0][0] * sides[1][1] - sides[0][1] * sides[1][0]; }
  /// The product of the two sides at a corner.
  double product(std::size_t corner) const {
    const auto &p = sides[(corner + 1) % 3], &q = sides[(corner + 2) % 3];
    return -(p[0] * q[0] + p[1] * q[1]);
  }
  std::array<std::array<double, 2>, 3> sides;  ///< opposite to the corners
};

/// The angles of triangles that are added one after the other. All values are 0 without triangles.
class Angles {
 public:
  /// The mean takes as long as all other values together.
  explicit Angles(bool with_mean) : with_mean_(with_mean) {}

  void add(const double* coordinates, const std::int32_t* corners) {
    const Shape shape(coordinates, corners);
    const double scale = 1 / shape.doubled_area();
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
      const double cotangent = shape.product(k) * scale;
      most = std::max(most, cotangent);
      least_ = std::min(least_, cotangent);
    }
    most_ = std::max(most_, most);
    if (with_mean_) sum_ += degrees(most);
    ++count_;
  }
  /// Adds all triangles of another object.
  void add(const Angles& others) {
    most_ = std::max(most_, others.most_);
    least_ = std::min(least_, others.least_);
    sum_ += others.sum_;
    count_ += others.count_;
  }
  double smallest() const { return count_ > 0 ? degrees(most_) : 0; }
  double largest() const { return count_ > 0 ? degrees(least_) : 0; }
  /// The mean of the triangles' smallest angles; 0 unless it was requested.
  double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0; }

 private:
  static double degrees(double cotangent) { return std::atan2(1, cotangent) * 180 / std::acos(-1.0); }

  // The angles' cotangents.
  double most_ = -std::numeric_limits<double>::infinity(), least_ = -most_, sum_ = 0;
  std::size_t count_ = 0;
  bool with_mean_;
};

}  // namespace flaunay::constrained
