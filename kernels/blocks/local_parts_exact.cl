// The parts at which blocks/local_parts.cl has stopped, with exact predicates: one launch with the same groups.

// Compiled in half the time, and these are called rarely.
#define OUT_OF_LINE __attribute__((noinline))
#define LOCAL_RINGS
#include "blocks/arguments.h"
#include "blocks/local_part.h"
#include "blocks/parts.h"
#include "blocks/records.h"
#include "mesh/records.h"
#include "predicates/records.h"

kernel void finish_local_parts(int groups, int blocks, int are_left, PLACES_OF_PARTS(), filter_bounds bounds,
                               RINGS_OF_PARTS(), global uchar* restrict is_removed, global int* restrict states,
                               global volatile uint* account COUNTERS) {
  local local_arrays own;
  const halved_blocks halved =
      blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, 0, solved);
  solve_local_part(get_group_id(0), groups, blocks, height, are_left, 1, halved, bounds, points, edges, vertex_edge,
                   parts, is_removed, states, &own, account WITH_COUNTERS);
}
