// The decisions of refinement on arrays of cases, one case a work-item, for quality_test.cpp.

#include "predicates/quality.h"

// Cases of 8: three points, a squared sine or cosine, an area.
kernel void quality_cases(int n, global const double* restrict cases, global char* restrict decisions) {
  const int i = get_global_id(0);
  if (i < n) {
    global const double* q = cases + 8 * i;
    const double2 a = (double2)(q[0], q[1]), b = (double2)(q[2], q[3]), c = (double2)(q[4], q[5]);
    decisions[4 * i] = is_angle_below(a, b, c, q[6]);
    decisions[4 * i + 1] = is_area_above(a, b, c, q[7]);
    decisions[4 * i + 2] = is_encroached(a, b, c, q[6]);
    decisions[4 * i + 3] = is_sharp(a, b, c);
  }
}
