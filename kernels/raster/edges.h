// Edges that are too long for a raster or contours.
#ifndef FLAUNAY_RASTER_EDGES_H
#define FLAUNAY_RASTER_EDGES_H

#include "arithmetic/language.h"

BEGIN_SHARED

static inline double squared_length_of_edge(double2 a, double2 b) {
  const double2 d = b - a;
  return d.x * d.x + d.y * d.y;
}

// longest: the square of a length.
static inline int has_longer_edge(const double2* p, double longest) {
  return squared_length_of_edge(p[0], p[1]) > longest || squared_length_of_edge(p[1], p[2]) > longest ||
         squared_length_of_edge(p[2], p[0]) > longest;
}

END_SHARED

#endif
