// The frames in which a region's hull is computed: s across the cut line, u along it.
#ifndef FLAUNAY_AXES_H
#define FLAUNAY_AXES_H

#include "arithmetic/language.h"

BEGIN_SHARED

// A region's axis. The first two cut a region through the line s = q and take the lower hull of the projections
// (u, (s - q)^2 + (u - u_q)^2); both frames are right-handed, so "left of the path" means s < q in either.
// The planar two take the lower hull of (u, s) itself: the lower and the upper hull of a whole point set.
INTEGER_CONSTANT(AXIS_X, 0);             // cut x = q: s = x, u = y
INTEGER_CONSTANT(AXIS_Y, 1);             // cut y = q: s = y, u = -x
INTEGER_CONSTANT(AXIS_PLANAR_LOWER, 2);  // s = y, u = x
INTEGER_CONSTANT(AXIS_PLANAR_UPPER, 3);  // s = -y, u = -x

static inline int is_planar(int axis) { return axis >= AXIS_PLANAR_LOWER; }

// (s, u) of a point.
static inline double2 to_frame(double2 p, int axis) {
  switch (axis) {
    case AXIS_X:
      return p;
    case AXIS_Y:
      return VECTOR(double2, p.y, -p.x);
    case AXIS_PLANAR_LOWER:
      return VECTOR(double2, p.y, p.x);
    default:
      return VECTOR(double2, -p.y, -p.x);
  }
}

END_SHARED

#endif
