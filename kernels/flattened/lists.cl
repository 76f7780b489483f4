// The split of every region's internal points, in both sorted orders.
//
// side[id] is the child that an internal point goes to. point_sides sets it by comparison with the cut line. That is
// enough: a point that is not on the path lies on the same side of the path and of the line. It is one pass, with one
// work-item per point. list_counts, list_bounds and list_split then write the children's lists, stably. They are one
// pass each, with one work-item per chunk, and a scan (scan.cl) follows the first.

#include "flattened/arguments.h"
#include "flattened/axes.h"
#include "flattened/codes.h"
#include "operations/counters.h"
#include "operations/prefetch.h"

// How many elements ahead of its use a point is fetched.
#define POINTS_AHEAD 24

// broken[0] gets BROKEN_PATH if a point on the cut line is not on the path, which would be a bug.
kernel void point_sides(int n, global const int* restrict list, global const int* restrict regions, CUTS(),
                        global uchar* restrict side, global volatile int* restrict broken COUNTERS) {
  const int i = get_global_id(0);
  if (i < n) {
    const int id = list[i];
    if (i + POINTS_AHEAD < n) fetch(points + list[i + POINTS_AHEAD]);
    if (side[id] != SIDE_BORDER) {
      COUNT(SPLIT, ARITHMETIC, 1);
      const int r = regions[i];
      const double s = to_frame(points[id], axis[r]).x;
      side[id] = s < cut[r] ? SIDE_LEFT : SIDE_RIGHT;
      if (s == cut[r]) atomic_or(broken, BROKEN_PATH);
    }
  }
}

// The next three kernels walk chunks of a sorted list and count the points that go left and right. counts: per chunk,
// to be scanned.
kernel void list_counts(int n, int chunk, global const int* restrict list, global const uchar* restrict side,
                        global uint2* restrict counts) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    uint left = 0, right = 0;
    for (int i = low; i < high; ++i) {
      const int s = side[list[i]];
      left += s == SIDE_LEFT;
      right += s == SIDE_RIGHT;
    }
    counts[c] = VECTOR(uint2, left, right);
  }
}

// before[r]: the points of all regions before r; the same for both lists.
kernel void list_bounds(int n, int chunk, int regions_count, global const int* restrict list,
                        global const int* restrict regions, global const uchar* restrict side,
                        global const uint2* restrict scanned, global uint2* restrict before) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    uint2 count = scanned[c];
    int previous = low > 0 ? regions[low - 1] : -1;
    for (int i = low; i < high; ++i) {
      const int r = regions[i];
      if (r != previous) before[r] = count;
      previous = r;
      const int s = side[list[i]];
      count += VECTOR(uint2, s == SIDE_LEFT, s == SIDE_RIGHT);
    }
    if (high == n) before[regions_count] = count;
  }
}

kernel void list_split(int n, int chunk, global const int* restrict list, global const int* restrict regions,
                       global const uchar* restrict side, global const uint2* restrict scanned,
                       global const uint2* restrict before, global const int* restrict child_region,
                       global int* restrict new_list, global int* restrict new_regions) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    uint2 count = scanned[c];
    int previous = -1;
    uint right_before = 0, left_through = 0;
    int left_child = 0, right_child = 0;
    for (int i = low; i < high; ++i) {
      const int r = regions[i];
      if (r != previous) {
        previous = r;
        right_before = before[r].y;
        left_through = before[r + 1].x;
        left_child = child_region[2 * r];
        right_child = child_region[2 * r + 1];
      }
      const int id = list[i];
      const int s = side[id];
      if (s == SIDE_LEFT) {
        const uint to = count.x++ + right_before;
        new_list[to] = id;
        new_regions[to] = left_child;
      } else if (s == SIDE_RIGHT) {
        const uint to = count.y++ + left_through;
        new_list[to] = id;
        new_regions[to] = right_child;
      }
    }
  }
}

// The first lists, before any cut: the internal points in a list of all ids, and their regions.
kernel void first_flags(int n, global const int* restrict list, global const uchar* restrict side,
                        global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) counts[i] = side[list[i]] != SIDE_BORDER;
}

kernel void first_list(int n, global const int* restrict list, global const uint* restrict scanned,
                       global const int* restrict set_of_id, global const int* restrict child_region,
                       global int* restrict new_list, global int* restrict new_regions) {
  const int i = get_global_id(0);
  if (i < n && scanned[i + 1] != scanned[i]) {
    new_list[scanned[i]] = list[i];
    new_regions[scanned[i]] = child_region[set_of_id[list[i]]];
  }
}
