// Exact orientation and in-circle tests of points in fixed point: their differences are integers below 2^63.
#ifndef FLAUNAY_EXACT_INTEGERS_H
#define FLAUNAY_EXACT_INTEGERS_H

#include "arithmetic/integer_arithmetic.h"
#include "arithmetic/language.h"
#include "arithmetic/numbers.h"
#include "predicates/bounds.h"
#include "predicates/circle_integers.h"

#ifdef FIXED_POINT

BEGIN_SHARED

// The sign of the cross product of b - a and d - c, which is below 2^127.
static inline int cross_exact(coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d) {
  return sign_of_128(cross_product(b.x - a.x, b.y - a.y, d.x - c.x, d.y - c.y));
}

OUT_OF_LINE static inline int orient_exact(coordinate2 a, coordinate2 b, coordinate2 c) {
  return cross_exact(a, b, a, c);
}

// Differences of three points from the fourth, without their common factor 2^k, and how many bits the largest has.
typedef struct {
  int64 x[3], y[3];
  int bits;
} circle_differences;

static inline circle_differences differences_from(coordinate2 d, coordinate2 a, coordinate2 b, coordinate2 c) {
  circle_differences from = {{a.x - d.x, b.x - d.x, c.x - d.x}, {a.y - d.y, b.y - d.y, c.y - d.y}, 0};
  uint64 magnitudes = 0, all = 0;
  for (int k = 0; k < 3; ++k) {
    all |= as_ulong(from.x[k] | from.y[k]);
    magnitudes |= as_ulong(from.x[k] < 0 ? -from.x[k] : from.x[k]) | as_ulong(from.y[k] < 0 ? -from.y[k] : from.y[k]);
  }
  if (all == 0) return from;
  const int common = 63 - (int)clz(all & (~all + 1));
  from.bits = 64 - (int)clz(magnitudes) - common;
  for (int k = 0; k < 3; ++k) {
    from.x[k] >>= common;
    from.y[k] >>= common;
  }
  return from;
}

static inline int circle_sign_wide(const circle_differences* from) {
  return sign_of_256(circle_wide(from->x[0], from->y[0], from->x[1], from->y[1], from->x[2], from->y[2]));
}

#define NOT_SHORT 2
static inline int circle_if_short(const circle_differences* from) {
  if (from->bits > SHORT_BITS) return NOT_SHORT;
  return circle_short(from->x[0], from->y[0], from->x[1], from->y[1], from->x[2], from->y[2]);
}

// The in-circle test of coarse points (COARSE_FIXED_BITS), whose lowest COARSE_ZEROS bits are 0.
INTEGER_CONSTANT(COARSE_ZEROS, COORDINATE_BITS - COARSE_FIXED_BITS);
static inline int circle_coarse(coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d) {
  return circle_short((a.x - d.x) >> COARSE_ZEROS, (a.y - d.y) >> COARSE_ZEROS, (b.x - d.x) >> COARSE_ZEROS,
                      (b.y - d.y) >> COARSE_ZEROS, (c.x - d.x) >> COARSE_ZEROS, (c.y - d.y) >> COARSE_ZEROS);
}

// 1 if d lies inside the circle through a, b, c (counter-clockwise), -1 outside, 0 on it.
OUT_OF_LINE static inline int circle_exact(coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d) {
  const circle_differences from = differences_from(d, a, b, c);
  const int sign = circle_if_short(&from);
  return sign != NOT_SHORT ? sign : circle_sign_wide(&from);
}

// The largest differences of circle_middle where a filter could not decide: then the determinant is below 2^127, see
// docs/exactness.md.
#define MIDDLE_BITS 35

// circle_exact, faster, of points for which circle_filtered or angle_compared could not decide with this bound. A bound
// that is larger than theirs says nothing about the determinant.
OUT_OF_LINE static inline int circle_undecided(coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d,
                                               filter_bound bound) {
  const circle_differences from = differences_from(d, a, b, c);
  const int sign = circle_if_short(&from);
  if (sign != NOT_SHORT) return sign;
  return bound > ANGLE_BOUND || from.bits > MIDDLE_BITS
             ? circle_sign_wide(&from)
             : circle_middle(from.x[0], from.y[0], from.x[1], from.y[1], from.x[2], from.y[2]);
}

END_SHARED

#endif

#endif
