// Parts of blocks that a work-group triangulates in local memory: leaves, and all heights of merges from both ends of
// their seams (blocks/seams.h, blocks/sewing.h), up to the part or the whole block. In OpenCL C alone, with
// LOCAL_RINGS.
#ifndef FLAUNAY_LOCAL_PART_H
#define FLAUNAY_LOCAL_PART_H

#include "blocks/codes.h"
#include "blocks/limits.h"
#include "blocks/parts.h"
#include "blocks/records.h"
#include "blocks/rings_account.h"
#include "blocks/seams.h"
#include "blocks/sewing.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "operations/work_group.h"
#include "predicates/records.h"

#define LOCAL_PAIRS (PAIRS_PER_VERTEX * LOCAL_VERTICES)

// A merge of two halves: where its walks meet, how many edges cross its seam, how many pairs of edges are removed, and
// its free list.
typedef struct {
  int meets, count, removed_pairs;
  free_edges unused;
} local_merge;

// The arrays of a work-group. parts: by half the number of the first vertex. is_removed: by pair, by upward and then by
// downward walks. walks: two per merge of a height.
typedef struct {
  coordinate2 points[LOCAL_VERTICES];
  solved_block parts[LOCAL_VERTICES / 2];
  seam_walk walks[2 * LOCAL_MERGES];
  local_merge merges[LOCAL_MERGES];
  short_edge edges[EDGES_PER_VERTEX * LOCAL_VERTICES];
  short vertex_edge[LOCAL_VERTICES];
  uchar is_removed[2 * LOCAL_PAIRS];
  int has_stopped;
} local_arrays;
ASSERT_SIZE(local_arrays, LOCAL_PART_BYTES);

// Part j of this height in it.
static inline block_part part_within(const local_part* p, int height, int j) {
  const int depth = p->part.depth + p->own_height - height, number = (p->part.number << (p->own_height - height)) + j;
  return numbered_part(p->part.block, p->part.first, p->part.count, depth, number);
}

static inline void make_local_leaf(rings* g, local local_arrays* own, block_part part) {
  const int v = part.first + part.begin;
  g->free_first = g->free_last = NO_EDGE;
  g->unused = edge_at(v);
  const hull_ends ends = make_leaf(g, v, vertices_of_part(part));
  if (HAS_STOPPED(g)) {
    atomic_or(&own->has_stopped, 1);
  } else {
    free_unused(g, edge_at(v + vertices_of_part(part)));
    const solved_block leaf = {ends, free_list(g)};
    own->parts[v / 2] = leaf;
  }
}

// Merge j of this height. crossings, removals: of the part, by upward and then by downward walks.
static inline sewing local_sewing(const local_part* p, local local_arrays* own, const halved_blocks* blocks, int height,
                                  int j, global int2* crossings, global int* removals) {
  const part_halves halves = halves_of_part(blocks, part_within(p, height, j));
  const int up = CROSSINGS_PER_VERTEX * halves.begin, down = CROSSINGS_PER_VERTEX * (p->size + halves.begin);
  const sewing s = {
      {own->merges[j].count, halves.middle, own->walks[2 * j], own->walks[2 * j + 1], crossings + up, crossings + down},
      own->edges,
      own->vertex_edge,
      own->is_removed,
      own->is_removed + LOCAL_PAIRS,
      removals + down,
      removals + up};
  return s;
}

static inline void begin_local_merge(rings* g, local local_arrays* own, const sewing* s, part_halves halves, int j) {
  int removed_pairs = s->seam.up.removals;
  for (int k = 0; k < s->seam.down.removals; ++k) {
    const int pair = s->removals_down[k];
    if (!s->is_removed_up[pair]) s->slots[removed_pairs++] = pair;
  }
  local local_merge* const merge = &own->merges[j];
  merge->count = begin_sewing(g, s, own->parts[halves.low_at], own->parts[halves.high_at], merge->meets, removed_pairs);
  merge->removed_pairs = removed_pairs;
  merge->unused = free_list(g);
}

static inline void end_local_merge(const rings* g, local local_arrays* own, const sewing* s, part_halves halves,
                                   local_merge merge, global volatile uint* account) {
  if (merge.count > 0) end_sewing(s, merge.count);
  if (merge.count == 0) atomic_inc(&account[RINGS_BROKEN]);
  const solved_block done = {
      joined_ends(g, own->parts[halves.low_at].ends, own->parts[halves.high_at].ends, halves.axis), merge.unused};
  own->parts[halves.low_at] = done;
}

