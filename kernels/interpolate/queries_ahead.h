// Fetching data of later queries into a CPU's cache: for a query the face, the corners and their values are one
// behind the other, and each may be anywhere.
#ifndef FLAUNAY_QUERIES_AHEAD_H
#define FLAUNAY_QUERIES_AHEAD_H

#include "mesh/records.h"
#include "operations/prefetch.h"

BEGIN_SHARED

// How many queries ahead values are fetched; corners are twice as many, and faces three times.
#define QUERIES_AHEAD 8

// The triangle of query i of n; the first one for those without, and for those behind the end.
static inline int triangle_ahead(int i, int n, GLOBAL const int* found) { return max(0, found[min(n - 1, i)]); }

// found: the triangles of n queries. i: the current query, which has a triangle. values: rows by point.
FETCHING void fetch_rows(int i, int n, int columns, GLOBAL const int* found, GLOBAL const face* faces,
                         GLOBAL const double2* points, GLOBAL const int* source, GLOBAL const double* values) {
#if FETCH_AHEAD
  fetch(&faces[triangle_ahead(i + 3 * QUERIES_AHEAD, n, found)]);
  GLOBAL const face* at = &faces[triangle_ahead(i + 2 * QUERIES_AHEAD, n, found)];
  for (int k = 0; k < 3; ++k) {
    fetch(&points[at->corner[k]]);
    fetch(&source[at->corner[k]]);
  }
  at = &faces[triangle_ahead(i + QUERIES_AHEAD, n, found)];
  for (int k = 0; k < 3; ++k) fetch(&values[(size_t)source[at->corner[k]] * columns]);
#endif
}

END_SHARED

#endif
