// Codes that kernels write for each other and for the host.
#ifndef FLAUNAY_POINTS_CODES_H
#define FLAUNAY_POINTS_CODES_H

#include "arithmetic/language.h"

BEGIN_SHARED

// The account of all coordinates: the places of its numbers. Before any coordinate is seen they are NO_LARGEST,
// NO_LOWEST and NO_BAD.
INTEGER_CONSTANT(INSPECT_LARGEST, 0);  // the largest exponent of a leading bit
INTEGER_CONSTANT(INSPECT_LOWEST, 1);   // the lowest exponent of a set bit
INTEGER_CONSTANT(INSPECT_BAD, 2);      // the first point that is not finite
INTEGER_CONSTANT(INSPECT_NUMBERS, 3);

END_SHARED

#endif
