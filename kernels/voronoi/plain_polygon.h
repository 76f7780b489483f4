// Whether the rounded polygon of a cell can stay as it is, by floating point with a bound. What is in doubt is mended
// on the host (src/derived/voronoi/mend.hpp).
#ifndef FLAUNAY_PLAIN_POLYGON_H
#define FLAUNAY_PLAIN_POLYGON_H

#include "arithmetic/language.h"
#include "predicates/planar.h"

BEGIN_SHARED

static inline double larger_of(double2 p) { return fmax(fabs(p.x), fabs(p.y)); }

// Two corners of a cell are one place but for rounding if the larger difference of their coordinates is at most this
// part of the largest of their coordinates and of those of the cell's point.
#define CORNERS_COINCIDE 0x1p-50
static inline double corner_scale(double2 a, double2 b, double2 site) {
  return fmax(larger_of(site), fmax(larger_of(a), larger_of(b)));
}

static inline int is_backward(double2 step) { return (step.x < 0) | ((step.x == 0) & (step.y < 0)); }

// Whether corners [first, end) are surely those of a convex polygon, counter-clockwise, without two that coincide;
// corners that equal the one before do not count. order: the places of corners in `places`, if these are not in order.
static inline int is_plain_polygon(double2 site, int first, int end, GLOBAL const int* order,
                                   GLOBAL const double* places) {
#define CORNER(i) vload2(order ? order[i] : (i), places)
  if (first == end) return 1;
  double2 before = CORNER(end - 1), step = VECTOR(double2, 0.0, 0.0);
  for (int i = end - 2; i >= first && (step.x == 0) & (step.y == 0); --i) step = before - CORNER(i);
  int is_plain = 1, lowest = 0;
  for (int i = first; i < end; ++i) {
    const double2 at = CORNER(i), next = at - before;
    if ((next.x == 0) & (next.y == 0)) continue;
    const double left = step.x * next.y, right = step.y * next.x;
    is_plain &= (left - right > ORIENT_BOUND * (fabs(left) + fabs(right))) &
                (larger_of(next) > CORNERS_COINCIDE * corner_scale(before, at, site));
    // Once around, there is one corner that comes before both neighbours.
    lowest += is_backward(step) & !is_backward(next);
    before = at;
    step = next;
  }
  return is_plain & (lowest == 1);
#undef CORNER
}

END_SHARED

#endif
