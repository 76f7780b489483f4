// What coordinates may be, so that every predicate is exact; the same rules for every mode
// (docs/exactness.md).
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <vector>

namespace flaunay {

/// Bounds of the filters; 0 where the input is so coarse that floating point is exact.
struct Bounds {
  double hull = 0;
  double orient = 0;
  double circle = 0;
};

/// What inspecting all coordinates gives.
struct Magnitudes {
  int largest = -10000;                       ///< the largest exponent of a coordinate, as ilogb
  int lowest = 10000;                         ///< the lowest exponent of a set bit of a coordinate
  int bad = std::numeric_limits<int>::max();  ///< the first point that is not finite
};

/// How to make the coordinates fit for exact predicates.
struct Scaling {
  int shift = 0;  ///< multiply by 2^shift, which is exact
  Bounds bounds{};

  /// Factors whose product is 2^shift, which may be no double itself.
  std::array<double, 3> powers() const;
};

/// Exponent of the lowest set bit; x is finite and not 0.
int lowest_bit(double x);

/// Whether n points of these magnitudes are accepted.
bool can_be_exact(const Magnitudes& magnitudes, std::size_t n);

/// Throws Error(input), naming the point, if they are not; the coordinates are needed for that alone.
Scaling scaling_for(const double* coordinates, std::size_t n, const Magnitudes& magnitudes);

/// Throws Error(usage) unless offsets begin with 0 and do not decrease.
void check_offsets(const std::vector<std::size_t>& offsets);
/// The same, and that they end with the number of points.
void check_offsets(const std::vector<std::size_t>& offsets, std::size_t n);

/// Throws Error(usage) if there are points, but no coordinates.
void check_coordinates(const void* coordinates, std::size_t n);

}  // namespace flaunay
