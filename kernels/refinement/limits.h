// Sizes on which kernels of refinement and the host agree.
#ifndef FLAUNAY_REFINEMENT_LIMITS_H
#define FLAUNAY_REFINEMENT_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// A row may have so many constraints.
INTEGER_CONSTANT(SLOTS_PER_ROW, 3);

END_SHARED

#endif
