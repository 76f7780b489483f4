// Cut trees: how points go down to leaves.
#ifndef FLAUNAY_CUT_TREE_H
#define FLAUNAY_CUT_TREE_H

#include "arithmetic/coordinates.h"
#include "arithmetic/language.h"
#include "arithmetic/records.h"
#include "points/records.h"

BEGIN_SHARED

static inline int cut_axis(cut_node cut) { return cut.turn != 0; }

// A point as cuts of either axis compare it.
typedef struct {
  uint64 major[2], minor[2];
} point_keys;
static inline point_keys keys_of(coordinate2 p) {
  const uint64 x = orderable(p.x), y = orderable(p.y);
  const point_keys keys = {{x, y}, {y, ~x}};
  return keys;
}

// Whether a point goes high. Without branches, since they could not be predicted.
static inline int goes_high(const point_keys* keys, GLOBAL const cut_node* cut) {
  const int axis = cut->turn & 1;
  return is_at_least(keys->major[axis], keys->minor[axis], cut->major, cut->minor);
}

// The part of a rectangle on one side of a cut.
static inline vertex_box cut_rectangle(vertex_box rectangle, cut_node cut, int is_high, scaling scale) {
  const coordinate at = scaled(from_orderable(cut.major), scale);
  if (cut_axis(cut)) {
    if (is_high && at > rectangle.low.y) rectangle.low.y = at;
    if (!is_high && at < rectangle.high.y) rectangle.high.y = at;
  } else {
    if (is_high && at > rectangle.low.x) rectangle.low.x = at;
    if (!is_high && at < rectangle.high.x) rectangle.high.x = at;
  }
  return rectangle;
}

// DESCENTS points go down a tree together, since each step waits for the one before. Compilers keep
// DESCENTS_AT_ONCE of them in registers.
#define DESCENTS 16
#define DESCENTS_AT_ONCE 8

// The leaves of DESCENTS points, counted from 0.
static inline void descend(const point_keys* keys, GLOBAL const cut_node* tree, int depth, int* leaves) {
  for (int first = 0; first < DESCENTS; first += DESCENTS_AT_ONCE) {
    int64 node[DESCENTS_AT_ONCE];
    for (int k = 0; k < DESCENTS_AT_ONCE; ++k) node[k] = 1;
    for (int d = 0; d < depth; ++d) {
      for (int k = 0; k < DESCENTS_AT_ONCE; ++k) node[k] = 2 * node[k] + goes_high(&keys[first + k], &tree[node[k]]);
    }
    for (int k = 0; k < DESCENTS_AT_ONCE; ++k) leaves[first + k] = (int)node[k] - (1 << depth);
  }
}

// The leaves of points [first, last) of the input, DESCENTS at most.
static inline void find_leaves(int first, int last, GLOBAL const coordinate* input, GLOBAL const cut_node* tree,
                               int depth, int* leaves) {
  point_keys keys[DESCENTS];
  for (int k = 0; k < DESCENTS; ++k) keys[k] = keys_of(vload2(min(first + k, last - 1), input));
  descend(keys, tree, depth, leaves);
}

// The leaf of a point, counted from 0.
static inline int leaf_of(coordinate2 p, GLOBAL const cut_node* tree, int depth) {
  const point_keys keys = keys_of(p);
  int node = 1;
  for (int d = 0; d < depth; ++d) node = 2 * node + goes_high(&keys, &tree[node]);
  return node - (1 << depth);
}

END_SHARED

#endif
