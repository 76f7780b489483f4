// Structs that kernels and the host share, as kernels' arguments and in arrays in device memory.
#ifndef FLAUNAY_RECORDS_H
#define FLAUNAY_RECORDS_H

#include "arithmetic/language.h"
#include "arithmetic/numbers.h"

BEGIN_SHARED

// Bounds of the predicates' filters: HULL_DEPTH_BOUND, ORIENT_BOUND and CIRCLE_BOUND of predicates/bounds.h, or 0 where
// the input is so coarse that floating point is exact. In fixed point, `coarse` says instead that products of
// differences fit into 64 bits (COARSE_FIXED_BITS).
typedef struct {
  filter_bound hull, orient, circle;
  int coarse;
} filter_bounds;
ASSERT_SIZE(filter_bounds, 16);

// Coordinates are scaled by the product of three powers of two, which may be no double itself. Those in fixed point
// are scaled already.
typedef struct {
  coordinate s0, s1, s2;
} scaling;
ASSERT_SIZE(scaling, 24);

// A directed edge e in the ring of its origin; its reverse is e ^ 1. (Quad-edges without the dual half.)
typedef struct {
  int to;        // vertex, or NO_VERTEX for a free edge
  int next;      // counter-clockwise about the origin; of a free edge the next free one
  int previous;  // clockwise
} ring_edge;
ASSERT_SIZE(ring_edge, 12);

// The first and the last vertex in the orders (x, y) and (y, -x). All are corners of the hull, strictly convex.
// NO_VERTEX, all of them, if there is no vertex.
typedef struct {
  int first_x, last_x, first_y, last_y;
} hull_ends;
ASSERT_SIZE(hull_ends, 16);

// A list of free edges by its first and its last one; NO_EDGE, both of them, if it is empty.
typedef struct {
  int first, last;
} free_edges;
ASSERT_SIZE(free_edges, 8);

// A block's triangulation; of the first of blocks that were merged, that of them all.
typedef struct {
  hull_ends ends;
  free_edges unused;
} solved_block;
ASSERT_SIZE(solved_block, 24);

// A walk along the seam of a merge: the vertices of its first crossing edge, of which a downward walk has the high
// side's as its left one, and the hull edges out of them that it saw there; how many crossing edges it has, and how it
// ended.
typedef struct {
  int left, right, left_edge, right_edge;
  int crossings, outcome;
} seam_walk;
ASSERT_SIZE(seam_walk, 24);

// A cut, across x or y. Its pivot and a point, both as orderable numbers, are compared by (x, y), or by (y, -x) if turn
// has all bits set: a point goes high unless it comes before the pivot. Nodes are in the order of a heap, from 1 on.
typedef struct {
  ulong major, minor, turn;
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

// Points [first, last) that one work-item brings to their blocks. Of a set with a tree: its depth, where its nodes
// begin, where the chunk's row of cursors begins, the set's first count, the chunk's number in the set, and the set's
// number of chunks.
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

// A triangle: its corners, and for each the triangle opposite, or -1.
typedef struct {
  int corner[3], neighbor[3];
} face;
ASSERT_SIZE(face, 24);

// How a set's queries are scaled, and how much more its points are, which are scaled already: by factors, and in fixed
// point by the powers of two `shift` and `unit`.
typedef struct {
  scaling scale;
  coordinate unit;
  int shift, unused;
} query_frame;
ASSERT_SIZE(query_frame, 40);

// A set of a locator: where its tree's nodes begin, the tree's depth, where its leaves' starts begin, its number of
// triangles, and where its hull begins and ends.
typedef struct {
  int nodes, depth, starts, triangles, hull, hull_end;
} mesh_set;
ASSERT_SIZE(mesh_set, 24);

// Of a triangle in the fan of a cocircular polygon, unless it is the last one, counter-clockwise about the fan's first
// vertex: that vertex, and the last triangle. Of others: -1 and the triangle itself.
typedef struct {
  int vertex, last;
} fan_part;
ASSERT_SIZE(fan_part, 8);

// A box around vertices, its sides parallel to the axes.
typedef struct {
  coordinate2 low, high;
} vertex_box;
ASSERT_SIZE(vertex_box, 32);

// Where a block of points lies in its set. All other points of the round are on or beyond the sides of its rectangle,
// which are infinite where there are none beyond; `all` is the box around the set. outside: if the block's hull has
// three vertices, the three edges that have the outside on their left; otherwise NO_EDGE.
typedef struct {
  vertex_box rectangle, all;
  int outside[3];
} block_frame;
ASSERT_SIZE(block_frame, 80);

// An edge of which the triangles on one side are emitted and those on the other are not, seen from one of its
// vertices: the other vertex, or NO_VERTEX for the ray to infinity from a vertex of the hull; the place of the emitted
// corner opposite to it, or GHOST; and whether the side that is open begins at it, counter-clockwise.
typedef struct {
  int to, corner, begins;
} open_edge;
ASSERT_SIZE(open_edge, 12);

// A constraint that is not inserted yet: the corner of its vertex `origin` opposite to the first edge that it crosses
// on the way to the vertex `goal`; how many rows it crosses; and where the walk turned, a bit per row after the first:
// 1 if the row's vertex is on the left. rows is 0 if the constraint is an edge already, which is opposite to the
// corner.
typedef struct {
  int origin, goal, corner, rows;
  ulong turns;
} constraint_walk;
ASSERT_SIZE(constraint_walk, 24);

// A vertex of a chain that bounds the rows that a constraint crosses; the side from it to the next one: the corner of
// the row inside that is opposite to it, -1 at the end of the chain; twice the corner beyond it and 2, or 0 on the
// hull, and 1 if it is a constraint. Also a row, which has nothing to do with the vertex.
typedef struct {
  int vertex, corner;
  uint side;
  int row;
} chain_entry;
ASSERT_SIZE(chain_entry, 16);

// A vertex of a chain that is triangulated, by positions in the chain. Of the polygon of those vertices that are
// inserted: the next one, and the half-edge inside of the edge to it. Then the vertices between which it is inserted.
typedef struct {
  int next, inside, before, after;
} chain_vertex;
ASSERT_SIZE(chain_vertex, 16);

// A half-edge of a chain's triangulation.
typedef struct {
  int origin, twin;
} chain_edge;
ASSERT_SIZE(chain_edge, 8);

END_SHARED

#endif
