// Sizes and numbers of rounds on which kernels and the host agree.
#ifndef FLAUNAY_CONSTRAINED_LIMITS_H
#define FLAUNAY_CONSTRAINED_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// A segment's departure is looked for around one end for so many triangles, then around both: most vertices have fewer.
INTEGER_CONSTANT(STAR_PATIENCE, 8);
// A constraint that crosses at most so many triangles is inserted by one work-item. Its turns are bits of a ulong, and
// the chains of its cavity have at most as many vertices and 4 more.
INTEGER_CONSTANT(SHORT_WALK, 44);
INTEGER_CONSTANT(SHORT_CHAINS, SHORT_WALK + 4);

END_SHARED

#endif
