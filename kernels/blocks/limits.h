// Sizes and numbers of rounds on which kernels and the host agree.
#ifndef FLAUNAY_BLOCKS_LIMITS_H
#define FLAUNAY_BLOCKS_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Room for the edges that cross the seam of a merge: a planar graph each of whose edges joins vertices of two kinds has
// less than twice as many edges as vertices.
INTEGER_CONSTANT(CROSSINGS_PER_VERTEX, 2);
// Sorts begin with tiles of so many points, a power of two, in which each point is compared with all others.
INTEGER_CONSTANT(SORTED_TILE, 16);
// Work-items of the largest work-group that a kernel with local memory per work-item is made for.
INTEGER_CONSTANT(LARGEST_GROUP, 1024);
// Rounds join the boxes of so many blocks in one step.
INTEGER_CONSTANT(JOINED_BOXES, 16);

// Polygons with so many ties in a row, which has shown that they have more than four points, are left to fans.cl by
// merges of blocks by single work-items (mesh/rings.h).
INTEGER_CONSTANT(MOST_TIES, 2);

END_SHARED

#endif
