// Edges, triangles and records made of them, in arrays that kernels and the host share.
#ifndef FLAUNAY_MESH_RECORDS_H
#define FLAUNAY_MESH_RECORDS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// A directed edge e in the ring of its origin; its reverse is e ^ 1. (Quad-edges without the dual half.)
typedef struct {
  int to;        // vertex, or NO_VERTEX for a free edge
  int next;      // counter-clockwise about the origin; of a free edge the next free one
  int previous;  // clockwise
} ring_edge;
ASSERT_SIZE(ring_edge, 12);

// The same with numbers of 16 bits, for few vertices in local memory.
typedef struct {
  short to, next, previous;
} short_edge;
ASSERT_SIZE(short_edge, 6);

// The first and the last vertex in the orders (x, y) and (y, -x). All are corners of the hull, strictly convex.
// NO_VERTEX, all of them, if there is no vertex.
typedef struct {
  int first_x, last_x, first_y, last_y;
} hull_ends;
ASSERT_SIZE(hull_ends, 16);

// A list of free edges by its first and its last one; NO_EDGE, both of them, if it is empty.
typedef struct {
  int first, last;
} free_edges;
ASSERT_SIZE(free_edges, 8);

// A block's triangulation; of the first of blocks that were merged, that of them all.
typedef struct {
  hull_ends ends;
  free_edges unused;
} solved_block;
ASSERT_SIZE(solved_block, 24);

// A triangle: its corners, and for each the triangle opposite, or -1.
typedef struct {
  int corner[3], neighbor[3];
} face;
ASSERT_SIZE(face, 24);

END_SHARED

#endif
