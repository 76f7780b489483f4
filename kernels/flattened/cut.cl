// The cut of every region of a level: its axis, the coordinate q of its line, and the ends of the hull along that line.
//
// cut_regions is one pass, with one work-item per region. x_list and y_list hold the region's internal points in the
// two sorted orders, so the median and the quartiles are looked up there. The line goes through the median of the
// chosen axis. By default that is the axis of the longer interquartile range, which keeps regions round and borders
// short. extreme_vertices finds one end of the hull by passes of a segmented arg-reduce over the border's corners.

#include "shared/counting.h"
#include "shared/hull_height.h"
#include "shared/segmented_arg_reduce.h"

kernel void cut_regions(int n, int alternate_axis, int level, global const int* restrict point_offsets,
                        global const int* restrict x_list, global const int* restrict y_list,
                        global const double2* restrict points, global int* restrict axis, global double* restrict cut,
                        global int* restrict first_end, global int* restrict last_end,
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
    // For the arg-reductions that find the ends of the hull.
    first_end[r] = -1;
    last_end[r] = -1;
  }
}

// Corner i stands for its vertex.
#define VERTEX_OF_CORNER(i) corners[3 * (i) + 1]

static inline int before_along(int region, int i, int j, int direction, global const int* restrict axis,
                               global const double* restrict cut, global const double2* restrict points) {
  const int a = axis[region];
  const double2 p = to_frame(points[i], a);
  const double2 v = to_frame(points[j], a);
  if (p.y != v.y) return direction > 0 ? p.y < v.y : p.y > v.y;
  return i != j && is_lower(p, v, cut[region], is_planar(a));
}
#define BEFORE_ALONG(region, i, j) before_along(region, i, j, direction, axis, cut, points)

// The vertex of the smallest u (direction 1) or largest u (-1), the lowest of these if there are several.
SEGMENTED_ARG_REDUCE(extreme_vertices, VERTEX_OF_CORNER, BEFORE_ALONG, int direction,
                     global const int* restrict corners, global const int* restrict axis,
                     global const double* restrict cut, global const double2* restrict points)
