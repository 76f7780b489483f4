// Sizes and numbers of rounds on which kernels and the host agree.
#ifndef FLAUNAY_BLOCKS_LIMITS_H
#define FLAUNAY_BLOCKS_LIMITS_H

#include "arithmetic/language.h"
#include "mesh/limits.h"
#include "operations/limits.h"

BEGIN_SHARED

// Room for the edges that cross the seam of a merge: a planar graph each of whose edges joins vertices of two kinds has
// less than twice as many edges as vertices. Fewer edges are removed than cross: n vertices have 3 n - 3 - h edges if
// one goes around their outside along h edges, and a merge adds at most 2 to these of its halves.
INTEGER_CONSTANT(CROSSINGS_PER_VERTEX, 2);
// The most vertices of a part that a work-group triangulates in local memory (blocks/local_part.h), LEAF_VERTICES times
// a power of two; the most merges of a height; and the local memory that this takes.
INTEGER_CONSTANT(LOCAL_VERTICES, 512);
INTEGER_CONSTANT(LOCAL_MERGES, LOCAL_VERTICES / (2 * LEAF_VERTICES));
INTEGER_CONSTANT(LOCAL_PART_BYTES, 42768);
// The most vertices of a unit whose stars work-groups find (blocks/stars.cl), LEAF_VERTICES times a power of two; the
// edges at which a star stops, and the bits of their number; how many stars a work-group joins; and from how many
// vertices, by number, one learns what is near, and the most that are.
INTEGER_CONSTANT(STAR_VERTICES, 2048);
INTEGER_CONSTANT(MOST_STAR, 32);
INTEGER_CONSTANT(STAR_SIZE_BITS, 8);
INTEGER_CONSTANT(STARS_JOINED, 8);
INTEGER_CONSTANT(NEAR_TILE, 16);
INTEGER_CONSTANT(MOST_NEAR, 256);
// The most points of a block that a work-group sorts and halves in local memory (blocks/group_halving.h). Each takes
// four numbers of 16 bits.
INTEGER_CONSTANT(LOCAL_BYTES_PER_BLOCK_POINT, 8);
INTEGER_CONSTANT(LOCAL_BLOCK_POINTS, LOCAL_BYTES / LOCAL_BYTES_PER_BLOCK_POINT);
// Sorts begin with tiles of this many points, a power of two. There each point is compared with all others.
INTEGER_CONSTANT(SORTED_TILE, 16);
// A scan within a team of work-items adds up this many counts in a row.
INTEGER_CONSTANT(SUMMED_ITEMS, 16);
// Rounds join the boxes of this many blocks in one step.
INTEGER_CONSTANT(JOINED_BOXES, 16);
// A step of rank_hull looks this many times as far ahead as the one before.
INTEGER_CONSTANT(HULL_HOPS, 4);

// Merges of blocks by single work-items leave polygons with this many consecutive ties, which therefore have
// more than four points, to fans.cl (mesh/rings.h).
INTEGER_CONSTANT(MOST_TIES, 2);

END_SHARED

#endif
