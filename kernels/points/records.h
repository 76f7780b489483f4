// Cut trees, and how points go to blocks and queries to the points, in arrays that kernels and the host share.
#ifndef FLAUNAY_POINTS_RECORDS_H
#define FLAUNAY_POINTS_RECORDS_H

#include "arithmetic/language.h"
#include "arithmetic/numbers.h"
#include "arithmetic/records.h"

BEGIN_SHARED

// A cut, across x or y. Its pivot and a point, both as orderable numbers, are compared by (x, y), or by (y, -x) if turn
// has all bits set: a point goes high unless it comes before the pivot. Nodes are in the order of a heap, from 1 on.
typedef struct {
  uint64 major, minor, turn;
} cut_node;
ASSERT_SIZE(cut_node, 24);

// A tree that is made from samples: its samples [first_sample, first_sample + samples), how many of them a leaf has
// and a chunk has; where its nodes begin; its points. Samples and chunks are leaves times powers of two.
typedef struct {
  int first_sample, samples, leaf, chunk, first_node, first_point, points;
} sampled_tree;
ASSERT_SIZE(sampled_tree, 28);

// A set whose points go to blocks: its first block, its tree's depth, and where the tree's nodes begin. Depth 0: it is
// one block.
typedef struct {
  int block, depth, nodes;
} set_of_blocks;
ASSERT_SIZE(set_of_blocks, 12);

// Points [first, last) that one work-item brings to their blocks. For a set with a tree: its depth, where its
// nodes begin, where the chunk's row of cursors begins, the set's first count, the chunk's number in the set,
// and the set's number of chunks.
typedef struct {
  int first, last, depth, nodes, row, counts, number, chunks;
} chunk_of_points;
ASSERT_SIZE(chunk_of_points, 32);

// Where a block begins: behind point `first`, by as many points as the counts of its set before `count` say. count is
// -1 if the set is one block.
typedef struct {
  int first, count;
} block_place;
ASSERT_SIZE(block_place, 8);

// Two neighbouring parts of a set, by their first blocks, and the node that cuts between them.
typedef struct {
  int low, high, node;
} block_merge;
ASSERT_SIZE(block_merge, 12);

// How a set's queries are scaled, and how much more its points are, which are scaled already: by factors, and in fixed
// point by the powers of two `shift` and `unit`.
typedef struct {
  scaling scale;
  coordinate unit;
  int shift, unused;
} query_frame;
ASSERT_SIZE(query_frame, 40);

END_SHARED

#endif
