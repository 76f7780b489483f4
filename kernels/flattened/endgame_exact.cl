// End game with exact predicates, for the small regions that floating point could not decide; see endgame.cl. One pass
// over a packed list, with one work-item per region.

#define EXACT 1
#include "flattened/codes.h"
#include "flattened/region_triangles.h"
#include "predicates/records.h"

kernel void small_regions_exact(global const uint* restrict count, global const int* restrict list,
                                filter_bounds bounds, global const int* restrict offsets,
                                global const double2* restrict points, global int* corners,
                                global uint* restrict counts, global volatile int* restrict broken COUNTERS) {
  const int length = count[0];
  for (int k = get_global_id(0); k < length; k += get_global_size(0)) {
    const int r = list[k];
    const int low = offsets[r];
    const int total =
        region_triangles(corners + 3 * low, offsets[r + 1] - low, points, bounds, corners + 3 * low WITH_COUNTERS);
    if (total < 0) atomic_or(broken, BROKEN_BORDER);
    counts[r] = max(total, 0);
  }
}
