// The canonical constrained Delaunay triangulations of many polygons, each between a base and a chain of vertices left
// of it (docs/constrained.md).
//
// Chain c has the vertices chain[offsets[c]] to chain[offsets[c + 1] - 1]. Its triangles are positions (i, j, k) in the
// chain, ascending: j is the apex of the chord from i to k. They are in preorder, so a chord with d vertices
// between its ends has triangles at d consecutive places: the triangle (i, j, k) at place p has the child on
// (i, j) at p + 1 and the child on (j, k) at p + j - i. As a chain of k vertices has k - 2 triangles, its first
// place is offsets[c] - 2c.
//
// gather_vertices copies the vertices' coordinates, so that vertices of a chain are contiguous.
// triangulate_chains has a work-item per chain. It gift-wraps short chains, and inserts vertices of others in
// random order.

#include "constrained/chains.h"
#include "constrained/records.h"

kernel void gather_vertices(int n, int count, global const int* restrict offsets,
                            global const coordinate2* restrict points, global const int* restrict chain,
                            global coordinate2* restrict places) {
  const int i = get_global_id(0);
  if (i < min(n, offsets[count])) places[i] = points[chain[i]];
}

kernel void triangulate_chains(int n, int wrapped_most, int alone_most, filter_bound bound,
                               global const int* restrict offsets, global const coordinate2* restrict places,
                               global chain_vertex* restrict vertices, global chain_edge* restrict edges,
                               global int* restrict triangles) {
  const int c = get_global_id(0);
  if (c >= n) return;
  const int first = offsets[c], size = offsets[c + 1] - first;
  if (size < 3 || size > max(wrapped_most, alone_most)) return;
  const polygon g = polygon_at(bound, first, size, places, vertices, edges);
  global int* const rows = triangles + (int64)3 * (first - 2 * c);
  if (size > wrapped_most && insert_all(&g)) {
    write_rows(&g, rows);
  } else {
    wrap(&g, rows);
  }
}
