// Sizes and numbers of rounds on which kernels and the host agree.
#ifndef FLAUNAY_BLOCKS_LIMITS_H
#define FLAUNAY_BLOCKS_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Room for the edges that cross the seam of a merge: a planar graph each of whose edges joins vertices of two kinds has
// less than twice as many edges as vertices. Fewer edges are removed than cross: n vertices have 3 n - 3 - h edges if
// one goes around their outside along h edges, and a merge adds at most 2 to these of its halves.
INTEGER_CONSTANT(CROSSINGS_PER_VERTEX, 2);
// Work-groups triangulate parts of blocks with at most this many vertices in so many bytes of local memory
// (blocks/local_part.h). At most so many merges are of one height.
INTEGER_CONSTANT(LOCAL_VERTICES, 512);
INTEGER_CONSTANT(LOCAL_PART_BYTES, 43 * 1024);
INTEGER_CONSTANT(LOCAL_MERGES, LOCAL_VERTICES / 8);
// Sorts begin with tiles of this many points, a power of two. There each point is compared with all others.
INTEGER_CONSTANT(SORTED_TILE, 16);
// Work-items of the largest work-group that a kernel with local memory per work-item is made for.
INTEGER_CONSTANT(LARGEST_GROUP, 1024);
// Rounds join the boxes of this many blocks in one step.
INTEGER_CONSTANT(JOINED_BOXES, 16);

// Merges of blocks by single work-items leave polygons with this many consecutive ties, which therefore have
// more than four points, to fans.cl (mesh/rings.h).
INTEGER_CONSTANT(MOST_TIES, 2);

END_SHARED

#endif
