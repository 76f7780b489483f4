// Codes that kernels write for each other and for the host.
#ifndef FLAUNAY_BLOCKS_CODES_H
#define FLAUNAY_BLOCKS_CODES_H

#include "arithmetic/language.h"

BEGIN_SHARED

// The account of divide: the places of its numbers.
INTEGER_CONSTANT(RINGS_UNDECIDED, 0);  // predicates that were evaluated exactly
INTEGER_CONSTANT(RINGS_TIES, 1);       // how many of them found cocircular points
INTEGER_CONSTANT(RINGS_TIES_LEFT, 2);  // how many of these left edges as they were
INTEGER_CONSTANT(RINGS_BROKEN, 3);     // seams not sewn, and parts whose stars differ: an error of the program
INTEGER_CONSTANT(RINGS_NUMBERS, 4);

END_SHARED

#endif
