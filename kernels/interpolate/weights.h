// The methods of natural-neighbour interpolation, and how exact their weights are.
#ifndef FLAUNAY_WEIGHTS_H
#define FLAUNAY_WEIGHTS_H

#include "arithmetic/language.h"

BEGIN_SHARED

INTEGER_CONSTANT(SIBSON, 1);
INTEGER_CONSTANT(LAPLACE, 2);

// The errors of a query's weights together, if it has fewer than a thousand neighbours; see docs/exactness.md.
#define NATURAL_ERROR 0x1p-36

END_SHARED

#endif
