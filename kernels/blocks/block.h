// Sorting and halving one block of points by one work-item, as blocks/divide.cl describes it.
#ifndef FLAUNAY_BLOCK_H
#define FLAUNAY_BLOCK_H

#include "arithmetic/language.h"
#include "blocks/halving.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "operations/prefetch.h"
#include "predicates/order.h"

BEGIN_SHARED

#define FETCHED_VERTICES_AHEAD 256
// Edges are used for the first time by the leaves, about in this order.
static inline void fetch_edges_ahead(GLOBAL const ring_edge* edges, int vertex) {
  fetch_bytes(&edges[EDGES_PER_VERTEX * (vertex + FETCHED_VERTICES_AHEAD)],
              LEAF_VERTICES * EDGES_PER_VERTEX * sizeof(ring_edge));
}

// A work-item's own arrays, with room for one block.
typedef struct {
  GLOBAL coordinate2* points;  // distinct, by x
  GLOBAL int* source;
  GLOBAL ranks* by_x;
  GLOBAL ranks* by_y;
  GLOBAL ranks* spare;
  GLOBAL uchar* axes;  // by node
} block_scratch;

// Keeps the heavier of two points in one place, given by index; with equal weights, or without weights, the
// first. The kept point becomes the other one's representative; its complement if the other one is lighter.
static inline int kept_of(int kept, int other, GLOBAL const real* weights, GLOBAL int* representatives) {
  const int sign = weights == 0 ? 0 : (weights[kept] > weights[other]) - (weights[kept] < weights[other]);
  if (sign < 0) {
    representatives[kept] = ~other;
    return other;
  }
  representatives[other] = sign == 0 ? kept : ~kept;
  return kept;
}

// Writes a block's distinct points into scratch, in the order of x, and returns their number. weights: by index of the
// input, or null.
static inline int distinct_by_x(int count, GLOBAL const coordinate2* points, GLOBAL const int* source,
                                GLOBAL const real* weights, const block_scratch* s, GLOBAL int* representatives) {
  fetch_bytes(points, count * sizeof(coordinate2));
  fetch_bytes(source, count * sizeof(int));
  GLOBAL keyed* elements = (GLOBAL keyed*)s->by_x;
  for (int i = 0; i < count; ++i) elements[i] = keyed_place(0, i);
  elements = sort_along(elements, (GLOBAL keyed*)s->by_y, count, points, 0);
  int distinct = 0;
  coordinate2 last = VECTOR(coordinate2, 0, 0);
  for (int i = 0; i < count; ++i) {
    const int from = place_of_keyed(elements[i]);
    const coordinate2 p = points[from];
    if (distinct > 0 && p.x == last.x && p.y == last.y) {
      s->source[distinct - 1] = kept_of(s->source[distinct - 1], source[from], weights, representatives);
    } else {
      s->points[distinct] = last = p;
      s->source[distinct++] = source[from];
    }
  }
  return distinct;
}

static inline void rank(int count, block_scratch* s) {
  GLOBAL keyed* elements = (GLOBAL keyed*)s->by_y;
  // If y is equal, the larger x comes first.
  for (int i = 0; i < count; ++i) elements[i] = keyed_place(0, count - 1 - i);
  elements = sort_along(elements, (GLOBAL keyed*)s->spare, count, s->points, 1);
  if (elements != (GLOBAL keyed*)s->by_y) {
    s->spare = s->by_y;
    s->by_y = (GLOBAL ranks*)elements;
  }
  for (int r = 0; r < count; ++r) {
    const int point = place_of_keyed(elements[r]);
    s->by_y[r] = ranks_of(r, point);
    s->by_x[point] = ranks_of(point, r);
  }
}

// Splits an order stably: ranks below the threshold come first.
static inline void split_order(int count, ranks threshold, GLOBAL ranks* RESTRICT order, GLOBAL ranks* RESTRICT spare) {
  int64 low = 0;
  for (int64 i = 0; i < count; ++i) {
    const ranks both = order[i];
    order[low] = both;  // low <= i
    spare[i - low] = both;
    low += both < threshold;
  }
  for (int64 i = 0; i < count - low; ++i) order[low + i] = spare[i];
}

// Cuts a part at its middle. The order along the axis is split by position, the other one by comparison.
static inline int cut_part(int begin, int middle, int end, const block_scratch* s) {
  const int low = low_quartile(begin, end), high = high_quartile(begin, end);
  const int axis = axis_between(s->points[own_rank(s->by_x[low])], s->points[own_rank(s->by_x[high])],
                                s->points[other_rank(s->by_y[low])], s->points[other_rank(s->by_y[high])]);
  GLOBAL const ranks* const along = axis ? s->by_y : s->by_x;
  GLOBAL ranks* const other = axis ? s->by_x : s->by_y;
  split_order(end - begin, ranks_of(0, own_rank(along[middle])), other + begin, s->spare);
  return axis;
}

// Halves one block, which is not empty, and writes its vertices in the order of the leaves.
static inline void halve_block(int first, int count, const block_scratch* s, GLOBAL coordinate2* points,
                               GLOBAL int* source) {
  const int depth = halving_depth(count);
  for (int d = 0; d < depth; ++d) {
    for (int j = 0; j < 1 << d; ++j) {
      s->axes[(1 << d) + j] =
          cut_part(part_begin(count, d, j), part_begin(count, d + 1, 2 * j + 1), part_begin(count, d, j + 1), s);
    }
  }
  for (int k = 0; k < count; ++k) {
    const int r = own_rank(s->by_x[k]);
    points[first + k] = s->points[r];
    source[first + k] = s->source[r];
  }
}

// A worker's part of the scratch arrays, which has room for `capacity` points from place `base` on.
static inline block_scratch scratch_from(int64 base, int capacity, GLOBAL coordinate2* points, GLOBAL int* source,
                                         GLOBAL uint64* all_ranks, GLOBAL uchar* axes) {
  block_scratch s;
  s.points = points + base;
  s.source = source + base;
  s.by_x = all_ranks + 3 * base;
  s.by_y = s.by_x + capacity;
  s.spare = s.by_y + capacity;
  s.axes = axes + base;
  return s;
}

// Brings the distinct points of one block into the order of the leaves, and returns their number. weights: as of
// distinct_by_x.
static inline int order_block(int first, int count, GLOBAL const real* weights, block_scratch* s,
                              GLOBAL coordinate2* points, GLOBAL int* source, GLOBAL int* representatives) {
  const int distinct = distinct_by_x(count, points + first, source + first, weights, s, representatives);
  rank(distinct, s);
  if (distinct > 0) halve_block(first, distinct, s, points, source);
  return distinct;
}

// The first vertex of node `node` of the cuts' heap, counted from the block's first.
static inline int begin_of_node(int count, int node) {
  const int depth = 31 - (int)clz(node);
  return part_begin(count, depth, node - (1 << depth));
}

END_SHARED

#endif
