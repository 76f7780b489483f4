// Records of merges and rounds, in arrays that kernels and the host share.
#ifndef FLAUNAY_BLOCKS_RECORDS_H
#define FLAUNAY_BLOCKS_RECORDS_H

#include "arithmetic/language.h"
#include "arithmetic/records.h"

BEGIN_SHARED

// A walk along the seam of a merge: the vertices of its first crossing edge (a downward walk's left vertex is
// on the high side), and the hull edges out of them that it saw there; the edges along which it came to its
// last crossing edge, out of that edge's vertices, or NO_EDGE before it has found the tangent; its numbers of
// crossing edges and of edges that it removes, and how it ended.
typedef struct {
  int left, right, left_edge, right_edge;
  int left_from, right_from;
  int crossings, removals, outcome;
} seam_walk;
ASSERT_SIZE(seam_walk, 36);

// Where a block of points, or one of its parts, lies in its set. All other points of the round are on or beyond the
// sides of its rectangle; sides without points beyond are infinite. `all` is the box around the set. outside: if its
// hull has three vertices, the three edges that have the outside on their left; otherwise NO_EDGE. If a set
// has a single vertex, outside[0] is -2 minus its place.
typedef struct {
  vertex_box rectangle, all;
  int outside[3];
  int vertices;
} block_frame;
ASSERT_SIZE(block_frame, 80);

// An edge whose face on one side is emitted and on the other is not, seen from one of its vertices: the other
// vertex, or NO_VERTEX for the ray to infinity from a vertex of the hull; the place of the emitted corner
// opposite to it, or GHOST; and whether the side that is open begins at it, counter-clockwise.
typedef struct {
  int to, corner, begins;
} open_edge;
ASSERT_SIZE(open_edge, 12);

END_SHARED

#endif
