// Puts the edges that cross the seam of a merge into the rings of its halves, when both walks have listed them
// (blocks/seams.h). Work-items share the steps, with a barrier between each two: begin_sewing once and
// mark_vertex_edges, replace_vertex_edges, unmark and sew_crossing, and end_sewing once.
#ifndef FLAUNAY_SEWING_H
#define FLAUNAY_SEWING_H

#include "arithmetic/language.h"
#include "blocks/records.h"
#include "blocks/seams.h"
#include "mesh/records.h"
#include "mesh/rings.h"

BEGIN_SHARED

// The data of work-items for their merge. is_removed_up and is_removed_down: by pair of edges, by either walk.
// removals_down: the list of the downward walk. slots: the pairs that crossing edges get; its first ones are the list
// of the upward walk.
typedef struct {
  whole_seam seam;
  RINGS_MEMORY edge_in_rings* edges;
  RINGS_MEMORY ring_index* vertex_edge;
  RINGS_MEMORY uchar* is_removed_up;
  RINGS_MEMORY uchar* is_removed_down;
  GLOBAL const int* removals_down;
  GLOBAL int* slots;
} sewing;

static inline int is_pair_removed(const sewing* s, int pair) {
  return s->is_removed_up[pair] || s->is_removed_down[pair];
}

// Marks a removed pair, and of each half whether it is the edge of its vertex.
#define REMOVED_HALF(k) (2 << (k))
static inline void mark_vertex_edges(const sewing* s, int pair) {
  int mark = 1;
  for (int k = 0; k < 2; ++k) {
    const int e = 2 * pair + k;
    if (s->vertex_edge[s->edges[e ^ 1].to] == e) mark |= REMOVED_HALF(k);
  }
  s->is_removed_up[pair] = mark;
}

// Gives vertices whose edges go other ones, which stay: each has one along the seam.
static inline void replace_vertex_edges(const sewing* s, int pair) {
  const int mark = s->is_removed_up[pair];
  for (int k = 0; k < 2; ++k) {
    if (!(mark & REMOVED_HALF(k))) continue;
    int e = 2 * pair + k;
    const int v = s->edges[e ^ 1].to;
    while (is_pair_removed(s, e / 2)) e = s->edges[e].next;
    s->vertex_edge[v] = e;
  }
}

static inline void unmark(const sewing* s, int pair) { s->is_removed_up[pair] = s->is_removed_down[pair] = 0; }

// Gives crossing edges the pairs of removed edges, which are listed, and as many of both halves' free ones as they
// still need; the others are the free list then. meets: the downward walk's edge that is the last one of the upward
// walk, or -1. Returns the number of crossing edges, or 0 if something is wrong; then all edges stay as they are.
static inline int begin_sewing(rings* g, const sewing* s, solved_block low, solved_block high, int meets,
                               int removed_pairs) {
  const int count = s->seam.up.crossings + meets;
  join_free_lists(g, low.unused, high.unused);
  const free_edges joined = free_list(g);
  // A walk that has stopped has incomplete lists.
  int is_right = s->seam.up.outcome != WALK_HAS_STOPPED && s->seam.down.outcome != WALK_HAS_STOPPED && meets >= 0 &&
                 count >= removed_pairs;
  for (int k = removed_pairs; is_right && k < count; ++k) {
    is_right = g->free_first != NO_EDGE;
    if (!is_right) break;
    s->slots[k] = g->free_first / 2;
    g->free_first = g->edges[g->free_first].next;
  }
  if (!is_right) g->free_first = joined.first;
  if (g->free_first == NO_EDGE) g->free_last = NO_EDGE;
  return is_right ? count : 0;
}

// The half of crossing edge i with this end as its origin.
static inline int crossing_from(const sewing* s, int i, int is_high_end) {
  return 2 * s->slots[i] + (is_high_end ? 0 : 1);
}

// Writes the half of crossing edge i out of v, which leads to another vertex. At the low end, edges above come next; at
// the high end, edges below. Edges of the sides are beside the first and the last crossing edge of each visit to v:
// `lowest` and `highest` at the ends of the seam. But where a seam goes around one side, and so begins and ends at the
// same vertex of it, the first and the last crossing edge are neighbours.
static inline void sew_half(const sewing* s, int i, int v, int to, int is_high_end, int lowest, int highest,
                            int around) {
  const int own = crossing_from(s, i, is_high_end), last = s->seam.count - 1;
  const int from = i > 0 ? edge_into(&s->seam, i) : NO_EDGE, onward = i < last ? edge_into(&s->seam, i + 1) : NO_EDGE;
  int below = i > 0 ? crossing_from(s, i - 1, is_high_end) : around ? crossing_from(s, last, is_high_end) : lowest;
  int above = i < last ? crossing_from(s, i + 1, is_high_end) : around ? crossing_from(s, 0, is_high_end) : highest;
  int comes = i == 0 && !around, goes = i == last && !around;
  if (from != NO_EDGE && s->edges[from].to == v) {
    comes = 1;
    below = from ^ 1;
  }
  if (onward != NO_EDGE && s->edges[onward ^ 1].to == v) {
    goes = 1;
    above = onward;
  }
  s->edges[own].to = to;
  s->edges[own].next = is_high_end ? below : above;
  s->edges[own].previous = is_high_end ? above : below;
  if (comes) *(is_high_end ? &s->edges[below].previous : &s->edges[below].next) = own;
  if (goes) *(is_high_end ? &s->edges[above].next : &s->edges[above].previous) = own;
}

static inline void sew_crossing(const sewing* s, int i) {
  const int2 ends = crossing_at(&s->seam, i, s->edges), lowest = crossing_at(&s->seam, 0, s->edges);
  const int2 highest = crossing_at(&s->seam, s->seam.count - 1, s->edges);
  const int is_long = s->seam.count > 1;
  sew_half(s, i, ends.x, ends.y, 0, s->seam.up.left_edge, s->seam.down.right_edge, is_long && lowest.x == highest.x);
  sew_half(s, i, ends.y, ends.x, 1, s->seam.up.right_edge, s->seam.down.left_edge, is_long && lowest.y == highest.y);
}

// The ends of the seam are on the hull.
static inline void end_sewing(const sewing* s, int count) {
  const int lowest = crossing_from(s, 0, 0), highest = crossing_from(s, count - 1, 1);
  s->vertex_edge[s->edges[lowest ^ 1].to] = lowest;
  s->vertex_edge[s->edges[highest ^ 1].to] = highest;
}

END_SHARED

#endif
