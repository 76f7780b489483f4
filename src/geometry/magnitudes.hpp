// The range of coordinates for which every predicate is exact. All modes have the same limits
// (docs/exactness.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arithmetic/bit_account.h"
#include "arithmetic/coordinates.h"
#include "arithmetic/records.h"
#include "flaunay/flaunay.hpp"
#include "predicates/records.h"

namespace flaunay::geometry {

/// The error bounds of the filters; 0 if the coordinates have so few bits that floating point is exact.
using Bounds = kernel::filter_bounds;

/// The magnitudes of all coordinates, in the order of the codes INSPECT_ of kernels/points/codes.h.
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
  kernel::scaling powers() const { return kernel::scale_of(shift); }
};

/// The magnitudes of the points [first, last). At a point that is not finite it stops. O(last - first).
Magnitudes inspect(const double* coordinates, std::size_t first, std::size_t last);

/// The magnitudes of two sets of points together.
Magnitudes joined(const Magnitudes& a, const Magnitudes& b);

/// The exponent of the lowest set bit of x, which must be finite and not 0.
int lowest_bit(double x);

/// The number of binary places that the coordinates span; 0 if all are 0.
int bits_of(const Magnitudes& magnitudes);

/// Whether the magnitudes of finite points differ too much for one scaling.
bool differ_too_much(const Magnitudes& magnitudes);

/// A coordinate, for messages.
struct NamedCoordinate {
  std::uint64_t point = 0;
  bool is_y = false;
  double value = 0;
};

/// Coordinates that make the range of magnitudes as large as it is.
struct RangeEnds {
  NamedCoordinate largest, finest;
};
/// Finds these coordinates among the points [first, last). Ends that none of them reaches keep defaults.
RangeEnds find_ends(const double* coordinates, std::size_t first, std::size_t last,
                    const Magnitudes& magnitudes);

/// The error for magnitudes that differ too much, and for a point that is not finite.
Error range_error(const NamedCoordinate& largest, const NamedCoordinate& finest,
                  const Magnitudes& magnitudes);
Error not_finite(std::uint64_t point, double x, double y);

/// The scaling for magnitudes that are accepted.
Scaling scaling_for(const Magnitudes& magnitudes);

/// Chooses the scaling of the points [first, last). Throws Error(input), which names a point, if the
/// magnitudes are not accepted; the coordinates are read in that case only.
Scaling scaling_for(const double* coordinates, std::size_t first, std::size_t last,
                    const Magnitudes& magnitudes);

/// Magnitudes of an input that would have to be in fixed point, but does not fit. Such calls are to be made
/// on a device with double precision or on the host.
struct TooWide {
  Magnitudes magnitudes;

  /// Describes the input that does not fit: "coordinates whose bits ...".
  std::string reason() const;
};

/// The return type of a function that may compute in fixed point: its result, or the reason why the input
/// does not fit. With doubles every input fits.
template <typename T>
class [[nodiscard]] Fitted {
 public:
  Fitted(T result) : outcome_(std::move(result)) {}
  Fitted(const TooWide& wide) : outcome_(wide) {}

  explicit operator bool() const { return outcome_.index() == 0; }
  const TooWide& too_wide() const { return std::get<1>(outcome_); }
  const T& operator*() const& { return std::get<0>(outcome_); }
  T&& operator*() && { return std::get<0>(std::move(outcome_)); }
  const T* operator->() const { return &std::get<0>(outcome_); }

 private:
  std::variant<T, TooWide> outcome_;
};

/// The result of a function that returns nothing else.
struct Done {};

/// Whether finite coordinates fit into fixed point, and are cut as doubles are: their differences are finite.
bool fits_fixed_point(const Magnitudes& magnitudes);
/// The power of two by which coordinates that fit are multiplied, so that they have as many bits as can be.
int fixed_point_shift(const Magnitudes& magnitudes);
/// The bounds of filters in fixed point, for points of this many bits (bits_of).
Bounds fixed_point_bounds(int bits);

/// The scaling of several sets of points: the same for all, or if their magnitudes differ too much, one for
/// each.
struct SetScalings {
  Bounds bounds{};          ///< for all sets
  std::vector<int> shifts;  ///< one for all, or one per set

  int shift(std::size_t set) const { return shifts[shifts.size() > 1 ? set : 0]; }
};

/// Chooses the scalings of sets. by_set: their magnitudes. Throws Error(input) if the magnitudes of a set are
/// not accepted; the coordinates are read in that case only.
SetScalings set_scalings(const double* coordinates, const std::vector<std::size_t>& offsets,
                         const std::vector<Magnitudes>& by_set);

/// Chooses the scalings of sets. inspect(first, last) returns the magnitudes of these points.
template <typename Inspect>
SetScalings set_scalings(const double* coordinates, const std::vector<std::size_t>& offsets,
                         const Inspect& inspect) {
  const std::size_t n = offsets.back(), sets = offsets.size() - 1;
  const Magnitudes all = inspect(0, n);
  if (sets < 2 || !differ_too_much(all)) {
    const Scaling scaling = scaling_for(coordinates, 0, n, all);
    return {scaling.bounds, {scaling.shift}};
  }
  std::vector<Magnitudes> by_set;
  by_set.reserve(sets);
  for (std::size_t s = 0; s < sets; ++s) by_set.push_back(inspect(offsets[s], offsets[s + 1]));
  return set_scalings(coordinates, offsets, by_set);
}

}  // namespace flaunay::geometry
