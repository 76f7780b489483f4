// Costs of operations by the rules of docs/counting.md, as the predicates are written: additions,
// multiplications and comparisons of one evaluation.
#ifndef FLAUNAY_COSTS_H
#define FLAUNAY_COSTS_H

#include "arithmetic/language.h"

BEGIN_SHARED

INTEGER_CONSTANT(PROJECT_OPERATIONS, 2);
INTEGER_CONSTANT(DEPTH_OPERATIONS, 12);
INTEGER_CONSTANT(ORIENT_OPERATIONS, 8);
INTEGER_CONSTANT(CIRCLE_OPERATIONS, 30);
// The dot product that goes with an orientation, and the comparison of two angles.
INTEGER_CONSTANT(DOT_OPERATIONS, 3);
INTEGER_CONSTANT(ANGLE_OPERATIONS, 4);
// Which of two points of equal u is the lower one.
INTEGER_CONSTANT(LOWER_OPERATIONS, 4);
// How high above a chord a point can be and matter.
INTEGER_CONSTANT(BAND_OPERATIONS, 6);
// A depth below a tilted line.
INTEGER_CONSTANT(TILT_OPERATIONS, 6);
// The choice of a cut's axis.
INTEGER_CONSTANT(CUT_OPERATIONS, 3);

END_SHARED

#endif
