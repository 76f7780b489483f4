// The projections of every region's internal points for its cut line. One pass, with one work-item per point.

#include "flattened/arguments.h"
#include "flattened/hull_height.h"
#include "operations/counters.h"
#include "operations/prefetch.h"

// How many elements ahead of its use a point is fetched.
#define POINTS_AHEAD 24

// The internal points' projections, in the places of the list that is sorted along their region's cut line.
kernel void project_points(int n, global const int* restrict regions, LISTS(), CUTS(),
                           global double2* restrict projections COUNTERS) {
  const int i = get_global_id(0);
  if (i < n) {
    const int r = regions[i];
    const int a = axis[r];
    const int ahead = i + POINTS_AHEAD;
    if (ahead < n) fetch(points + (a == AXIS_Y ? x_list : y_list)[ahead]);
    projections[i] = project(to_frame(points[a == AXIS_Y ? x_list[i] : y_list[i]], a), cut[r], is_planar(a));
  }
}
