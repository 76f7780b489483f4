// Which rounded polygons of cells may have to be mended, on the host.

#include "voronoi/plain_polygon.h"

// n points. doubtful: 1 for cells that may have to be mended, otherwise 0.
kernel void mark_doubtful(int n, global const double* restrict input, global const int* restrict offsets,
                          global const double* restrict vertices, global uint* restrict doubtful) {
  const int p = get_global_id(0);
  if (p < n) doubtful[p] = !is_plain_polygon(vload2(p, input), offsets[p], offsets[p + 1], 0, vertices);
}

// n points. Of cells whose corners are centres of triangles. Unbounded ones count with their corners alone, and are no
// polygons if these are fewer than three.
kernel void mark_doubtful_duals(int n, global const double* restrict input, global const int* restrict offsets,
                                global const int* restrict cells, global const double* restrict centres,
                                global uint* restrict doubtful) {
  const int p = get_global_id(0);
  if (p < n) {
    const int first = offsets[p], end = offsets[p + 1];
    doubtful[p] = end - first > 2 && !is_plain_polygon(vload2(p, input), first, end, cells, centres);
  }
}
