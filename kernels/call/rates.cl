// How fast a device computes in single and in double precision when all of its lanes are busy: each work-item computes
// a chain of multiplications and additions. One pass each; src/tuning/arithmetic.hpp compares them.
//
// Nothing is ever written, since all x stay positive, which no compiler knows. Loops are unrolled, so that counting
// does not take as long as computing.

#include "arithmetic/language.h"

kernel void compute_in_single(int steps, float factor, global float* restrict result) {
  float x = get_local_id(0);
#pragma unroll 16
  for (int k = 0; k < steps; ++k) x = x * factor + 1.0f;
  if (x < 0.0f) result[0] = x;
}

// Programs for fixed point must not name the type.
#ifndef FIXED_POINT
kernel void compute_in_double(int steps, double factor, global double* restrict result) {
  double x = get_local_id(0);
#pragma unroll 16
  for (int k = 0; k < steps; ++k) x = x * factor + 1.0;
  if (x < 0.0) result[0] = x;
}
#endif
