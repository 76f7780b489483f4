// Codes that kernels write for each other and for the host.
#ifndef FLAUNAY_FLATTENED_CODES_H
#define FLAUNAY_FLATTENED_CODES_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Flags of elements that kernels write: 0 for no, 1 for yes, or one of these.
INTEGER_CONSTANT(FLAG_UNDECIDED, 2);  // by floating point; exact kernels take these up
INTEGER_CONSTANT(FLAG_ON_PATH, 3);    // prune: a vertex of the path itself
INTEGER_CONSTANT(FLAG_TOO_LARGE, 3);  // end game: a region with too many corners for one work-item

// Where a point of a region goes: to the child left or right of the path; or it is on a border.
INTEGER_CONSTANT(SIDE_LEFT, 0);
INTEGER_CONSTANT(SIDE_RIGHT, 1);
INTEGER_CONSTANT(SIDE_BORDER, 2);

// Numbers that keep_bounds reports to the host: the elements to be joined, how many of them are corners, and
// the most corners of a region.
INTEGER_CONSTANT(KEPT_ALL, 0);
INTEGER_CONSTANT(KEPT_CORNERS, 1);
INTEGER_CONSTANT(KEPT_CORNERS_MOST, 2);
INTEGER_CONSTANT(KEPT_FACTS, 3);

// Bits that kernels set when they find an invariant broken, which is an error of the program.
INTEGER_CONSTANT(BROKEN_PATH, 1);    // a point on a cut line is not on its path
INTEGER_CONSTANT(BROKEN_BORDER, 2);  // a region's border does not enclose it
INTEGER_CONSTANT(BROKEN_CIRCLE, 4);  // an edge is not Delaunay

END_SHARED

#endif
