// Coordinates as they come from the input.
#ifndef FLAUNAY_COORDINATES_H
#define FLAUNAY_COORDINATES_H

#include "shared/language.h"
#include "shared/records.h"

BEGIN_SHARED

// An unsigned number in the order of the double; -0 counts as +0.
static inline ulong orderable(double x) {
  const ulong bits = as_ulong(x + 0.0);
  return bits >> 63 ? ~bits : bits | 0x8000000000000000UL;
}

INTEGER_CONSTANT(DOUBLE_BITS, 53);  // of a normal number

static inline double power_of_two(int exponent) { return as_double((ulong)(1023 + exponent) << 52); }

// The scale 2^shift, by factors that are doubles.
static inline scaling scale_of(int shift) {
  const int first = shift / 3, second = (shift - first) / 2;
  const scaling scale = {power_of_two(first), power_of_two(second), power_of_two(shift - first - second)};
  return scale;
}

// Exact by the host's choice of the scale.
static inline double scaled(double x, scaling scale) { return ((x * scale.s0) * scale.s1) * scale.s2; }

// Point i of the input, scaled, without negative zeros.
static inline double2 scaled_point(int i, GLOBAL const double* input, scaling scale) {
  const double2 p = vload2(i, input);
  return VECTOR(double2, scaled(p.x, scale) + 0.0, scaled(p.y, scale) + 0.0);
}

END_SHARED

#endif
