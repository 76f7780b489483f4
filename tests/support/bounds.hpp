// The bounds of filters as the library hands them to kernels, for tests of predicates.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <vector>

#include "geometry/magnitudes.hpp"

namespace flaunay::testing {

/// Of coordinates that are finite.
inline geometry::Magnitudes magnitudes_of(const std::vector<double>& coordinates) {
  geometry::Magnitudes magnitudes;
  for (const double x : coordinates) {
    if (x == 0) continue;
    magnitudes.largest = std::max(magnitudes.largest, std::ilogb(x));
    magnitudes.lowest = std::min(magnitudes.lowest, geometry::lowest_bit(x));
  }
  return magnitudes;
}

/// Magnitudes with another coordinate of 53 bits, so that no filter takes them for coarse.
inline geometry::Magnitudes beside_fine_ones(geometry::Magnitudes magnitudes) {
  constexpr int kBits = std::numeric_limits<double>::digits;
  if (magnitudes.lowest > magnitudes.largest) return {0, 1 - kBits};
  const int missing = std::max(0, kBits - (magnitudes.largest - magnitudes.lowest + 1));
  return {magnitudes.largest, magnitudes.lowest - missing};
}

/// Of an input that has points of these magnitudes, which are accepted.
inline geometry::Bounds bounds_for(const geometry::Magnitudes& magnitudes) {
  if (geometry::differ_too_much(magnitudes)) throw std::logic_error("magnitudes that the library refuses");
  return geometry::scaling_for(nullptr, 0, 0, magnitudes).bounds;
}

/// Of an input with coordinates of 53 bits.
inline geometry::Bounds usual_bounds() { return bounds_for(beside_fine_ones({})); }

}  // namespace flaunay::testing
