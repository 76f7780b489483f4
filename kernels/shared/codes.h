// Codes that kernels write for each other and for the host.
#ifndef FLAUNAY_CODES_H
#define FLAUNAY_CODES_H

#include "arithmetic/language.h"

BEGIN_SHARED

// What kernels that flag elements write: 0 for no, 1 for yes, or one of these.
INTEGER_CONSTANT(FLAG_UNDECIDED, 2);  // by floating point; exact kernels take these up
INTEGER_CONSTANT(FLAG_ON_PATH, 3);    // prune: a vertex of the path itself
INTEGER_CONSTANT(FLAG_TOO_LARGE, 3);  // end game: a region with too many corners for one work-item

// Where a point of a region goes: to the child left or right of the path; or it is on a border.
INTEGER_CONSTANT(SIDE_LEFT, 0);
INTEGER_CONSTANT(SIDE_RIGHT, 1);
INTEGER_CONSTANT(SIDE_BORDER, 2);

// What keep_bounds tells the host: how many elements are to be joined, how many of them are corners, and the most
// corners of a region.
INTEGER_CONSTANT(KEPT_ALL, 0);
INTEGER_CONSTANT(KEPT_CORNERS, 1);
INTEGER_CONSTANT(KEPT_CORNERS_MOST, 2);
INTEGER_CONSTANT(KEPT_FACTS, 3);

// Bits that kernels set when they find an invariant broken, which is an error of the program.
INTEGER_CONSTANT(BROKEN_PATH, 1);    // a point on a cut line is not on its path
INTEGER_CONSTANT(BROKEN_BORDER, 2);  // a region's border does not enclose it
INTEGER_CONSTANT(BROKEN_CIRCLE, 4);  // an edge is not Delaunay

// The account of divide: the places of its numbers.
INTEGER_CONSTANT(RINGS_UNDECIDED, 0);  // predicates that were evaluated exactly
INTEGER_CONSTANT(RINGS_TIES, 1);       // how many of them found cocircular points
INTEGER_CONSTANT(RINGS_BROKEN, 2);     // seams that could not be sewn, which is an error of the program
INTEGER_CONSTANT(RINGS_NUMBERS, 3);

// An edge of a clip polygon, in so many bits; all bits: strictly inside of all edges.
INTEGER_CONSTANT(CLIP_BITS, 14);
INTEGER_CONSTANT(STRICTLY_INSIDE, (1 << CLIP_BITS) - 1);
// An edge that stands in no cell's list.
INTEGER_CONSTANT(NO_SLOT, -0x7fffffff);

// The account of all coordinates: the places of its numbers, and what they are before any coordinate is seen.
INTEGER_CONSTANT(INSPECT_LARGEST, 0);  // the largest exponent of a leading bit
INTEGER_CONSTANT(INSPECT_LOWEST, 1);   // the lowest exponent of a set bit
INTEGER_CONSTANT(INSPECT_BAD, 2);      // the first point that is not finite
INTEGER_CONSTANT(INSPECT_NUMBERS, 3);
INTEGER_CONSTANT(NO_LARGEST, -10000);
INTEGER_CONSTANT(NO_LOWEST, 10000);
INTEGER_CONSTANT(NO_BAD, 0x7fffffff);

// What the insertion of segments tells the host: the places of its numbers.
INTEGER_CONSTANT(INSERTION_WRONG, 0);    // whether a segment is wrong: no points, or of different sets
INTEGER_CONSTANT(INSERTION_CROSSED, 1);  // whether segments cross
INTEGER_CONSTANT(INSERTION_BROKEN, 2);   // whether a walk left the triangulation, which is an error of the program
INTEGER_CONSTANT(INSERTION_LONG, 3);     // how many constraints have walks longer than SHORT_WALK
INTEGER_CONSTANT(INSERTION_PIECES, 4);   // parts of segments that have several
INTEGER_CONSTANT(INSERTION_ROWS, 5);     // how many rows were walked through, of those with long walks
INTEGER_CONSTANT(INSERTION_STOPPED, 6);  // whether walks ended early, because there were too many rows
INTEGER_CONSTANT(INSERTION_NUMBERS, 7);

// What became of a constraint in a round.
INTEGER_CONSTANT(CONSTRAINT_WAITS, 0);
INTEGER_CONSTANT(CONSTRAINT_FITS, 1);       // it holds all rows that it crosses, which are few
INTEGER_CONSTANT(CONSTRAINT_FITS_LONG, 2);  // or many

// A row that no constraint has claimed. Those that a constraint has won are marked with RANK_WON and the round.
#define UNCLAIMED 0xffffffffu
#define RANK_WON 0x80000000u
// With the number on the hull: the place of a vertex of a set without triangles. Of others it is a corner.
#define PLACE_ON_LINE 0x80000000u

END_SHARED

#endif
