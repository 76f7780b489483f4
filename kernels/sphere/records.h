// A vertex of a hull in the plane, which kernels and the host share.
#ifndef FLAUNAY_SPHERE_RECORDS_H
#define FLAUNAY_SPHERE_RECORDS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// edge: of the edge from there, 3 t + the corner opposite; no meaning in sets without triangles.
typedef struct {
  double x, y;
  int point, edge;
} hull_vertex;
ASSERT_SIZE(hull_vertex, 24);

END_SHARED

#endif
