// The predicates of kernels/predicates as devices without double precision have them (FIXED_POINT), read as
// C++: in namespaces of their own, beside those in double precision. Points are arrays of coordinates, x0 y0
// x1 y1
// ....
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace flaunay::testing {

/// A computed determinant, in units of the integers, and the magnitude that its bound is multiplied with.
struct FilteredValue {
  double value, magnitude;
};

/// A block's rectangle, its infinite sides as COORDINATE_LARGEST, and the box around all points.
struct FixedFrame {
  std::int64_t low[2], high[2], all_low[2], all_high[2];
};

/// How far up a line between two points passes a cut: seams.h.
struct FixedHeight {
  double at_cut, largest, error;
};

/// One reading of the headers.
struct FixedPredicates {
  const char* name;
  float (*real_of)(std::int64_t difference);
  std::int64_t (*rounded_difference)(std::int64_t a, std::int64_t b);
  int (*orient_filtered)(const std::int64_t* p);
  int (*orient_exact)(const std::int64_t* p);
  int (*cross_sign)(const std::int64_t* p);  ///< of p1 - p0 and p3 - p2
  int (*circle_filtered)(const std::int64_t* p);
  int (*circle_exact)(const std::int64_t* p);
  int (*circle_undecided)(const std::int64_t* p);
  int (*circle_canonical)(const std::int64_t* p);
  int (*angle_compared)(const std::int64_t* p);  ///< as circle_filtered
  int (*angle_side)(const std::int64_t* p);      ///< as orient_filtered
  FilteredValue (*orient_value)(const std::int64_t* p);
  FilteredValue (*circle_value)(const std::int64_t* p);
  FilteredValue (*angle_value)(const std::int64_t* p);
  double orient_bound, circle_bound, angle_bound, roundoff;
  bool (*is_circle_inside)(const FixedFrame& frame, const std::int64_t* p);
  bool (*is_half_plane_inside)(const FixedFrame& frame, const std::int64_t* p);
  FixedHeight (*height_at_cut)(const std::int64_t* p, int axis);  ///< of p1 and p2, seen from p0
  std::int64_t (*fixed_point)(std::uint64_t bits, int shift);
  std::uint64_t (*widened_bits)(std::uint32_t bits);
};

const FixedPredicates& fixed_predicates();
/// As a device that contracts products and sums; the same as fixed_predicates where compilers or processors
/// cannot.
const FixedPredicates& fixed_predicates_contracted();

/// Both.
inline std::vector<const FixedPredicates*> all_fixed_predicates() {
  return {&fixed_predicates(), &fixed_predicates_contracted()};
}

/// What certify.h says in double precision of coordinates of at most 53 bits.
bool is_circle_inside_in_doubles(const FixedFrame& frame, const std::int64_t* p);

}  // namespace flaunay::testing
