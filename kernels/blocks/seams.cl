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
#include "blocks/sewing.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "operations/limits.h"
#include "operations/spread.h"
#include "operations/work_group.h"
#include "predicates/records.h"

kernel void walk_seams(int n, int spread, PLACES_OF_PARTS(), filter_bounds bounds, RINGS_OF_PARTS(),
                       global int2* restrict crossings, global int* restrict removals,
                       global uchar* restrict is_removed, global seam_walk* walks,
                       global volatile uint* account COUNTERS) {
  const int w = spread_item(n, spread);
  if (w < n) {
    const halved_blocks blocks =
        blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, parts, solved);
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

kernel void sew_seams(int cells, PLACES_OF_PARTS(), RINGS_OF_PARTS(), global const int2* restrict crossings,
                      global const seam_walk* restrict walks, global int* removals, global uchar* is_removed,
                      global volatile uint* account COUNTERS) {
  local uint sums[LARGEST_TILE_GROUP];
  local int meets, count;  // see begin_sewing
  const int cell = get_group_id(0), me = get_local_id(0), lanes = get_local_size(0);
  const halved_blocks blocks =
      blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, parts, solved);
  // There may be groups behind the last cell.
  const part_halves halves = cell < cells ? halves_of_cell(&blocks, height, cell) : no_halves();
  const int is_merge = halves.part.block >= 0, begin = is_merge ? halves.begin : 0;
  const int list_up = CROSSINGS_PER_VERTEX * begin, list_down = CROSSINGS_PER_VERTEX * (places + begin);
  const seam_walk none_walked = walk_from(NO_VERTEX, NO_VERTEX, 0, WALK_IS_WHOLE);
  const seam_walk up_walk = is_merge ? walks[2 * cell] : none_walked;
  const seam_walk down_walk = is_merge ? walks[2 * cell + 1] : none_walked;
  const sewing s = {{0, halves.middle, up_walk, down_walk, crossings + list_up, crossings + list_down},
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
  const int removed_pairs = up + all;
  const filter_bounds none = {0, 0, 0, 0};
  rings g = rings_on(edges, points, vertex_edge, none);
  barrier(CLK_GLOBAL_MEM_FENCE | CLK_LOCAL_MEM_FENCE);
  for (int k = me; k < removed_pairs; k += lanes) mark_vertex_edges(&s, s.slots[k]);
  if (me == 0) {
    count = is_merge ? begin_sewing(&g, &s, parts[halves.low_at], parts[halves.high_at], meets, removed_pairs) : 0;
  }
  barrier(CLK_GLOBAL_MEM_FENCE | CLK_LOCAL_MEM_FENCE);
  sewing sewn = s;
  sewn.seam.count = count;
  for (int k = me; count > 0 && k < removed_pairs; k += lanes) replace_vertex_edges(&s, s.slots[k]);
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int k = me; k < removed_pairs; k += lanes) unmark(&s, s.slots[k]);
  for (int i = me; i < count; i += lanes) sew_crossing(&sewn, i);
  // A step is a removed pair, a free pair or a crossing edge.
  COUNT_STEPS(count > 0 ? (removed_pairs + count) / lanes + (me == 0 ? count - removed_pairs : 0) : 0);
  barrier(CLK_GLOBAL_MEM_FENCE);
  if (me == 0 && is_merge) {
    if (count > 0) end_sewing(&s, count);
    if (count == 0) atomic_inc(&account[RINGS_BROKEN]);
    finish_part(&g, &blocks, halves.part,
                joined_ends(&g, parts[halves.low_at].ends, parts[halves.high_at].ends, halves.axis));
  }
}
