// Codes that kernels of updates write for each other and for the host.
#ifndef FLAUNAY_UPDATES_CODES_H
#define FLAUNAY_UPDATES_CODES_H

#include "arithmetic/language.h"

BEGIN_SHARED

// The corner at infinity of a ghost: a row beyond an edge of the hull, with its ends as its other corners. With ghosts,
// every row has three neighbours.
INTEGER_CONSTANT(INFINITE_VERTEX, -2);

// The contents of a row.
INTEGER_CONSTANT(ROW_FREE, 0);
INTEGER_CONSTANT(ROW_GHOST, 1);
INTEGER_CONSTANT(ROW_TRIANGLE, 2);

// Faults of a row after vertices have moved.
INTEGER_CONSTANT(ROW_TURNED, 1);  // it has turned over, or the hull is not convex at its end
INTEGER_CONSTANT(ROW_WRONG, 2);   // it has an edge that is not locally Delaunay

// Outcomes of a vertex to be removed, or of an edge to be flipped, in a step.
INTEGER_CONSTANT(UPDATE_WAITS, 0);
INTEGER_CONSTANT(UPDATE_DONE, 1);
INTEGER_CONSTANT(UPDATE_TOO_LARGE, 2);  // the star of the vertex has too many triangles
INTEGER_CONSTANT(UPDATE_NEEDLESS, 3);   // the edge is locally Delaunay
INTEGER_CONSTANT(UPDATE_HOLDS, 4);      // what it claims

END_SHARED

#endif
