// The parts into which blocks are halved: see blocks/halves.h, and blocks/local_part.h for parts in local memory.
//
// A part of a block is a leaf, which has height 0, or the result of merging two parts of the height below. A
// part of height h has at least 2^(h + 1) vertices, unless it is a block of one vertex. So if places are
// divided into cells of that size, at most one part of the height begins in each, and one work-item or
// work-group per cell does it.
#ifndef FLAUNAY_PARTS_H
#define FLAUNAY_PARTS_H

#include "arithmetic/language.h"
#include "blocks/halving.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"

BEGIN_SHARED

// The arrays of all blocks. Parts at other depths are none. parts: by half the place of the first vertex of a part; a
// whole block's is in `solved`.
typedef struct {
  int least_depth, end_depth, places;
  GLOBAL const int* offsets;
  GLOBAL const int* distinct;
  GLOBAL const int* block_of_place;  // -1 behind the last block
  GLOBAL const uchar* axes;
  RINGS_MEMORY solved_block* parts;
  GLOBAL solved_block* solved;
} halved_blocks;

static inline halved_blocks blocks_in(int least_depth, int end_depth, int places, GLOBAL const int* offsets,
                                      GLOBAL const int* distinct, GLOBAL const int* block_of_place,
                                      GLOBAL const uchar* axes, RINGS_MEMORY solved_block* parts,
                                      GLOBAL solved_block* solved) {
  const halved_blocks blocks = {least_depth, end_depth, places, offsets, distinct, block_of_place, axes, parts, solved};
  return blocks;
}

static inline int edge_at(int place) { return EDGES_PER_VERTEX * place; }

// Frees the edges of a place without a vertex, in one list with the edges of all such places up to `end`.
static inline void free_place(GLOBAL ring_edge* edges, GLOBAL int* vertex_edge, int place, int end) {
  vertex_edge[place] = NO_EDGE;
  for (int e = edge_at(place); e < edge_at(place + 1); e += 2) {
    const ring_edge first = {NO_VERTEX, e + 2 < edge_at(end) ? e + 2 : NO_EDGE, e}, second = {NO_VERTEX, e, e};
    edges[e] = first;
    edges[e + 1] = second;
  }
}

// Part `number` of its depth, which begins at vertex `begin` of its block. block: -1 for no part.
typedef struct {
  int block, first, count, depth, number, begin;
} block_part;

static inline block_part numbered_part(int block, int first, int count, int depth, int number) {
  const block_part part = {block, first, count, depth, number, part_begin(count, depth, number)};
  return part;
}

static inline block_part no_part(void) { return numbered_part(-1, 0, 0, 0, 0); }

// The part of this height that begins at the place or, if it must not, behind it. Its block is given.
static inline block_part part_behind(const halved_blocks* blocks, int block, int height, int place) {
  if (block < 0) return no_part();
  const int first = blocks->offsets[block], count = blocks->distinct[block], depth = halving_depth(count) - height;
  if (depth < blocks->least_depth || depth >= blocks->end_depth || count == 0) return no_part();
  const int number = part_from(count, depth, max(0, place - first));
  return number >> depth ? no_part() : numbered_part(block, first, count, depth, number);
}

static inline int vertices_of_part(block_part part) {
  return part_begin(part.count, part.depth, part.number + 1) - part.begin;
}

static inline int begins_before(block_part part, int end) { return part.block >= 0 && part.first + part.begin < end; }

// The part of this height that begins in a cell.
static inline block_part part_of_cell(const halved_blocks* blocks, int height, int cell) {
  const int begin = cell << (height + 1), end = min(blocks->places - begin, 2 << height) + begin;
  block_part part = part_behind(blocks, blocks->block_of_place[begin], height, begin);
  if (!begins_before(part, end)) part = part_behind(blocks, blocks->block_of_place[end - 1], height, begin);
  if (!begins_before(part, end)) part.block = -1;
  return part;
}

// A part that a group does. Its vertices are numbered from 0 on here; `first` is the place of the first one among all
// places. own_height: -1 if there is no part.
typedef struct {
  block_part part;
  int first, size, own_height;
} local_part;

// The part of a group: a block of at most this height, or the part of this height of a larger block that begins in a
// cell.
static inline local_part local_part_of(const halved_blocks* blocks, int block_count, int group, int height) {
  block_part part;
  if (group < block_count) {
    const int count = blocks->distinct[group], is_whole = count > 0 && halving_depth(count) <= height;
    part = numbered_part(is_whole ? group : -1, blocks->offsets[group], count, 0, 0);
  } else {
    part = part_of_cell(blocks, height, group - block_count);
    if (part.depth == 0) part.block = -1;
  }
  local_part p = {part, part.first + part.begin, 0, -1};
  if (part.block >= 0) {
    p.size = vertices_of_part(part);
    p.own_height = halving_depth(part.count) - part.depth;
    p.part.first = -part.begin;
  }
  return p;
}

// The part of a block in its frame j of 2^depth: in each the part of this height that comes there in the order of cuts,
// or a higher one if the block has more of them, or in the first one the whole block, if it is no higher. block: -1 if
// the frame is empty.
static inline block_part part_in_frame(const halved_blocks* blocks, int block, int height, int depth, int j) {
  const int count = blocks->distinct[block], own_depth = min(depth, max(0, halving_depth(count) - height)),
            number = j >> (depth - own_depth);
  return numbered_part(number << (depth - own_depth) == j ? block : -1, blocks->offsets[block], count, own_depth,
                       number);
}

// The place where frame j begins. Places of a block that are no vertices are behind its last part, in that one's frame.
static inline int begin_of_frame(const halved_blocks* blocks, int block, block_part part, int depth, int j) {
  const int shift = depth - part.depth, next = (j + (1 << shift) - 1) >> shift;
  return next >> part.depth ? blocks->offsets[block + 1] : part.first + part_begin(part.count, part.depth, next);
}

static inline hull_ends ends_of_part(const halved_blocks* blocks, block_part part) {
  if (part.block < 0) return no_ends();
  return part.depth == 0 ? blocks->solved[part.block].ends : blocks->parts[(part.first + part.begin) / 2].ends;
}

// The halves of a part, by the number of its first vertex: their places in `parts`, the first vertex of the high one,
// and one vertex behind it. part.block is -1 if there is no part.
typedef struct {
  block_part part;
  int axis, low_at, high_at, begin, middle, end;
} part_halves;

static inline part_halves no_halves(void) {
  const part_halves none = {no_part(), 0, 0, 0, 0, 0, 0};
  return none;
}

static inline part_halves halves_of_part(const halved_blocks* blocks, block_part part) {
  part_halves halves;
  halves.part = part;
  halves.begin = part.first + part.begin;
  halves.middle = part.first + part_begin(part.count, part.depth + 1, 2 * part.number + 1);
  halves.end = part.first + part_begin(part.count, part.depth, part.number + 1);
  halves.low_at = halves.begin / 2;
  halves.high_at = halves.middle / 2;
  halves.axis = blocks->axes[part.first + (1 << part.depth) + part.number];
  return halves;
}

END_SHARED

#endif
