// The canonical constrained Delaunay triangulations of many polygons, each between a base and a chain of vertices left
// of it (docs/constrained.md).
//
// Chain c has the vertices chain[offsets[c]] to chain[offsets[c + 1] - 1]. Its triangles are positions (i, j, k) in the
// chain, ascending: j is the apex of the chord from i to k. They are in preorder, so those of a chord with d vertices
// between its ends are at d places that follow each other: the triangle (i, j, k) at place p has the child on (i, j) at
// p + 1 and the child on (j, k) at p + j - i. As a chain of k vertices has k - 2 triangles, its first place is
// offsets[c] - 2c.

#include "shared/planar.h"

// A chain, and the bound of in-circle tests.
typedef struct {
  double bound;
  global const double2* points;
  global const int* vertices;
} polygon;

static inline double2 vertex_at(const polygon* chain, int position) { return chain->points[chain->vertices[position]]; }

// All vertices between are left of the chord, so the circles through its ends and one of them are nested.
static inline int apex_of(const polygon* chain, int i, int k) {
  const double2 from = vertex_at(chain, i), to = vertex_at(chain, k);
  int best = i + 1;
  double2 apex = vertex_at(chain, best);
  for (int j = best + 1; j < k; ++j) {
    const double2 other = vertex_at(chain, j);
    if (circle_canonical(from, to, apex, other, chain->bound) > 0) {
      best = j;
      apex = other;
    }
  }
  return best;
}

// Gift-wrapping: places whose triangles are not known yet hold their chords.
static inline void wrap(const polygon* chain, int size, global int* triangles) {
  triangles[0] = 0;
  triangles[2] = size - 1;
  for (int place = 0; place < size - 2; ++place) {
    global int* const row = triangles + 3 * place;
    const int i = row[0], k = row[2];
    const int j = apex_of(chain, i, k);
    row[1] = j;
    if (j - i > 1) {
      row[3] = i;
      row[5] = j;
    }
    if (k - j > 1) {
      row[3 * (j - i)] = j;
      row[3 * (j - i) + 2] = k;
    }
  }
}

kernel void triangulate_chains(int n, double bound, global const double2* restrict points,
                               global const int* restrict offsets, global const int* restrict chain,
                               global int* restrict triangles) {
  const int c = get_global_id(0);
  if (c >= n) return;
  const int first = offsets[c], size = offsets[c + 1] - first;
  if (size < 3) return;
  polygon p;
  p.bound = bound;
  p.points = points;
  p.vertices = chain + first;
  wrap(&p, size, triangles + 3L * (first - 2 * c));
}
