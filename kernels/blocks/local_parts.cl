// The triangulations of parts of blocks with at most LOCAL_VERTICES vertices, between blocks/halve.cl and the merges of
// larger parts (blocks/seams.cl): see blocks/local_part.h. One launch, with a work-group per part. A part stops at a
// predicate that floating point cannot decide, and is left to blocks/local_parts_exact.cl. In fixed point none stops.

#ifndef FIXED_POINT
#define RINGS_STOP
#endif
#define LOCAL_RINGS
#include "blocks/arguments.h"
#include "blocks/local_part.h"
#include "blocks/parts.h"
#include "blocks/records.h"
#include "mesh/records.h"
#include "predicates/records.h"

kernel void solve_local_parts(int groups, int blocks, int are_left, PLACES_OF_PARTS(), filter_bounds bounds,
                              RINGS_OF_PARTS(), global uchar* restrict is_removed, global int* restrict states,
                              global volatile uint* account COUNTERS) {
  local local_arrays own;
  const halved_blocks halved =
      blocks_in(least_depth, end_depth, places, offsets, distinct, block_of_place, axes, 0, solved);
  solve_local_part(get_group_id(0), groups, blocks, height, are_left, 0, halved, bounds, points, edges, vertex_edge,
                   parts, is_removed, states, &own, account WITH_COUNTERS);
}
