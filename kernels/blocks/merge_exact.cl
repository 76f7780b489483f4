// Leaves and merges at which floating point could not decide, with exact predicates: merges that
// blocks/merge.cl has stopped are continued to their end, and so are walks along seams that blocks/seams.cl has
// stopped. Each kernel is one pass over the states of a launch, mostly done ones, with its work-items and
// arguments.

// Compiled in half the time, and these are called rarely.
#define OUT_OF_LINE __attribute__((noinline))
#include "blocks/arguments.h"
#include "blocks/halves.h"
#include "blocks/records.h"
#include "blocks/rings_account.h"
#include "blocks/seams.h"
#include "mesh/records.h"
#include "operations/spread.h"
#include "points/cut_tree.h"
#include "points/records.h"
#include "predicates/records.h"

kernel void finish_parts(int n, int spread, PLACES_OF_PARTS(), filter_bounds bounds, RINGS_OF_PARTS(),
                         global int* restrict states, global volatile uint* account COUNTERS) {
  const int cell = spread_item(n, spread);
  if (cell < n && states[cell] != MERGE_IS_DONE) {
    const halved_blocks blocks =
        blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, parts, solved);
    rings g = rings_on(edges, points, vertex_edge, bounds);
    states[cell] = do_cell(&g, &blocks, height, cell, states[cell]);
    COUNT_STEPS(g.counted.steps);
    add_to_account(&g, account);
  }
}

kernel void finish_walks(int n, int spread, PLACES_OF_PARTS(), filter_bounds bounds, RINGS_OF_PARTS(),
                         global int2* restrict crossings, global int* restrict removals,
                         global uchar* restrict is_removed, global seam_walk* restrict walks,
                         global volatile uint* account COUNTERS) {
  const int w = spread_item(n, spread);
  if (w < n && walks[w].outcome == WALK_HAS_STOPPED) {
    const halved_blocks blocks =
        blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, parts, solved);
    rings g = rings_on(edges, points, vertex_edge, bounds);
    walks[w] = walk_of_cell(&g, &blocks, height, w, walks[w], crossings, removals, is_removed);
    COUNT_STEPS(g.counted.steps);
    add_to_account(&g, account);
  }
}

kernel void finish_trees(int n, int spread, int first_merge, global const block_merge* restrict merges,
                         global const cut_node* restrict nodes, filter_bounds bounds, global const coordinate2* points,
                         global ring_edge* edges, global int* vertex_edge, global solved_block* solved,
                         global int* restrict states, global volatile uint* account COUNTERS) {
  const int m = spread_item(n, spread);
  if (m < n && states[m] != MERGE_IS_DONE) {
    const block_merge merge = merges[first_merge + m];
    rings g = rings_on(edges, points, vertex_edge, bounds);
    states[m] = merge_two_blocks(&g, solved, merge, cut_axis(nodes[merge.node]), states[m]);
    COUNT_STEPS(g.counted.steps);
    add_to_account(&g, account);
  }
}
