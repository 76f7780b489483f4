// The leaves of all blocks, and merges of their halves and of blocks. With RINGS_STOP they stop at a predicate that
// floating point cannot decide, and a program without it continues them.
#ifndef FLAUNAY_HALVES_H
#define FLAUNAY_HALVES_H

#include "blocks/halving.h"
#include "blocks/limits.h"
#include "blocks/parts.h"
#include "blocks/records.h"
#include "blocks/seams.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "points/records.h"

BEGIN_SHARED

static inline void finish_part(rings* g, const halved_blocks* blocks, block_part part, hull_ends ends) {
  if (part.depth == 0) {
    // The edges of places without vertices are the block's, too.
    const int from = part.first + part.count, end = blocks->offsets[part.block + 1];
    const free_edges none = {NO_EDGE, NO_EDGE}, spare = {edge_at(from), edge_at(end) - 2};
    join_free_lists(g, free_list(g), from < end ? spare : none);
  }
  const solved_block done = {ends, free_list(g)};
  if (part.depth == 0) {
    blocks->solved[part.block] = done;
  } else {
    blocks->parts[(part.first + part.begin) / 2] = done;
  }
}

// The leaf that begins at a place, if one does, whose edges are then free. Frees the edges of a place without a vertex.
static inline block_part begin_leaf(rings* g, const halved_blocks* blocks, int place) {
  const int block = blocks->block_of_place[place];
  if (block >= 0 && place >= blocks->offsets[block] + blocks->distinct[block]) {
    free_place(g->edges, g->vertex_edge, place, blocks->offsets[block + 1]);
  }
  block_part part = part_behind(blocks, block, 0, place);
  if (!begins_before(part, place + 1)) part.block = -1;
  g->free_first = g->free_last = NO_EDGE;
  g->unused = edge_at(place);
  return part;
}

static inline void finish_leaf(rings* g, const halved_blocks* blocks, block_part part, hull_ends ends) {
  free_unused(g, edge_at(part.first + part.begin + vertices_of_part(part)));
  finish_part(g, blocks, part, ends);
}

// Makes the leaves that begin at two places, and frees the edges of places without vertices. Returns how far it is.
static inline int make_leaves_of_cell(rings* g, const halved_blocks* blocks, int cell) {
  int state = MERGE_IS_DONE;
  const int end = min(blocks->places, 2 * cell + 2);
  for (int place = 2 * cell; place < end; ++place) {
    const block_part part = begin_leaf(g, blocks, place);
    if (part.block < 0) continue;
    const hull_ends ends = make_leaf(g, place, vertices_of_part(part));
    if (HAS_STOPPED(g)) {
      state = MERGE_IS_NEW;
    } else {
      finish_leaf(g, blocks, part, ends);
    }
  }
  return state;
}

// Merges two sides, or continues to merge them. Returns how far it is. both: the ends of the two.
static inline int merge_sides(rings* g, int state, solved_block low, solved_block high, hull_ends both, int axis) {
  if (state == MERGE_IS_NEW) {
    join_free_lists(g, low.unused, high.unused);
  } else {
    g->free_first = low.unused.first;
    g->free_last = low.unused.last;
  }
  if (low.ends.first_x == NO_VERTEX || high.ends.first_x == NO_VERTEX) return MERGE_IS_DONE;
  return continue_merge(g, state, low.ends, high.ends, both, axis);
}

// The halves of the part of this height that begins in a cell.
static inline part_halves halves_of_cell(const halved_blocks* blocks, int height, int cell) {
  const block_part part = part_of_cell(blocks, height, cell);
  if (part.block >= 0) return halves_of_part(blocks, part);
  return no_halves();
}

// Merges the halves of the part of this height that begins in a cell, if there is one. Returns how far it is.
static inline int merge_halves_of_cell(rings* g, const halved_blocks* blocks, int height, int cell, int state) {
  const part_halves halves = halves_of_cell(blocks, height, cell);
  if (halves.part.block < 0) return MERGE_IS_DONE;
  const solved_block low = blocks->parts[halves.low_at], high = blocks->parts[halves.high_at];
  const hull_ends both = joined_ends(g, low.ends, high.ends, halves.axis);
  state = merge_sides(g, state, low, high, both, halves.axis);
  if (state == MERGE_IS_DONE) {
    finish_part(g, blocks, halves.part, both);
  } else {
    blocks->parts[halves.low_at].unused = free_list(g);
  }
  return state;
}

// Walk w of a height: in cell w / 2, upwards or downwards. Otherwise as walk_of_halves. crossings, removals and
// is_removed: of all upward, then of all downward walks.
static inline seam_walk walk_of_cell(rings* g, const halved_blocks* blocks, int height, int w, seam_walk before,
                                     GLOBAL int2* crossings, GLOBAL int* removals, GLOBAL uchar* is_removed) {
  const part_halves halves = halves_of_cell(blocks, height, w / 2);
  if (halves.part.block < 0) return walk_from(NO_VERTEX, NO_VERTEX, 0, WALK_IS_WHOLE);
  const int is_downward = w & 1, first = is_downward * blocks->places;
  return walk_of_halves(g, blocks, &halves, is_downward, before, crossings + CROSSINGS_PER_VERTEX * first,
                        removals + CROSSINGS_PER_VERTEX * first, is_removed + PAIRS_PER_VERTEX * first);
}

// Does all that begins in a cell: leaves, if the height is 0, or merges. Returns how far it is.
static inline int do_cell(rings* g, const halved_blocks* blocks, int height, int cell, int state) {
  return height == 0 ? make_leaves_of_cell(g, blocks, cell) : merge_halves_of_cell(g, blocks, height, cell, state);
}

// Merges two blocks, or the triangulations into which they were merged. Returns how far it is.
static inline int merge_two_blocks(rings* g, GLOBAL solved_block* solved, block_merge merge, int axis, int state) {
  const solved_block low = solved[merge.low], high = solved[merge.high];
  const hull_ends both = joined_ends(g, low.ends, high.ends, axis);
  state = merge_sides(g, state, low, high, both, axis);
  if (state == MERGE_IS_DONE) solved[merge.low].ends = both;
  solved[merge.low].unused = free_list(g);
  return state;
}

END_SHARED

#endif
