// End game, exact: the small regions that floating point could not decide; see endgame.cl.

#include "shared/region_triangles.h"

static inline int orient_decided(double2 a, double2 b, double2 c, double bound) {
  const int sign = orient_filtered(a, b, c, bound);
  return sign != UNDECIDED ? sign : orient_exact(a, b, c);
}

static inline int circle_decided(double2 a, double2 b, double2 c, double2 d, double bound) {
  const int sign = circle_filtered(a, b, c, d, bound);
  return sign != UNDECIDED ? sign : circle_exact(a, b, c, d);
}

REGION_TRIANGLES(triangles_exact, orient_decided, circle_decided)

kernel void small_regions_exact(global const uint* restrict count, global const int* restrict list,
                                double orient_bound, double circle_bound, global const int* restrict offsets,
                                global const double2* restrict points, global int* corners,
                                global uint* restrict counts, global volatile int* restrict broken) {
  const int length = count[0];
  for (int k = get_global_id(0); k < length; k += get_global_size(0)) {
    const int r = list[k];
    const int low = offsets[r];
    const int total = triangles_exact(corners + 3 * low, offsets[r + 1] - low, points, orient_bound, circle_bound,
                                      corners + 3 * low);
    if (total < 0) atomic_or(broken, 2);
    counts[r] = max(total, 0);
  }
}
