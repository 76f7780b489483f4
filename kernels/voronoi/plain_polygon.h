// Whether the rounded polygon of a cell can stay as it is, by floating point with a bound. Doubtful polygons
// are mended on the host (src/derived/voronoi/mend.hpp).
#ifndef FLAUNAY_PLAIN_POLYGON_H
#define FLAUNAY_PLAIN_POLYGON_H

#include "arithmetic/language.h"
#include "predicates/planar.h"

BEGIN_SHARED

static inline double larger(double a, double b) { return a > b ? a : b; }
static inline double larger_of(double2 p) { return larger(fabs(p.x), fabs(p.y)); }

// Two corners of a cell are one place but for rounding if the larger difference of their coordinates is at most this
// part of the largest coordinate of the corners and the cell's point.
#define CORNERS_COINCIDE 0x1p-50
static inline double corner_scale(double2 a, double2 b, double2 site) {
  return larger(larger_of(site), larger(larger_of(a), larger_of(b)));
}

static inline int is_backward(double2 step) { return (step.x < 0) | ((step.x == 0) & (step.y < 0)); }

// Whether corners [first, end) are certainly a convex polygon, counter-clockwise, without two that coincide.
static inline int is_plain_polygon(double2 site, int first, int end, GLOBAL const double* corners) {
  if (first == end) return 1;
  if (end - first < 3) return 0;
  double2 before = vload2(end - 1, corners), step = before - vload2(end - 2, corners);
  int is_plain = 1, lowest = 0;
  for (int i = first; i < end; ++i) {
    const double2 at = vload2(i, corners), next = at - before;
    const double left = step.x * next.y, right = step.y * next.x;
    is_plain &= (left - right > ORIENT_BOUND * (fabs(left) + fabs(right))) &
                (larger_of(next) > CORNERS_COINCIDE * corner_scale(before, at, site));
    // Once around, there is one corner that comes before both neighbours.
    lowest += is_backward(step) & !is_backward(next);
    before = at;
    step = next;
  }
  return is_plain & (lowest == 1);
}

// Whether points on both sides of a Voronoi edge surely see it from its own side: p from the left of the edge from a to
// b, q from the right; and whether its ends do not coincide. If they are equal, there is no edge.
static inline int is_plain_edge(double2 p, double2 q, double2 a, double2 b) {
  const double2 step = b - a;
  const double2 from_p = a - p, from_q = a - q;
  const double p_left = from_p.x * step.y, p_right = from_p.y * step.x;
  const double q_left = from_q.x * step.y, q_right = from_q.y * step.x;
  return ((step.x == 0) & (step.y == 0)) | ((p_left - p_right > ORIENT_BOUND * (fabs(p_left) + fabs(p_right))) &
                                            (q_right - q_left > ORIENT_BOUND * (fabs(q_left) + fabs(q_right))) &
                                            (larger_of(step) > CORNERS_COINCIDE * corner_scale(a, b, q)) &
                                            (larger_of(step) > CORNERS_COINCIDE * larger_of(p)));
}

END_SHARED

#endif