static inline int vertex_from(int first, int v) { return v < 0 ? v : v + first; }
static inline int edge_from(int first, int e) { return e < 0 ? e : e + edge_at(first); }

static inline solved_block placed_part(solved_block part, int first) {
  const solved_block placed = {
      ends_of(part.ends.first_x + first, part.ends.last_x + first, part.ends.first_y + first, part.ends.last_y + first),
      {edge_from(first, part.unused.first), edge_from(first, part.unused.last)}};
  return placed;
}

// A walk's steps, but for those to its tangent.
#ifdef FLAUNAY_COUNT
static inline int longest_walk(local const seam_walk* walks, int count) {
  int longest = 0;
  for (int w = 0; w < count; ++w) longest = max(longest, walks[w].crossings + walks[w].removals);
  return longest;
}
#define ADD_LONGEST_WALK(chain, walks, count) (chain) += longest_walk(walks, count)
#else
#define ADD_LONGEST_WALK(chain, walks, count)
#endif

// A part that stops is left, with 1 as the state of its group. are_left: only parts with this state are triangulated;
// is_second: those at which the first launch has stopped. is_removed:
// of walks along the seams of larger parts, to be cleared; null if there are none. There may be groups behind the last
// one, which do nothing.
WITH_BARRIERS void solve_local_part(int group, int groups, int block_count, int height, int are_left, int is_second,
                                    halved_blocks blocks, filter_bounds bounds, global const coordinate2* points,
                                    global ring_edge* edges, global int* vertex_edge, global solved_block* parts,
                                    global uchar* is_removed, global int* states, local local_arrays* own,
                                    global volatile uint* account COUNTERS) {
  const int me = get_local_id(0), lanes = get_local_size(0);
  local_part p = local_part_of(&blocks, block_count, min(group, groups - 1), height);
  // Whether stars have done it (blocks/stars.cl).
  if (p.own_height >= 0 && blocks.block_of_place[p.first] < 0) p.own_height = -1;
  const int is_wanted = group < groups && (p.own_height < 0 ? !is_second : !are_left || states[group]);
  if (!is_wanted) p.own_height = -1;
  // Places, too, are counted from the part's first vertex now.
  blocks.axes += p.first;
  blocks.parts = own->parts;
  // The walks' lists are where the part's edges come in the end, which take more room.
  global int2* const crossings = (global int2*)(edges + edge_at(p.first));
  global int* const removals = (global int*)(crossings + 2 * CROSSINGS_PER_VERTEX * p.size);
  rings g = rings_on(own->edges, own->points, own->vertex_edge, bounds);
  const int leaves = p.own_height < 0 ? 0 : 1 << p.own_height;
  const int size = leaves > 0 ? p.size : 0;
  for (int v = me; v < size; v += lanes) own->points[v] = points[p.first + v];
  for (int k = me; k < PAIRS_PER_VERTEX * size; k += lanes) {
    own->is_removed[k] = own->is_removed[LOCAL_PAIRS + k] = 0;
    if (is_removed == 0 || is_second) continue;
    is_removed[PAIRS_PER_VERTEX * p.first + k] = is_removed[PAIRS_PER_VERTEX * (blocks.places + p.first) + k] = 0;
  }
  if (me == 0) own->has_stopped = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int j = me; j < leaves; j += lanes) make_local_leaf(&g, own, part_within(&p, 0, j));
  barrier(CLK_LOCAL_MEM_FENCE);
  int has_stopped = own->has_stopped;
  uint chain = 0;  // of steps
  for (int h = 1; h <= p.own_height; ++h) {
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    const int most = 1 << (p.own_height - h);
    int merges = has_stopped ? 0 : most;
    // Of a warp as few walks as possible, since they diverge.
    const team walkers = team_of(2 * most), sewers = team_of(most);
    for (int w = walkers.first; walkers.rank == 0 && w < 2 * merges; w += walkers.step) {
      const part_halves halves = halves_of_part(&blocks, part_within(&p, h, w / 2));
      const int is_downward = w & 1, list = CROSSINGS_PER_VERTEX * is_downward * p.size;
      own->walks[w] = walk_of_halves(&g, &blocks, &halves, is_downward, walk_from(NO_VERTEX, NO_VERTEX, 0, 0),
                                     crossings + list, removals + list, own->is_removed + is_downward * LOCAL_PAIRS);
      if (!is_downward) {
        own->merges[w / 2].meets = -1;
        own->merges[w / 2].count = 0;
      }
      if (HAS_STOPPED(&g)) atomic_or(&own->has_stopped, 1);
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    has_stopped = own->has_stopped;
    if (has_stopped) merges = 0;
    ADD_LONGEST_WALK(chain, own->walks, 2 * merges);
    for (int j = sewers.first; j < merges; j += sewers.step) {
      const sewing s = local_sewing(&p, own, &blocks, h, j, crossings, removals);
      for (int k = sewers.rank; k < s.seam.down.crossings; k += sewers.size) {
        if (walks_meet(&s.seam, k, own->edges)) own->merges[j].meets = k;
      }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int j = sewers.first; sewers.rank == 0 && j < merges; j += sewers.step) {
      const sewing s = local_sewing(&p, own, &blocks, h, j, crossings, removals);
      begin_local_merge(&g, own, &s, halves_of_part(&blocks, part_within(&p, h, j)), j);
    }
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    for (int j = sewers.first; j < merges; j += sewers.step) {
      const sewing s = local_sewing(&p, own, &blocks, h, j, crossings, removals);
      for (int k = sewers.rank; k < own->merges[j].removed_pairs; k += sewers.size) mark_vertex_edges(&s, s.slots[k]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int j = sewers.first; j < merges; j += sewers.step) {
      const sewing s = local_sewing(&p, own, &blocks, h, j, crossings, removals);
      const int removed_pairs = s.seam.count > 0 ? own->merges[j].removed_pairs : 0;
      for (int k = sewers.rank; k < removed_pairs; k += sewers.size) replace_vertex_edges(&s, s.slots[k]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int j = sewers.first; j < merges; j += sewers.step) {
      const sewing s = local_sewing(&p, own, &blocks, h, j, crossings, removals);
      for (int k = sewers.rank; k < own->merges[j].removed_pairs; k += sewers.size) unmark(&s, s.slots[k]);
      for (int i = sewers.rank; i < s.seam.count; i += sewers.size) sew_crossing(&s, i);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int j = sewers.first; sewers.rank == 0 && j < merges; j += sewers.step) {
      const sewing s = local_sewing(&p, own, &blocks, h, j, crossings, removals);
      end_local_merge(&g, own, &s, halves_of_part(&blocks, part_within(&p, h, j)), own->merges[j], account);
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
  const int is_done = leaves > 0 && !has_stopped;
  if (me == 0 && group < groups && !is_second) states[group] = has_stopped;
  for (int e = me; is_done && e < edge_at(size); e += lanes) {
    const short_edge from = own->edges[e];
    const ring_edge to = {vertex_from(p.first, from.to), edge_from(p.first, from.next),
                          edge_from(p.first, from.previous)};
    edges[edge_at(p.first) + e] = to;
  }
  for (int v = me; is_done && v < size; v += lanes) {
    vertex_edge[p.first + v] = edge_from(p.first, own->vertex_edge[v]);
  }
  // The edges of places without vertices are the block's, too.
  const int is_block = is_wanted && group < block_count;
  const int from = is_block ? blocks.offsets[group] + blocks.distinct[group] : 0;
  const int end = is_block ? blocks.offsets[group + 1] : 0;
  for (int place = from + me; place < end; place += lanes) free_place(edges, vertex_edge, place, end);
  barrier(CLK_GLOBAL_MEM_FENCE);
  if (me == 0 && is_done) {
    const solved_block done = placed_part(own->parts[0], p.first);
    if (p.part.depth > 0) {
      parts[p.first / 2] = done;
      // The walks of the part's own merge look at its high half's ends.
      if (p.own_height > 0) {
        const int middle = halves_of_part(&blocks, p.part).middle;
        parts[(p.first + middle) / 2] = placed_part(own->parts[middle / 2], p.first);
      }
    } else {
      blocks.solved[p.part.block] = done;
      // n vertices have less than 3 n pairs of edges, so that some are free.
      if (from < end) {
        edges[done.unused.last].next = edge_at(from);
        blocks.solved[p.part.block].unused.last = edge_at(end) - 2;
      }
    }
  }
#ifndef RINGS_STOP
  add_to_account(&g, account);
#endif
  // All work-items of a group are there until the last one is done.
  COUNT_STEPS(chain);
}

#endif
