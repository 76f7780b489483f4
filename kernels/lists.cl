// The split of every region's internal points, in both sorted orders.
//
// side[id] says where an internal point goes. point_sides sets it by comparison with the cut line, which is all it
// takes: what is not on the path lies on the same side of both. list_flags turns a sorted list's sides into counts for
// a scan (uint2, scan.cl), list_split writes the children's lists, stably. One pass each, a work-item a point.

#include "shared/frame.h"

#define SIDE_LEFT 0
#define SIDE_RIGHT 1
#define SIDE_BORDER 2

// broken[0] is set if a point on the cut line is not on the path, which would be a bug.
kernel void point_sides(int n, global const int* restrict list, global const int* restrict regions,
                        global const int* restrict axis, global const double* restrict cut,
                        global const double2* restrict points, global uchar* restrict side,
                        global volatile int* restrict broken) {
  const int i = get_global_id(0);
  if (i < n) {
    const int id = list[i];
    if (side[id] != SIDE_BORDER) {
      const int r = regions[i];
      const double s = to_frame(points[id], axis[r]).x;
      side[id] = s < cut[r] ? SIDE_LEFT : SIDE_RIGHT;
      if (s == cut[r]) atomic_or(broken, 1);
    }
  }
}

kernel void list_flags(int n, global const int* restrict list, global const uchar* restrict side,
                       global uint2* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) {
    const int s = side[list[i]];
    counts[i] = (uint2)(s == SIDE_LEFT, s == SIDE_RIGHT);
  }
}

kernel void list_split(int n, global const int* restrict list, global const int* restrict regions,
                       global const int* restrict point_offsets, global const uint2* restrict scanned,
                       global const int* restrict child_region, global int* restrict new_list,
                       global int* restrict new_regions) {
  const int i = get_global_id(0);
  if (i < n) {
    const uint2 before = scanned[i];
    const uint2 after = scanned[i + 1];
    const int r = regions[i];
    if (after.x != before.x) {
      const int to = before.x + scanned[point_offsets[r]].y;
      new_list[to] = list[i];
      new_regions[to] = child_region[2 * r];
    } else if (after.y != before.y) {
      const int to = before.y + scanned[point_offsets[r + 1]].x;
      new_list[to] = list[i];
      new_regions[to] = child_region[2 * r + 1];
    }
  }
}

// The first lists, before any cut: what is internal of a list of all ids, and its region.
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
