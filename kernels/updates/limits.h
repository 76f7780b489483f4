// Sizes on which kernels of updates and the host agree.
#ifndef FLAUNAY_UPDATES_LIMITS_H
#define FLAUNAY_UPDATES_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Vertices with more triangles around them, with ghosts, are not removed one by one: on average there are six.
INTEGER_CONSTANT(MOST_AROUND, 40);
// A walk tests each triangle's sides in turn for this many steps, which is faster. Then it goes straight ahead,
// which ends in any triangulation.
INTEGER_CONSTANT(WALK_STEPS, 100);

END_SHARED

#endif
