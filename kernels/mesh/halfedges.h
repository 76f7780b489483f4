// Half-edges of a list of triangles: half-edge 3t + k runs from vertex k of triangle t to the next one, with the
// triangle on its left. Corner 3t + k is the triangle's angle at vertex k.
#ifndef FLAUNAY_HALFEDGES_H
#define FLAUNAY_HALFEDGES_H

#include "arithmetic/language.h"
#include "mesh/records.h"

BEGIN_SHARED

static inline int next_halfedge(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
static inline int previous_halfedge(int h) { return h % 3 == 0 ? h + 2 : h - 1; }

// The corners of a triangle by their numbers in it: 0, 1 and 2.
static inline int next_corner(int k) { return k == 2 ? 0 : k + 1; }
static inline int corner_before(int k) { return k == 0 ? 2 : k - 1; }

// The corner opposite to a neighbour of the triangle.
// Without branches, since they could not be predicted.
static inline int corner_opposite(face f, int neighbor) {
  return (f.neighbor[0] != neighbor) + ((f.neighbor[0] != neighbor) & (f.neighbor[1] != neighbor));
}

// A corner and the half-edge of its triangle that does not touch it.
static inline int opposite_halfedge(int corner) { return next_halfedge(corner); }
static inline int opposite_corner(int h) { return previous_halfedge(h); }

static inline int halfedge_from(GLOBAL const int* RESTRICT triangles, int h) { return triangles[h]; }
static inline int halfedge_to(GLOBAL const int* RESTRICT triangles, int h) { return triangles[next_halfedge(h)]; }

END_SHARED

#endif
