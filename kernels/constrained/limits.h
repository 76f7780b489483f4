// Sizes and numbers of rounds on which kernels and the host agree.
#ifndef FLAUNAY_CONSTRAINED_LIMITS_H
#define FLAUNAY_CONSTRAINED_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// A departure is searched in this many triangles around one end, then around both: most vertices have fewer.
INTEGER_CONSTANT(STAR_PATIENCE, 8);
// A constraint that crosses at most this many triangles is inserted by one work-item. Its turns are bits of a
// ulong, and the chains of its cavity have at most 4 vertices more.
INTEGER_CONSTANT(SHORT_WALK, 44);
INTEGER_CONSTANT(SHORT_CHAINS, SHORT_WALK + 4);

END_SHARED

#endif
