// How a block's vertices are cut in halves, down to leaves of one to four vertices: into 2^depth parts of equal size,
// but for one vertex. Parts are counted from 0 in each depth; plus 2^depth, the numbers form a heap.
#ifndef FLAUNAY_HALVING_H
#define FLAUNAY_HALVING_H

#include "arithmetic/language.h"
#include "arithmetic/numbers.h"
#include "mesh/limits.h"

BEGIN_SHARED

// A point in the order of one axis: its rank in the other order, in the upper half, and in this one, in the lower half.
// So one comparison tells on which side of a cut across the other axis it lies. Rank in x is the number of the point.
typedef uint64 ranks;
static inline ranks ranks_of(int own, int other) { return (uint64)other << 32 | (uint)own; }
static inline int own_rank(ranks both) { return (int)(uint)both; }
static inline int other_rank(ranks both) { return (int)(both >> 32); }

// More than the depth of any part.
INTEGER_CONSTANT(MOST_DEPTH, 32);

// The least depth at which all parts are leaves.
static inline int halving_depth(int count) {
  return count <= LEAF_VERTICES ? 0 : 32 - (int)clz((count - 1) / LEAF_VERTICES);
}

// Where part j begins, of the 2^depth parts into which count vertices are cut.
static inline int part_begin(int count, int depth, int j) { return (int)(((int64)j * count) >> depth); }

// The first part that begins at vertex k or behind it.
static inline int part_from(int count, int depth, int k) { return (int)((((int64)k << depth) + count - 1) / count); }

// The quartiles of a part's points along an axis.
static inline int low_quartile(int begin, int end) { return begin + (end - begin) / 4; }
static inline int high_quartile(int begin, int end) { return end - 1 - (end - begin) / 4; }

// Which axis a part is cut across: 1 if it is longer in y, by the points at its quartiles along x and along y.
static inline int axis_between(coordinate2 left, coordinate2 right, coordinate2 bottom, coordinate2 top) {
  return rounded_difference(top.y, bottom.y) > rounded_difference(right.x, left.x);
}

END_SHARED

#endif
