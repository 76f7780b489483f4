// The cut of every region of a level: its axis, the coordinate q of its line, and the ends of the hull along that line.
//
// cut_regions is one pass, with one work-item per region. x_list and y_list hold the region's internal points in the
// two sorted orders, so the median and the quartiles are looked up there. The line goes through the median of the
// chosen axis. By default that is the axis of the longer interquartile range, which keeps regions round and borders
// short. find_ends finds the ends of the hulls among the border's corners, with one work-group per region.

#include "flattened/arguments.h"
#include "flattened/hull_height.h"
#include "operations/counters.h"
#include "operations/limits.h"

kernel void cut_regions(int n, int alternate_axis, int level, global const int* restrict point_offsets, LISTS(),
                        global const double2* restrict points, global int* restrict axis, global double* restrict cut,
                        global volatile int* restrict largest COUNTERS) {
  const int r = get_global_id(0);
  if (r < n) {
    const int low = point_offsets[r];
    const int count = point_offsets[r + 1] - low;
    int chosen = alternate_axis;
    if (chosen < 0) {
      const int q1 = low + count / 4;
      const int q3 = low + (3 * count) / 4;
      const double x_range = points[x_list[q3]].x - points[x_list[q1]].x;
      const double y_range = points[y_list[q3]].y - points[y_list[q1]].y;
      chosen = y_range > x_range ? AXIS_Y : AXIS_X;
      COUNT(CUT, ARITHMETIC, CUT_OPERATIONS);
    }
    // For the statistics.
    atomic_max(&largest[level], count);
    const int median = low + count / 2;
    axis[r] = chosen;
    cut[r] = chosen == AXIS_X ? points[x_list[median]].x : points[y_list[median]].y;
  }
}

// Whether vertex i comes before vertex j: of smaller u (direction 1) or larger u (-1), the lower one of one u.
static inline int before_along(int i, int j, int direction, int axis, double cut, global const double2* points) {
  const double2 p = to_frame(points[i], axis);
  const double2 v = to_frame(points[j], axis);
  if (p.y != v.y) return direction > 0 ? p.y < v.y : p.y > v.y;
  return i != j && is_lower(p, v, cut, is_planar(axis));
}

// A work-group takes a region. Each work-item walks corners that are a group apart, and the best of them are compared
// in pairs.
kernel void find_ends(int regions, global const int* restrict corner_offsets, global const int* restrict corners,
                      CUTS(), global int* restrict first_end, global int* restrict last_end COUNTERS) {
  local int best[2][LARGEST_TILE_GROUP];
  const int r = get_group_id(0), me = get_local_id(0), group = get_local_size(0);
  const int low = r < regions ? corner_offsets[r] : 0;
  const int high = r < regions ? corner_offsets[r + 1] : 0;
  const int a = axis[min(r, regions - 1)];
  const double q = cut[min(r, regions - 1)];
  for (int end = 0; end < 2; ++end) {
    int own = -1;
    for (int c = low + me; c < high; c += group) {
      const int vertex = corners[3 * c + 1];
      if (own < 0 || before_along(vertex, own, 1 - 2 * end, a, q, points)) own = vertex;
    }
    best[end][me] = own;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int distance = 1; distance < group; distance *= 2) {
    for (int end = 0; end < 2; ++end) {
      const int other = me % (2 * distance) == 0 && me + distance < group ? best[end][me + distance] : -1;
      if (other >= 0 && (best[end][me] < 0 || before_along(other, best[end][me], 1 - 2 * end, a, q, points)))
        best[end][me] = other;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (me == 0 && r < regions) {
    first_end[r] = best[0][0];
    last_end[r] = best[1][0];
    // Each comparison leaves one of two.
    COUNT(HULL, ARITHMETIC, 2 * (high - low - 1));
  }
}
