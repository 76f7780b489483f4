// The first half of solving blocks on devices with many lanes: each block's points are sorted along x and along y,
// duplicates are dropped, and the remaining points are cut in halves down to leaves (blocks/halving.h), exactly
// as solve_blocks of blocks/divide.cl does. blocks/merge.cl does the rest.
//
// halve_blocks is one launch, with one work-group per block, which works in local memory (blocks/group_halving.h).
// Blocks of more than `capacity` points, which have many equal points as a rule, have been sorted along x before, by
// blocks/halve_large.cl, which also halves those with more than `capacity` vertices.
//
// If most blocks are tiny, halve_tiny_blocks, per block, halves blocks of at most TINY_BLOCK points;
// flag_larger_blocks and a scan list the others for the groups of halve_blocks.

#define LOCAL_HALVES
#include "blocks/arguments.h"
#include "blocks/group_halving.h"
#include "blocks/limits.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "predicates/order.h"

// Writes a block's distinct points in the order of x, and returns their number.
WITH_BARRIERS int distinct_by_x(int count, global const coordinate2* points, global const int* source,
                                group_memory memory, global coordinate2* distinct_points, global int* distinct_source,
                                global int* representatives) {
  points_to_sort along_x = {points, count, 0, 0};
  const number_list order = sort_group(&along_x, memory), kept = spare_beside(order, memory);
  const lane_share share = share_within(team_of(1), 0, count);
  int own = 0, distinct;
  for (int i = share.low; i < share.high; ++i) own += is_distinct(i, order, &along_x);
  const int before = scan_team(own, share, kept, &distinct);
  for (int i = share.low, place = before; i < share.high; ++i) {
    if (is_distinct(i, order, &along_x)) kept[place++] = order[i];
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int i = get_local_id(0); i < distinct; i += get_local_size(0)) {
    distinct_points[i] = points[kept[i]];
    distinct_source[i] = source[kept[i]];
  }
  for (int i = share.low, place = before; i < share.high; ++i) {
    if (is_distinct(i, order, &along_x)) {
      ++place;
    } else {
      representatives[source[order[i]]] = source[kept[place - 1]];
    }
  }
  barrier(CLK_GLOBAL_MEM_FENCE | CLK_LOCAL_MEM_FENCE);
  return distinct;
}

// Names the block of the places [first, end), of which each of `lanes` work-items takes its share.
static inline void name_places(int b, int first, int end, int lane, int lanes, global int* block_of_place) {
  for (int i = first + lane; i < end; i += lanes) block_of_place[i] = b;
}

// Names the places from `end` to n, which are behind the last block, by all work-items of a launch.
static inline void name_places_behind(int end, int n, global int* block_of_place) {
  name_places(-1, end, n, get_global_id(0), get_global_size(0), block_of_place);
}

static inline void end_block(int b, int distinct, global solved_block* solved, global int* distinct_counts) {
  const solved_block none = {no_ends(), {NO_EDGE, NO_EDGE}};
  if (distinct == 0) solved[b] = none;
  distinct_counts[b] = distinct;
}

// Writes the vertices of each block in the order of the leaves, their sources, the axis of each cut, and the number of
// vertices. Leaves blocks with more than `capacity` vertices to halve_large_blocks. Groups beyond the last block are
// idle. Blocks of more than `largest` points get no vertices.
kernel void halve_blocks(BLOCKS_TO_HALVE(), int places, BLOCK_POINTS(), global int* restrict block_of_place,
                         global uchar* axes, global coordinate2* scratch_points, global int* scratch_source) {
  local uint bytes[LOCAL_BYTES / sizeof(uint)];
  const group_memory memory = {(number_list)bytes, LOCAL_BLOCK_POINTS};
  const group_block own = block_of_group(blocks, are_listed, larger_blocks, largest, offsets);
  name_places(own.b, own.first, own.end, get_local_id(0), get_local_size(0), block_of_place);
  name_places_behind(offsets[blocks], places, block_of_place);
  const int is_large = own.count > capacity;
  int distinct = distinct_by_x(is_large ? 0 : own.count, points + own.first, source + own.first, memory,
                               scratch_points + own.first, scratch_source + own.first, representatives);
  if (is_large) distinct = scanned[own.end] - scanned[own.first];
  const int is_left = distinct > capacity;
  halve_sorted(is_left ? 0 : distinct, scratch_points + own.first, scratch_source + own.first, memory, axes + own.first,
               points + own.first, source + own.first);
  if (get_local_id(0) == 0 && own.b < blocks && !is_left) end_block(own.b, distinct, solved, distinct_counts);
}

