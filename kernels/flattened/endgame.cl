// End game: the triangles of all regions of a level that have no internal points left.
//
// small_regions triangulates regions of at most SMALL_REGION corners with filtered predicates. small_regions_exact
// repeats those that met an undecided predicate (a packed list). Larger regions go to strips.cl. The triangles replace
// the corners they come from, in place: a region of k corners has at most k - 2 triangles. collect_triangles makes the
// triangles dense, by the scanned counts. Each kernel is one pass, with one work-item per region.

#define EXACT 0
#include "flattened/codes.h"
#include "flattened/region_triangles.h"
#include "predicates/records.h"

// status: 0 done, FLAG_UNDECIDED or FLAG_TOO_LARGE. broken[0] gets BROKEN_BORDER if a border is broken.
kernel void small_regions(int n, filter_bounds bounds, global const int* restrict offsets,
                          global const double2* restrict points, global int* corners, global uint* restrict counts,
                          global uchar* restrict status, global volatile int* restrict broken COUNTERS) {
  const int r = get_global_id(0);
  if (r < n) {
    const int low = offsets[r];
    const int size = offsets[r + 1] - low;
    COUNT_SIZE(size);
    int total = 0;
    int state = 0;
    if (size > SMALL_REGION) {
      state = FLAG_TOO_LARGE;
    } else {
      total = region_triangles(corners + 3 * low, size, points, bounds, corners + 3 * low WITH_COUNTERS);
      if (total == REGION_UNDECIDED) state = FLAG_UNDECIDED;
      if (total == REGION_BROKEN) atomic_or(broken, BROKEN_BORDER);
      total = max(total, 0);
    }
    counts[r] = total;
    status[r] = state;
  }
}

kernel void collect_triangles(int n, int base, global const int* restrict offsets, global const uint* restrict scanned,
                              global const int* restrict slots, global int* restrict triangles) {
  const int r = get_global_id(0);
  if (r < n) {
    const int low = offsets[r];
    const int to = base + scanned[r];
    const int count = scanned[r + 1] - scanned[r];
    for (int i = 0; i < 3 * count; ++i) triangles[3 * to + i] = slots[3 * low + i];
  }
}
