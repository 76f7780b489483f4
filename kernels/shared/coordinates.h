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

#endif
