// The cut of every region of a level: its axis and the coordinate q of its line, by index into sorted lists.
//
// One pass, one work-item a region. x_list and y_list hold each region's internal points in either order, in the same
// places. The line goes through the median of the chosen axis; by default the axis is that of the longer interquartile
// range, which keeps regions round and their borders short.

#include "shared/counting.h"
#include "shared/frame.h"

kernel void cut_regions(int n, int alternate_axis, int level, global const int* restrict point_offsets,
                        global const int* restrict x_list, global const int* restrict y_list,
                        global const double2* restrict points, global int* restrict axis,
                        global double* restrict cut, global int* restrict first_end, global int* restrict last_end,
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
      COUNT(COMPONENT_CUT, KIND_ARITHMETIC, 3);
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
