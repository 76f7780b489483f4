// The values of orientations and in-circle determinants with a small relative error, however much cancels in them:
// floating point where its bound suffices; else the exact value, rounded.
#ifndef FLAUNAY_DETERMINANTS_H
#define FLAUNAY_DETERMINANTS_H

#include "arithmetic/language.h"
#include "predicates/area.h"
#include "predicates/nearness.h"
#include "predicates/planar.h"

BEGIN_SHARED

// A bound of the relative error. Smaller ones would need the exact value more often.
#define DETERMINANT_ERROR 0x1p-46

static inline int is_accurate(double det, double error) { return error <= DETERMINANT_ERROR * fabs(det); }

OUT_OF_LINE static inline double orient_value_exact(double2 a, double2 b, double2 c) { return area_exact(a, b, c); }

// Twice the area of a, b, c, positive if they turn left.
static inline double orient_value(double2 a, double2 b, double2 c) {
  const double2 area = area_filtered(a, b, c);
  return is_accurate(area.x, ORIENT_BOUND * area.y) ? area.x : orient_value_exact(a, b, c);
}

static inline integer256 negated_256(integer256 x) {
  const integer128 zero = {0, 0}, one = {1, 0};
  integer256 negated;
  negated.low = difference_128(zero, x.low);
  negated.high = difference_128(zero, x.high);
  if ((x.low.low | x.low.high) != 0) negated.high = difference_128(negated.high, one);
  return negated;
}

// Each of the four parts is rounded, and so are their sums.
static inline double double_of_256(integer256 x) {
  const double word = 0x1p64;
  const int is_negative = sign_of_256(x) < 0;
  if (is_negative) x = negated_256(x);
  const double high = (double)x.high.high * word + (double)x.high.low;
  const double magnitude = (high * word + (double)x.low.high) * word + (double)x.low.low;
  return is_negative ? -magnitude : magnitude;
}

OUT_OF_LINE static inline double circle_value_exact(double2 a, double2 b, double2 c, double2 d) {
  const circle_differences from = differences_from(d, a, b, c);
  if (from.largest == 0.0) return 0.0;
  const double factor = unit_factor(from.largest, WIDE_BITS);
  int64 x[3], y[3];
  if (are_integers(&from, factor, x, y)) {
    const double unit = 1.0 / factor;
    return double_of_256(circle_wide(x[0], y[0], x[1], y[1], x[2], y[2])) * unit * unit * unit * unit;
  }
  expansion sum;
  circle_by_expansions(from.x, from.y, &sum);
  return expansion_value(&sum);
}

// The in-circle determinant: positive if d lies inside the circle through a, b, c, which turn left.
static inline double circle_value(double2 a, double2 b, double2 c, double2 d) {
  const double2 ad = a - d, bd = b - d, cd = c - d;
  const double2 det = circle_determinant(ad, bd, cd, squared_length(ad), squared_length(bd), squared_length(cd));
  return is_accurate(det.x, CIRCLE_BOUND * det.y) ? det.x : circle_value_exact(a, b, c, d);
}

END_SHARED

#endif
