// The second half of solving blocks on devices with many lanes: leaves and merges, see blocks/halves.h and
// mesh/rings.h. A merge stops at a predicate that floating point cannot decide, so that exact predicates take
// no registers here; blocks/merge_exact.cl continues it.
//
// There is a launch of merge_parts per height; the first one makes the leaves of all blocks. Then there is one
// of merge_trees per level of the trees of cuts. There is one work-item per cell or merge, but if these are
// few, only one in `spread` work-items has one, so that merges are not in the same warp and do not wait for
// each other. Kernels that continue merges have the same arguments; the account is theirs alone.

#define RINGS_STOP
#include "blocks/arguments.h"
#include "blocks/halves.h"
#include "mesh/records.h"
#include "operations/spread.h"
#include "points/cut_tree.h"
#include "points/records.h"
#include "predicates/records.h"

kernel void merge_parts(int n, int spread, PLACES_OF_PARTS(), filter_bounds bounds, RINGS_OF_PARTS(),
                        global int* restrict states, global volatile uint* account COUNTERS) {
  const int cell = spread_item(n, spread);
  if (cell < n) {
    const halved_blocks blocks =
        blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, parts, solved);
    rings g = rings_on(edges, points, vertex_edge, bounds);
    states[cell] = do_cell(&g, &blocks, height, cell, MERGE_IS_NEW);
    COUNT_STEPS(g.counted.steps);
  }
}

kernel void merge_trees(int n, int spread, int first_merge, global const block_merge* restrict merges,
                        global const cut_node* restrict nodes, filter_bounds bounds, global const coordinate2* points,
                        global ring_edge* edges, global int* vertex_edge, global solved_block* solved,
                        global int* restrict states, global volatile uint* account COUNTERS) {
  const int m = spread_item(n, spread);
  if (m < n) {
    const block_merge merge = merges[first_merge + m];
    rings g = rings_on(edges, points, vertex_edge, bounds);
    states[m] = merge_two_blocks(&g, solved, merge, cut_axis(nodes[merge.node]), MERGE_IS_NEW);
    COUNT_STEPS(g.counted.steps);
  }
}
