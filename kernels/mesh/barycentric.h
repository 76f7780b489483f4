// Barycentric coordinates of a point in a triangle: areas by the whole, whose signs are exact.
#ifndef FLAUNAY_BARYCENTRIC_H
#define FLAUNAY_BARYCENTRIC_H

#include "arithmetic/language.h"
#include "mesh/halfedges.h"
#include "predicates/area.h"
#include "predicates/nearness.h"
#include "predicates/planar.h"

BEGIN_SHARED

// Triangles whose magnitudes exceed their area by this factor are slender. Their areas are computed exactly.
#define SLENDER 4096.0

// The weights of a triangle's corners at q, which lies in it. Where q lies on an edge, the opposite corner has none.
static inline void barycentric(const double2* p, double2 q, filter_bound bound, double* weight) {
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
