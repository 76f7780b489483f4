// Which rounded polygons of cells may have to be mended, on the host.

#include "mesh/halfedges.h"
#include "operations/prefetch.h"
#include "voronoi/plain_polygon.h"

// How many triangles ahead their points and centres are fetched.
#define TRIANGLES_AHEAD 32

// n points. doubtful: 1 for cells that may have to be mended, otherwise 0.
kernel void mark_doubtful(int n, global const double* restrict input, global const int* restrict offsets,
                          global const double* restrict vertices, global uint* restrict doubtful) {
  const int p = get_global_id(0);
  if (p < n) doubtful[p] = !is_plain_polygon(vload2(p, input), offsets[p], offsets[p + 1], vertices);
}

// n triangles, whose centres are the corners of cells. doubtful: 1 where a Voronoi edge between the centres of this
// triangle and of one with a larger number may have to be mended, otherwise 0. If all points see all edges around them
// from their own side, their polygons do not cross themselves. In the order of triangles, neighbours are close
// in memory.
kernel void mark_doubtful_duals(int n, int points, global const double* restrict input,
                                global const int* restrict triangles, global const int* restrict neighbors,
                                global const double* restrict centres, global uint* restrict doubtful) {
  const int t = get_global_id(0);
  if (t < n) {
    const int ahead = 3 * min(n - 1, t + TRIANGLES_AHEAD);
    for (int c = ahead; c < ahead + 3; ++c) {
      fetch(&input[2 * triangles[c]]);
      fetch(&centres[2 * max(0, neighbors[c])]);
    }
    int is_plain = 1;
    for (int k = 0; k < 3; ++k) {
      const int u = neighbors[3 * t + k];
      const int p = triangles[3 * t + corner_before(k)], q = triangles[3 * t + next_corner(k)];
      if ((u > t) & (u < n) & ((uint)p < (uint)points) & ((uint)q < (uint)points))
        is_plain &= is_plain_edge(vload2(p, input), vload2(q, input), vload2(t, centres), vload2(u, centres));
    }
    doubtful[t] = !is_plain;
  }
}