// n blocks.
kernel void flag_larger_blocks(int n, global const int* restrict offsets, global uint* restrict flags) {
  const int b = get_global_id(0);
  if (b < n) flags[b] = offsets[b + 1] - offsets[b] > TINY_BLOCK;
}

// Where point i comes in the order along an axis, in which equal points stay in their order.
static inline int rank_among(int i, int count, global const coordinate2* points, int axis) {
  int rank = 0;
  for (int j = 0; j < count; ++j) {
    rank += j < i ? !precedes(points[i], points[j], axis) : precedes(points[j], points[i], axis);
  }
  return rank;
}

// The point that has a rank along an axis.
static inline coordinate2 point_of_rank(int rank, int count, global const coordinate2* points, int axis) {
  int i = 0;
  while (rank_among(i, count, points, axis) != rank) ++i;
  return points[i];
}

// Sorts a few points along x, drops duplicates, and returns the number of those that are left, in the block's arrays.
static inline int sort_tiny_block(int count, global const coordinate2* points, global const int* source,
                                  global coordinate2* distinct_points, global int* distinct_source,
                                  global int* representatives) {
  for (int i = 0; i < count; ++i) {
    const int to = rank_among(i, count, points, 0);
    distinct_points[to] = points[i];
    distinct_source[to] = source[i];
  }
  int distinct = 0;
  for (int i = 0; i < count; ++i) {
    const coordinate2 p = distinct_points[i];
    const int own = distinct_source[i];
    if (distinct > 0 && p.x == distinct_points[distinct - 1].x && p.y == distinct_points[distinct - 1].y) {
      representatives[own] = distinct_source[distinct - 1];
    } else {
      distinct_points[distinct] = p;
      distinct_source[distinct] = own;
      ++distinct;
    }
  }
  return distinct;
}

// Which axis a few points are cut across, which are in the order along x.
static inline int tiny_axis(int count, global const coordinate2* points) {
  const int low = low_quartile(0, count), high = high_quartile(0, count);
  return axis_between(points[low], points[high], point_of_rank(low, count, points, 1),
                      point_of_rank(high, count, points, 1));
}

// n blocks. Halves blocks of at most TINY_BLOCK points as halve_blocks would.
kernel void halve_tiny_blocks(int n, int places, global const int* restrict offsets, BLOCK_POINTS(),
                              global int* restrict block_of_place, global uchar* axes,
                              global coordinate2* scratch_points, global int* scratch_source) {
  const int b = get_global_id(0);
  const int first = b < n ? offsets[b] : 0, count = b < n ? offsets[b + 1] - first : 0;
  name_places_behind(offsets[n], places, block_of_place);
  if (b < n && count <= TINY_BLOCK) {
    name_places(b, first, first + count, 0, 1, block_of_place);
    global coordinate2* const sorted = scratch_points + first;
    global int* const sorted_source = scratch_source + first;
    const int distinct = sort_tiny_block(count, points + first, source + first, sorted, sorted_source, representatives);
    int axis = 0;
    if (halving_depth(distinct) > 0) {
      axis = tiny_axis(distinct, sorted);
      axes[first + 1] = axis;
    }
    const int middle = part_begin(distinct, 1, 1);
    for (int part = 0, to = first; part < (axis == 0 ? 1 : 2); ++part) {
      for (int k = 0; k < distinct; ++k) {
        if (axis != 0 && (rank_among(k, distinct, sorted, 1) >= middle) != part) continue;
        points[to] = sorted[k];
        source[to] = sorted_source[k];
        ++to;
      }
    }
    end_block(b, distinct, solved, distinct_counts);
  }
}
