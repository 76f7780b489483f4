// The blocks of 2 by 2 of the system for gradients (interpolate/gradients.cl), one per vertex.
#ifndef FLAUNAY_INTERPOLATE_BLOCKS_H
#define FLAUNAY_INTERPOLATE_BLOCKS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// inverse: xx, xy and yy of the inverse of the block. Where all edges are on one line but for rounding, it is the
// inverse on that line, 0 across it: no value determines the slope across it.
static inline void invert_block(double xx, double xy, double yy, GLOBAL double* inverse) {
  const double trace = xx + yy, determinant = xx * yy - xy * xy;
  if (determinant > 0x1p-46 * (trace * trace)) {
    inverse[0] = yy / determinant;
    inverse[1] = -xy / determinant;
    inverse[2] = xx / determinant;
  } else {
    inverse[0] = xx / (trace * trace);
    inverse[1] = xy / (trace * trace);
    inverse[2] = yy / (trace * trace);
  }
}

static inline double2 solved(GLOBAL const double* inverse, double x, double y) {
  return VECTOR(double2, inverse[0] * x + inverse[1] * y, inverse[1] * x + inverse[2] * y);
}

END_SHARED

#endif
