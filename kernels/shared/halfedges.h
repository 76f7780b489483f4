// Half-edges of a triangle array: half-edge 3t + j is the edge opposite to vertex j of triangle t, from vertex
// j + 1 to vertex j + 2, with the triangle on its left.
#ifndef FLAUNAY_HALFEDGES_H
#define FLAUNAY_HALFEDGES_H

static inline int next_halfedge(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
static inline int halfedge_from(global const int* restrict triangles, int h) { return triangles[next_halfedge(h)]; }
static inline int halfedge_to(global const int* restrict triangles, int h) {
  return triangles[next_halfedge(next_halfedge(h))];
}

#endif
