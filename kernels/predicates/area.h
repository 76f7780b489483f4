// Twice the areas of triangles, in floating point and exactly.
#ifndef FLAUNAY_AREA_H
#define FLAUNAY_AREA_H

#include "arithmetic/language.h"
#include "predicates/planar.h"

BEGIN_SHARED

// Twice the area of q, a and b, with the sum of magnitudes that bounds its error.
static inline double2 area_filtered(double2 a, double2 b, double2 q) {
  const double left = (a.x - q.x) * (b.y - q.y);
  const double right = (a.y - q.y) * (b.x - q.x);
  return VECTOR(double2, left - right, fabs(left) + fabs(right));
}

// Twice the area, with all bits right except the last.
static inline double area_exact(double2 a, double2 b, double2 q) {
  const double2 ax = two_sum(a.x, -q.x), ay = two_sum(a.y, -q.y);
  const double2 bx = two_sum(b.x, -q.x), by = two_sum(b.y, -q.y);
  expansion sum;
  expansion_cross(ax, ay, bx, by, &sum);
  expansion_compress(&sum);
  return expansion_value(&sum);
}

END_SHARED

#endif
