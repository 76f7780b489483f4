// Codes that kernels write for each other and for the host.
#ifndef FLAUNAY_CONSTRAINED_CODES_H
#define FLAUNAY_CONSTRAINED_CODES_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Numbers that the insertion of segments reports to the host, by their places.
INTEGER_CONSTANT(INSERTION_WRONG, 0);    // whether a segment is wrong: no points, or of different sets
INTEGER_CONSTANT(INSERTION_CROSSED, 1);  // whether segments cross
INTEGER_CONSTANT(INSERTION_BROKEN, 2);   // whether a walk left the triangulation, which is an error of the program
INTEGER_CONSTANT(INSERTION_LONG, 3);     // how many constraints have walks longer than SHORT_WALK
INTEGER_CONSTANT(INSERTION_PIECES, 4);   // parts of segments that have several
INTEGER_CONSTANT(INSERTION_ROWS, 5);     // how many rows were walked through, of those with long walks
INTEGER_CONSTANT(INSERTION_STOPPED, 6);  // whether walks ended early, because there were too many rows
INTEGER_CONSTANT(INSERTION_NUMBERS, 7);

// Outcomes of a constraint in a round.
INTEGER_CONSTANT(CONSTRAINT_WAITS, 0);
INTEGER_CONSTANT(CONSTRAINT_FITS, 1);       // it holds all rows that it crosses, which are few
INTEGER_CONSTANT(CONSTRAINT_FITS_LONG, 2);  // or many

// Marks a row that no constraint has claimed. RANK_WON and the round mark rows that a constraint has won.
#define UNCLAIMED 0xffffffffu
#define RANK_WON 0x80000000u

// With the number on the hull: the place of a vertex of a set without triangles. Other places are corners.
#define PLACE_ON_LINE 0x80000000u

END_SHARED

#endif
