// Merges of large halves on devices with many lanes, from both ends of their seam at once: see blocks/seams.h. A launch
// of walk_seams for the halves of one height has two work-items per merge, which read, and only list the edges that
// cross the seam and mark those that go. Walks that stopped are continued by finish_walks of blocks/merge_exact.cl; in
// fixed point none stops, since exact predicates of integers take few registers and no stack to speak of. A launch of
// sew_seams then has a work-group per merge: it gives each crossing edge a free pair of edges and its place in
// the rings. Each is one pass over the parts that begin in the cells of that height (blocks/halves.h).
//
// Walks that do not meet would be an error of the program. Such halves stay as they are, which is safe for all later
// kernels, and the account tells the host.

#ifndef FIXED_POINT
#define RINGS_STOP
#endif
#include "blocks/arguments.h"
#include "blocks/codes.h"
#include "blocks/halves.h"
#include "blocks/limits.h"
#include "blocks/records.h"
#include "blocks/rings_account.h"
#include "blocks/seams.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "operations/limits.h"
#include "operations/spread.h"
#include "operations/work_group.h"
#include "predicates/records.h"

kernel void walk_seams(int n, int spread, PLACES_OF_PARTS(), filter_bounds bounds,
                       global const coordinate2* restrict points, global ring_edge* restrict edges,
                       global int* restrict vertex_edge, global solved_block* restrict parts,
                       global solved_block* restrict solved, global int2* restrict crossings,
                       global int* restrict removals, global uchar* restrict is_removed, global seam_walk* walks,
                       global volatile uint* account COUNTERS) {
  const int w = spread_item(n, spread);
  if (w < n) {
    const halved_blocks blocks = blocks_in(places, offsets, distinct, block_of_place, axes, parts, solved);
    rings g = rings_on(edges, points, vertex_edge, bounds);
    const seam_walk before = walk_from(NO_VERTEX, NO_VERTEX, 0, WALK_HAS_STOPPED);
    walks[w] = walk_of_cell(&g, &blocks, height, w, before, crossings, removals, is_removed);
#ifndef RINGS_STOP
    add_to_account(&g, account);
#endif
    COUNT_STEPS(g.counted.steps);
  }
}

SCAN_IN_GROUP(sum_before, uint)

// The data of a work-group for its merge. is_removed_up and is_removed_down: by pair of edges, by either walk.
// removals_down: the list of the downward walk. slots: the pairs that crossing edges get; its first ones are the list
// of the upward walk.
typedef struct {
  whole_seam seam;
  global ring_edge* edges;
  global int* vertex_edge;
  global uchar* is_removed_up;
  global uchar* is_removed_down;
  global const int* removals_down;
  global int* slots;
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

// Takes free edges from the list for the crossing edges from `from` on. Returns whether there are enough.
static inline int take_free_pairs(rings* g, const sewing* s, int from, int count) {
  for (int k = from; k < count; ++k) {
    if (g->free_first == NO_EDGE) return 0;
    s->slots[k] = g->free_first / 2;
    g->free_first = g->edges[g->free_first].next;
  }
  return 1;
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

kernel void sew_seams(PLACES_OF_PARTS(), global const coordinate2* restrict points,
                      global const int2* restrict crossings, global const seam_walk* restrict walks,
                      global ring_edge* edges, global int* vertex_edge, global solved_block* parts,
                      global solved_block* solved, global int* removals, global uchar* is_removed,
                      global volatile uint* account COUNTERS) {
  local uint sums[LARGEST_TILE_GROUP];
  local int meets;    // the downward walk's edge that is the last one of the upward walk, or -1
  local int is_sewn;  // whether all is as it should be
  const int cell = get_group_id(0), me = get_local_id(0), lanes = get_local_size(0);
  const halved_blocks blocks = blocks_in(places, offsets, distinct, block_of_place, axes, parts, solved);
  const part_halves halves = halves_of_cell(&blocks, height, cell);
  const int is_merge = halves.part.block >= 0, begin = is_merge ? halves.begin : 0;
  const int list_up = CROSSINGS_PER_VERTEX * begin, list_down = CROSSINGS_PER_VERTEX * (places + begin);
  const sewing s = {
      {0, halves.middle, walks[2 * cell], walks[2 * cell + 1], crossings + list_up, crossings + list_down},
      edges,
      vertex_edge,
      is_removed,
      is_removed + PAIRS_PER_VERTEX * places,
      removals + list_down,
      removals + list_up};
  const int up = s.seam.up.removals, down = s.seam.down.removals;
  if (me == 0) meets = -1;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int k = me; k < s.seam.down.crossings; k += lanes) {
    if (walks_meet(&s.seam, k, edges)) meets = k;
  }
  // The removals of the downward walk alone.
  uint own = 0, all;
  for (int k = me; k < down; k += lanes) own += !s.is_removed_up[s.removals_down[k]];
  uint slot = up + sum_before(own, sums, &all);
  for (int k = me; k < down; k += lanes) {
    const int pair = s.removals_down[k];
    if (!s.is_removed_up[pair]) s.slots[slot++] = pair;
  }
  const int removed_pairs = up + all, count = s.seam.up.crossings + meets;
  barrier(CLK_GLOBAL_MEM_FENCE | CLK_LOCAL_MEM_FENCE);
  for (int k = me; k < removed_pairs; k += lanes) mark_vertex_edges(&s, s.slots[k]);
  const filter_bounds none = {0, 0, 0, 0};
  rings g = rings_on(edges, points, vertex_edge, none);
  if (me == 0 && is_merge) {
    join_free_lists(&g, parts[halves.low_at].unused, parts[halves.high_at].unused);
    const free_edges joined = free_list(&g);
    // A walk that has stopped has an incomplete list.
    is_sewn = s.seam.up.outcome != WALK_HAS_STOPPED && s.seam.down.outcome != WALK_HAS_STOPPED && meets >= 0 &&
              count >= removed_pairs && take_free_pairs(&g, &s, removed_pairs, count);
    g.free_first = is_sewn ? g.free_first : joined.first;
    g.free_last = g.free_first == NO_EDGE ? NO_EDGE : joined.last;
  }
  barrier(CLK_GLOBAL_MEM_FENCE | CLK_LOCAL_MEM_FENCE);
  const int is_whole = is_merge && is_sewn;
  for (int k = me; is_whole && k < removed_pairs; k += lanes) replace_vertex_edges(&s, s.slots[k]);
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int k = me; k < removed_pairs; k += lanes) s.is_removed_up[s.slots[k]] = s.is_removed_down[s.slots[k]] = 0;
  sewing sewn = s;
  sewn.seam.count = count;
  for (int i = me; is_whole && i < count; i += lanes) sew_crossing(&sewn, i);
  // A step is a removed pair, a free pair or a crossing edge.
  COUNT_STEPS(is_whole ? (removed_pairs + count) / lanes + (me == 0 ? count - removed_pairs : 0) : 0);
  barrier(CLK_GLOBAL_MEM_FENCE);
  if (me == 0 && is_merge) {
    if (is_whole) {
      const int lowest = crossing_from(&s, 0, 0), highest = crossing_from(&s, count - 1, 1);
      vertex_edge[edges[lowest ^ 1].to] = lowest;
      vertex_edge[edges[highest ^ 1].to] = highest;
    } else {
      atomic_inc(&account[RINGS_BROKEN]);
    }
    finish_part(&g, &blocks, halves.part,
                joined_ends(&g, parts[halves.low_at].ends, parts[halves.high_at].ends, halves.axis));
  }
}
