// Sizes and numbers of rounds on which kernels and the host agree.
#ifndef FLAUNAY_LIMITS_H
#define FLAUNAY_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Directed edges that a vertex brings: a planar graph has less than 3 edges per vertex.
INTEGER_CONSTANT(EDGES_PER_VERTEX, 6);
INTEGER_CONSTANT(PAIRS_PER_VERTEX, EDGES_PER_VERTEX / 2);
// Room for the edges that cross the seam of a merge: a planar graph each of whose edges joins vertices of two kinds has
// less than twice as many edges as vertices.
INTEGER_CONSTANT(CROSSINGS_PER_VERTEX, 2);
// Divide and conquer ends with leaves of at most so many vertices.
INTEGER_CONSTANT(LEAF_VERTICES, 4);
// A block of at most so many points, which one cut divides into leaves, needs no work-group of its own.
INTEGER_CONSTANT(TINY_BLOCK, 2 * LEAF_VERTICES);
// Sorts begin with tiles of so many points, a power of two, in which each point is compared with all others.
INTEGER_CONSTANT(SORTED_TILE, 16);

// Work-items of the largest work-group that a kernel with local memory per work-item is made for.
INTEGER_CONSTANT(LARGEST_GROUP, 1024);

// The largest work-group that takes a tile of elements, what local memory has room for.
INTEGER_CONSTANT(LARGEST_TILE_GROUP, 256);
// Kernels with tiles need local memory in proportion to the largest tile, at most LOCAL_BYTES, a power of two, which a
// program's build chooses. By default as much as OpenCL 1.2 guarantees; with less than the least, they cannot be built.
INTEGER_CONSTANT(DEFAULT_LOCAL_BYTES, 1 << 15);
INTEGER_CONSTANT(LEAST_LOCAL_BYTES, 1 << 14);
#ifndef LOCAL_BYTES
#define LOCAL_BYTES DEFAULT_LOCAL_BYTES
#endif
// So many bytes for each point of a tile of points, and for each sample of a tile of samples.
INTEGER_CONSTANT(LOCAL_BYTES_PER_POINT, 16);
INTEGER_CONSTANT(LOCAL_BYTES_PER_SAMPLE, 32);
INTEGER_CONSTANT(LARGEST_POINT_TILE, LOCAL_BYTES / LOCAL_BYTES_PER_POINT);
INTEGER_CONSTANT(LARGEST_SAMPLE_TILE, LOCAL_BYTES / LOCAL_BYTES_PER_SAMPLE);
// A tile of points is sorted by at most so many bits of their blocks' numbers.
INTEGER_CONSTANT(MOST_BLOCK_BITS, 10);
// Sorted runs of samples are merged by so many.
INTEGER_CONSTANT(MERGED_RUNS_BITS, 3);
INTEGER_CONSTANT(MERGED_RUNS, 1 << MERGED_RUNS_BITS);

// Corners of the largest region that one work-item triangulates in private memory, unless a program's build says
// otherwise by SMALL_REGION. At most 64, the bits of a ulong.
INTEGER_CONSTANT(DEFAULT_SMALL_REGION, 48);

// Prune takes one candidate from so many points that are consecutive along the cut line.
INTEGER_CONSTANT(BUCKET, 16);
// Regions with more candidates than this prune them in two steps.
INTEGER_CONSTANT(MANY_CANDIDATES, 256);

// Of so many kept corners in a region, each finds its place by comparing itself with all.
INTEGER_CONSTANT(COUNTED_CORNERS, 256);

// Quickhull splits at deepest points for so many rounds, then it balances its splits. No input has been seen to take
// more that was not made to.
INTEGER_CONSTANT(MOST_QUICKHULL_ROUNDS, 64);
// The same for Hull::balanced: what the paper's authors found to serve skewed input well.
INTEGER_CONSTANT(ROUNDS_BEFORE_BALANCE, 4);
// Dropping vertices that are not strictly below their neighbours' segment can lay bare one vertex at a time. After so
// many rounds quickhull sorts out what is left.
INTEGER_CONSTANT(CLEAN_UP_ROUNDS, 8);

// Rounds join the boxes of so many blocks in one step.
INTEGER_CONSTANT(JOINED_BOXES, 16);

// A segment's departure is looked for around one end for so many triangles, then around both: most vertices have fewer.
INTEGER_CONSTANT(STAR_PATIENCE, 8);
// A constraint that crosses at most so many triangles is inserted by one work-item. Its turns are bits of a ulong, and
// the chains of its cavity have at most as many vertices and 4 more.
INTEGER_CONSTANT(SHORT_WALK, 44);
INTEGER_CONSTANT(SHORT_CHAINS, SHORT_WALK + 4);

END_SHARED

#endif
