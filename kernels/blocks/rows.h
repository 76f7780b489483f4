// Rows of the array of triangles: each starts with its smallest index and runs counter-clockwise.
#ifndef FLAUNAY_ROWS_H
#define FLAUNAY_ROWS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Where the corners v, a and b stand in the row of a triangle, counter-clockwise.
typedef struct {
  int v, a, b;
} row_places;

// Finds the places from the indices of the corners.
static inline row_places places_in_row(int at_v, int at_a, int at_b) {
  const int least = min(at_v, min(at_a, at_b));
  const int from = (at_a == least) + 2 * (at_b == least);
  row_places to;
  // Tables of 0, 2, 1 and of 1, 0, 2 in pairs of bits: compilers would make branches here, which cannot be
  // predicted.
  to.v = 24 >> 2 * from & 3;
  to.a = 33 >> 2 * from & 3;
  to.b = 2 - from;
  return to;
}

END_SHARED

#endif
