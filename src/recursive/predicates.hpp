// The kernels' predicates on the host: the same text (kernels/shared), read as C++.
#pragma once

#include <cmath>
#include <cstring>

#include "input/magnitudes.hpp"

namespace flaunay::recursive {

namespace kernel {

// Types and built-in functions of OpenCL C.
using ulong = unsigned long;
static_assert(sizeof(long) == 8 && sizeof(ulong) == 8, "as in OpenCL C");
struct double2 {
  double x, y;
};
inline double2 operator-(double2 a, double2 b) { return {a.x - b.x, a.y - b.y}; }
inline double2 operator-(double2 a) { return {-a.x, -a.y}; }
using std::fabs;
using std::fma;
inline ulong as_ulong(double x) {
  ulong bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
inline double as_double(ulong bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}
inline ulong as_ulong(long x) { return static_cast<ulong>(x); }
inline long as_long(ulong x) { return static_cast<long>(x); }
inline long convert_long(double x) { return static_cast<long>(x); }
inline double convert_double(long x) { return static_cast<double>(x); }
__extension__ using WideLong = __int128;
__extension__ using WideUlong = unsigned __int128;
inline long mul_hi(long x, long y) { return static_cast<long>(WideLong{x} * y >> 64); }
inline ulong mul_hi(ulong x, ulong y) { return static_cast<ulong>(WideUlong{x} * y >> 64); }

#define PAIR(x, y) (double2{(x), (y)})
#define OUT_OF_LINE [[gnu::noinline]]
#include "shared/hull_height.h"
#include "shared/planar.h"
#undef PAIR
#undef OUT_OF_LINE

}  // namespace kernel

/// (x, y), or (s, u) in a region's frame; see kernels/shared/frame.h.
using Point = kernel::double2;

inline bool operator==(Point a, Point b) { return a.x == b.x && a.y == b.y; }

/// How far a point's projection lies below a chord.
struct Depth {
  double value = 0;  ///< rounded, good to rank points by
  int sign = 0;      ///< exact; from a filter alone it may be UNDECIDED
};

/// Exact signs: the filter first, integers or expansions where it cannot decide.
struct Predicates {
  Bounds bounds{};

  /// Of p below the chord from a to b, all as projected for one line, a's u no greater than b's; with
  /// `planar` of the plane itself. Positive if p lies strictly below. See kernels/shared/hull_height.h.
  Depth depth_filtered(Point a, Point b, Point p, bool planar) const {
    const auto [depth, magnitude] = kernel::hull_depth(a, b, p, planar);
    const double error = bounds.hull * magnitude;
    return {depth, depth > error ? 1 : depth < -error ? -1 : bounds.hull == 0 ? 0 : UNDECIDED};
  }

  /// 1 if a, b, c turn left, -1 right, 0 straight.
  int orient(Point a, Point b, Point c) const { return kernel::orient_sign(a, b, c, bounds.orient); }
  /// 1 if a point left of the edge from a to b, which sees it as `seen`, sees it under a wider angle than
  /// another, which sees it as `other`: it then lies inside the circle through the edge and that one. -1
  /// outside, 0 on it.
  int wider_angle(Point a, Point b, Point p, const kernel::angle& seen, Point other_point,
                  const kernel::angle& other) const {
    const int sign = kernel::angle_compared(seen, other, bounds.circle == 0 ? 0 : ANGLE_BOUND);
    return sign == UNDECIDED ? kernel::circle_exact(a, b, other_point, p) : sign;
  }
  /// 1 if d lies inside the circle through a, b, c (counter-clockwise), -1 outside, 0 on it.
  int circle(Point a, Point b, Point c, Point d) const {
    return kernel::circle_sign(a, b, c, d, bounds.circle);
  }
};

}  // namespace flaunay::recursive
