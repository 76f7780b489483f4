// Barycentric coordinates of a point in a triangle: areas by the whole, whose signs are exact.
#ifndef FLAUNAY_BARYCENTRIC_H
#define FLAUNAY_BARYCENTRIC_H

#include "shared/halfedges.h"
#include "shared/language.h"
#include "shared/nearness.h"
#include "shared/planar.h"

BEGIN_SHARED

// Twice the area of q, a and b, with the sum of magnitudes that bounds its error.
static inline double2 area_filtered(double2 a, double2 b, double2 q) {
  const double left = (a.x - q.x) * (b.y - q.y);
  const double right = (a.y - q.y) * (b.x - q.x);
  return VECTOR(double2, left - right, fabs(left) + fabs(right));
}

// The same, with all bits right except the last.
static inline double area_exact(double2 a, double2 b, double2 q) {
  const double2 ax = two_sum(a.x, -q.x), ay = two_sum(a.y, -q.y);
  const double2 bx = two_sum(b.x, -q.x), by = two_sum(b.y, -q.y);
  expansion sum;
  sum.size = 0;
  expansion_add_product(&sum, ax, by);
  expansion_add_product(&sum, -ay, bx);
  expansion_compress(&sum);
  double area = 0.0;
  for (int k = 0; k < sum.size; ++k) area += sum.part[k];
  return area;
}

// Of slender triangles, whose magnitudes are larger by this factor than their area, areas are computed exactly.
#define SLENDER 4096.0

// The weights of a triangle's corners at q, which lies in it. Where q lies on an edge, the opposite corner has none.
static inline void barycentric(const double2* p, double2 q, double bound, double* weight) {
  double whole = 0.0, magnitude = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double2 a = p[next_corner(k)], b = p[corner_before(k)];
    const double2 area = area_filtered(a, b, q);
    weight[k] = area.x <= 0.0 || orient_sign(a, b, q, bound) == 0 ? 0.0 : area.x;
    whole += weight[k];
    magnitude += area.y;
  }
  if (magnitude > SLENDER * whole) {
    whole = 0.0;
    for (int k = 0; k < 3; ++k) {
      weight[k] = area_exact(p[next_corner(k)], p[corner_before(k)], q);
      whole += weight[k];
    }
  }
  for (int k = 0; k < 3; ++k) weight[k] = weight[k] / whole;
}

END_SHARED

#endif
