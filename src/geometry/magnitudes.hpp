// The range of coordinates for which every predicate is exact. All modes have the same limits
// (docs/exactness.md).
#pragma once

#include <cstddef>
#include <vector>

#include "shared/codes.h"
#include "shared/records.h"

namespace flaunay::geometry {

/// The error bounds of the filters; 0 if the coordinates have so few bits that floating point is exact.
using Bounds = kernel::filter_bounds;

/// The magnitudes of all coordinates, in the order of the codes INSPECT_ of kernels/shared/codes.h.
struct Magnitudes {
  int largest = kernel::NO_LARGEST;  ///< the largest exponent of a coordinate, as ilogb returns it
  int lowest = kernel::NO_LOWEST;    ///< the lowest exponent of a set bit of a coordinate
  int bad = kernel::NO_BAD;          ///< the first point that is not finite
};

/// The scaling of coordinates for exact predicates.
struct Scaling {
  int shift = 0;  ///< coordinates are multiplied by 2^shift, which is exact
  Bounds bounds{};

  /// Factors whose product is 2^shift, because 2^shift itself may be beyond the range of doubles.
  kernel::scaling powers() const;
};

/// The exponent of the lowest set bit of x, which must be finite and not 0.
int lowest_bit(double x);

/// Whether n points of these magnitudes are accepted.
bool can_be_exact(const Magnitudes& magnitudes, std::size_t n);

/// Chooses the scaling of n points. Throws Error(input), which names a point, if the magnitudes are not
/// accepted; the coordinates are read in that case only.
Scaling scaling_for(const double* coordinates, std::size_t n, const Magnitudes& magnitudes);

/// Throws Error(usage) unless offsets begin with 0 and do not decrease.
void check_offsets(const std::vector<std::size_t>& offsets);
/// Throws Error(usage) unless offsets begin with 0, do not decrease and end with n.
void check_offsets(const std::vector<std::size_t>& offsets, std::size_t n);

/// Throws Error(usage) if there are points, but the pointer to their coordinates is null.
void check_coordinates(const void* coordinates, std::size_t n);

}  // namespace flaunay::geometry
