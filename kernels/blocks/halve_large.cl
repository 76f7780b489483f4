// The points of blocks that are too large for local memory, before and after blocks/halve.cl.
//
// Blocks of more than `capacity` points have many equal points as a rule. Before, launches over all places sort them
// along x and drop duplicates: name_blocks, sort_large_tiles by counting, merge_large_runs for each width of runs,
// flag_distinct, a scan of its flags, move_distinct and name_duplicates. Afterwards halve_large_blocks is one launch
// with a work-group per block, which cuts in halves the vertices of blocks that have more than `capacity`
// (blocks/group_halving.h).

#include "blocks/arguments.h"
#include "blocks/group_halving.h"
#include "mesh/records.h"

// A place of a large block, by the block's first place and number of points; first is -1 for other places.
typedef struct {
  int first, count;
} large_place;

static inline large_place large_place_at(int i, int n, int capacity, global const int* block_of_place,
                                         global const int* offsets) {
  large_place at = {-1, 0};
  const int b = i < n ? block_of_place[i] : -1;
  if (b >= 0 && offsets[b + 1] - offsets[b] > capacity) {
    at.first = offsets[b];
    at.count = offsets[b + 1] - at.first;
  }
  return at;
}

static inline points_to_sort points_of(large_place at, global const coordinate2* points) {
  const points_to_sort s = {points + at.first, at.count, 0};
  return s;
}

// Names the blocks of places; -1 for blocks of more than `largest` points, which are left alone.
kernel void name_blocks(int n, int blocks, int largest, global const int* restrict offsets,
                        global int* restrict block_of_place) {
  const int i = get_global_id(0);
  if (i < n) {
    const int b = i < offsets[blocks] ? segment_of(i, blocks, offsets) : -1;
    block_of_place[i] = b >= 0 && offsets[b + 1] - offsets[b] <= largest ? b : -1;
  }
}

// order: by place of a large block, the point that stands there, counted from the block's first.
kernel void sort_large_tiles(int n, int capacity, global const int* restrict offsets,
                             global const int* restrict block_of_place, global const coordinate2* restrict points,
                             global int* restrict order) {
  const int i = get_global_id(0);
  const large_place at = large_place_at(i, n, capacity, block_of_place, offsets);
  if (at.first >= 0) {
    const points_to_sort s = points_of(at, points);
    order[at.first + place_in_tile(i - at.first, &s)] = i - at.first;
  }
}

kernel void merge_large_runs(int n, int capacity, int width, global const int* restrict offsets,
                             global const int* restrict block_of_place, global const coordinate2* restrict points,
                             global const int* restrict order, global int* restrict merged) {
  const int i = get_global_id(0);
  const large_place at = large_place_at(i, n, capacity, block_of_place, offsets);
  if (at.first >= 0) {
    const points_to_sort s = points_of(at, points);
    const int own = i - at.first;
    merge_runs(own, own + 1, width, order + at.first, merged + at.first, &s);
  }
}

kernel void flag_distinct(int n, int capacity, global const int* restrict offsets,
                          global const int* restrict block_of_place, global const coordinate2* restrict points,
                          global const int* restrict order, global uint* restrict flags) {
  const int i = get_global_id(0);
  const large_place at = large_place_at(i, n, capacity, block_of_place, offsets);
  const points_to_sort s = points_of(at, points);
  if (i < n) flags[i] = at.first >= 0 && is_distinct(i - at.first, order + at.first, &s);
}

// scanned: the prefix sums of the flags.
kernel void move_distinct(int n, int capacity, global const int* restrict offsets,
                          global const int* restrict block_of_place, global const coordinate2* restrict points,
                          global const int* restrict source, global const int* restrict order,
                          global const uint* restrict scanned, global coordinate2* restrict distinct_points,
                          global int* restrict distinct_source) {
  const int i = get_global_id(0);
  const large_place at = large_place_at(i, n, capacity, block_of_place, offsets);
  if (at.first >= 0 && scanned[i + 1] != scanned[i]) {
    const int from = at.first + order[i], to = at.first + scanned[i] - scanned[at.first];
    distinct_points[to] = points[from];
    distinct_source[to] = source[from];
  }
}

kernel void name_duplicates(int n, int capacity, global const int* restrict offsets,
                            global const int* restrict block_of_place, global const int* restrict source,
                            global const int* restrict order, global const uint* restrict scanned,
                            global const int* restrict distinct_source, global int* restrict representatives) {
  const int i = get_global_id(0);
  const large_place at = large_place_at(i, n, capacity, block_of_place, offsets);
  if (at.first >= 0 && scanned[i + 1] == scanned[i]) {
    representatives[source[at.first + order[i]]] = distinct_source[at.first + scanned[i] - scanned[at.first] - 1];
  }
}

// scratch has 4 elements per point.
kernel void halve_large_blocks(BLOCKS_TO_HALVE(), global coordinate2* points, global int* source,
                               global int* distinct_counts, global uchar* axes,
                               global const coordinate2* distinct_points, global const int* distinct_source,
                               global int* scratch) {
  const group_block own = block_of_group(blocks, are_listed, larger_blocks, largest, offsets);
  const int found = own.count > capacity ? scanned[own.end] - scanned[own.first] : 0;
  const int distinct = found > capacity ? found : 0;
  const group_memory memory = {scratch + 4 * (int64)own.first, own.count};
  halve_sorted(distinct, distinct_points + own.first, distinct_source + own.first, memory, axes + own.first,
               points + own.first, source + own.first);
  if (get_local_id(0) == 0 && distinct > 0) distinct_counts[own.b] = distinct;
}
