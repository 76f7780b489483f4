// The parts into which blocks are halved: see blocks/halves.h, and blocks/local_part.h for parts in local memory.
#ifndef FLAUNAY_PARTS_H
#define FLAUNAY_PARTS_H

#include "arithmetic/language.h"
#include "blocks/halving.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"

BEGIN_SHARED

// The arrays of all blocks. parts: by half the place of the first vertex of a part; a whole block's is in `solved`.
typedef struct {
  int places;
  GLOBAL const int* offsets;
  GLOBAL const int* distinct;
  GLOBAL const int* block_of_place;  // -1 behind the last block
  GLOBAL const uchar* axes;
  RINGS_MEMORY solved_block* parts;
  GLOBAL solved_block* solved;
} halved_blocks;

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

// The halves of a part, by the number of its first vertex: their places in `parts`, the first vertex of the high one,
// and one vertex behind it. part.block is -1 if there is no part.
typedef struct {
  block_part part;
  int axis, low_at, high_at, begin, middle, end;
} part_halves;

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
