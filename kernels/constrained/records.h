// Records of the insertion of constraints, in arrays that kernels and the host share.
#ifndef FLAUNAY_CONSTRAINED_RECORDS_H
#define FLAUNAY_CONSTRAINED_RECORDS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// A constraint that is not inserted yet: the corner of its vertex `origin` opposite to the first edge that it crosses
// on the way to the vertex `goal`; how many rows it crosses; and where the walk turned, a bit per row after the first:
// 1 if the row's vertex is on the left. rows is 0 if the constraint is an edge already, which is opposite to the
// corner.
typedef struct {
  int origin, goal, corner, rows;
  uint64 turns;
} constraint_walk;
ASSERT_SIZE(constraint_walk, 24);

// A vertex of a chain that bounds the rows that a constraint crosses; the side from it to the next one: the corner of
// the row inside that is opposite to it, -1 at the end of the chain; twice the corner beyond it and 2, or 0 on the
// hull, and 1 if it is a constraint. Also a row, which has nothing to do with the vertex.
typedef struct {
  int vertex, corner;
  uint side;
  int row;
} chain_entry;
ASSERT_SIZE(chain_entry, 16);

// A vertex of a chain that is triangulated. Vertices are positions in the chain. In the polygon of inserted
// ones: the next one, and the half-edge inside of the edge to it. Then its neighbours when it is inserted.
typedef struct {
  int next, inside, before, after;
} chain_vertex;
ASSERT_SIZE(chain_vertex, 16);

// A half-edge of a chain's triangulation.
typedef struct {
  int origin, twin;
} chain_edge;
ASSERT_SIZE(chain_edge, 8);

END_SHARED

#endif
