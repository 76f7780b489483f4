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

// 1 if the part is longer in y, by its interquartile ranges.
static inline int axis_of(int begin, int end, GLOBAL const coordinate2* points, GLOBAL const ranks* by_x,
                          GLOBAL const ranks* by_y) {
  const int low = begin + (end - begin) / 4, high = end - 1 - (end - begin) / 4;
  const coordinate width = rounded_difference(points[own_rank(by_x[high])].x, points[own_rank(by_x[low])].x);
  const coordinate height = rounded_difference(points[other_rank(by_y[high])].y, points[other_rank(by_y[low])].y);
  return height > width;
}

END_SHARED

#endif
