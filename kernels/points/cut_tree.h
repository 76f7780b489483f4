// Cut trees: how points go down to leaves.
#ifndef FLAUNAY_CUT_TREE_H
#define FLAUNAY_CUT_TREE_H

#include "arithmetic/coordinates.h"
#include "arithmetic/language.h"
#include "arithmetic/records.h"
#include "points/records.h"

BEGIN_SHARED

static inline int cut_axis(cut_node cut) { return cut.turn != 0; }

// Whether a point goes high, by its coordinates as orderable numbers. Without branches, since they could not be
// predicted.
static inline int goes_high(ulong x, ulong y, cut_node cut) {
  const ulong swapped = (x ^ y) & cut.turn;
  const ulong major = x ^ swapped, minor = y ^ swapped ^ cut.turn;
  return is_at_least(major, minor, cut.major, cut.minor);
}

// What is left of a rectangle on the one side of a cut.
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

// Points that go down a tree at the same time: each step waits for the one before.
#define DESCENTS 16

// The leaves of DESCENTS points by their coordinates as orderable numbers, counted from 0.
static inline void descend(const ulong* x, const ulong* y, GLOBAL const cut_node* tree, int depth, int* leaves) {
  int node[DESCENTS];
  for (int k = 0; k < DESCENTS; ++k) node[k] = 1;
  for (int d = 0; d < depth; ++d) {
    for (int k = 0; k < DESCENTS; ++k) node[k] = 2 * node[k] + goes_high(x[k], y[k], tree[node[k]]);
  }
  for (int k = 0; k < DESCENTS; ++k) leaves[k] = node[k] - (1 << depth);
}

// The leaves of points [first, last) of the input, DESCENTS at most.
static inline void find_leaves(int first, int last, GLOBAL const coordinate* input, GLOBAL const cut_node* tree,
                               int depth, int* leaves) {
  ulong x[DESCENTS], y[DESCENTS];
  for (int k = 0; k < DESCENTS; ++k) {
    const coordinate2 p = vload2(min(first + k, last - 1), input);
    x[k] = orderable(p.x);
    y[k] = orderable(p.y);
  }
  descend(x, y, tree, depth, leaves);
}

// The leaf of a point, counted from 0.
static inline int leaf_of(coordinate2 p, GLOBAL const cut_node* tree, int depth) {
  const ulong x = orderable(p.x), y = orderable(p.y);
  int node = 1;
  for (int d = 0; d < depth; ++d) node = 2 * node + goes_high(x, y, tree[node]);
  return node - (1 << depth);
}

END_SHARED

#endif
