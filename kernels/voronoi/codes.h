// Codes that kernels write for each other and for the host.
#ifndef FLAUNAY_VORONOI_CODES_H
#define FLAUNAY_VORONOI_CODES_H

#include "arithmetic/language.h"

BEGIN_SHARED

// The bits for an edge of a clip polygon; all bits set: strictly inside of all edges.
INTEGER_CONSTANT(CLIP_BITS, 14);
INTEGER_CONSTANT(STRICTLY_INSIDE, (1 << CLIP_BITS) - 1);
// An edge that stands in no cell's list.
INTEGER_CONSTANT(NO_SLOT, -0x7fffffff);

END_SHARED

#endif
