// End game: the triangles of all regions of a level that have no internal points left.
//
// small_regions gives each region of at most SMALL_REGION corners to one work-item, with filtered predicates;
// small_regions_exact does those again that met an undecided one (a packed list). Larger regions go to strips.cl.
// Triangles replace the corners they come from, in place: a region of k corners has k - 2 triangles at most.
// collect_triangles makes them dense, by the scanned counts. One pass each, a work-item a region.

#define EXACT 0
#include "shared/region_triangles.h"

// status: 0 done, 2 undecided, 3 too large. broken[0] gets 2 if a border is not what it should be.
kernel void small_regions(int n, double orient_bound, double circle_bound, global const int* restrict offsets,
                          global const double2* restrict points, global int* corners, global uint* restrict counts,
                          global uchar* restrict status, global volatile int* restrict broken COUNTERS) {
  const int r = get_global_id(0);
  if (r < n) {
    const int low = offsets[r];
    const int size = offsets[r + 1] - low;
    int total = 0;
    int state = 0;
    if (size > SMALL_REGION) {
      state = 3;
      COUNT_REGION(size, 0)
    } else {
      total = region_triangles(corners + 3 * low, size, points, orient_bound, circle_bound, corners + 3 * low WITH_COUNTERS);
      if (total == REGION_UNDECIDED) state = 2;
      if (total == REGION_BROKEN) atomic_or(broken, 2);
      total = max(total, 0);
    }
    counts[r] = total;
    status[r] = state;
  }
}

kernel void collect_triangles(int n, int base, global const int* restrict offsets,
                              global const uint* restrict scanned, global const int* restrict slots,
                              global int* restrict triangles) {
  const int r = get_global_id(0);
  if (r < n) {
    const int low = offsets[r];
    const int to = base + scanned[r];
    const int count = scanned[r + 1] - scanned[r];
    for (int i = 0; i < 3 * count; ++i) triangles[3 * to + i] = slots[3 * low + i];
  }
}
