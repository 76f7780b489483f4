// Coordinates as they come from the input.
#ifndef FLAUNAY_COORDINATES_H
#define FLAUNAY_COORDINATES_H

#include "shared/language.h"

// An unsigned number in the order of the double; -0 counts as +0.
static inline ulong orderable(double x) {
  const ulong bits = as_ulong(x + 0.0);
  return bits >> 63 ? ~bits : bits | 0x8000000000000000UL;
}

// Scaling by a power of two, exact by the host's choice; three steps, since the whole power may not be a double.
static inline double scaled(double x, double s0, double s1, double s2) { return ((x * s0) * s1) * s2; }

// Point i of the input, scaled, without negative zeros.
static inline double2 scaled_point(int i, global const double* input, double s0, double s1, double s2) {
  const double2 p = vload2(i, input);
  return (double2)(scaled(p.x, s0, s1, s2) + 0.0, scaled(p.y, s0, s1, s2) + 0.0);
}

#endif
