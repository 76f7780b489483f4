// How a work-group sorts the points of a block along an axis, and cuts them in halves (blocks/halving.h). With
// LOCAL_HALVES its arrays are in local memory, and hold at most LOCAL_BLOCK_POINTS points; otherwise they are in global
// memory. In OpenCL C alone.
//
// - Points are sorted by number. Tiles of SORTED_TILE points are sorted by counting. Then runs are merged in pairs: a
//   work-item finds by binary search where SORTED_TILE elements of the result begin in both runs, and merges them one
//   after the other. In local memory, keys of 32 bits decide most comparisons.
// - The parts of a depth are cut at once, each by a team of work-items. The order that is not cut by position is split
//   stably: work-items count which points of their share go low, a scan within the team adds up the counts, and the
//   points move. This takes six barriers.
#ifndef FLAUNAY_GROUP_HALVING_H
#define FLAUNAY_GROUP_HALVING_H

#include "blocks/halving.h"
#include "blocks/limits.h"
#include "operations/search.h"
#include "operations/work_group.h"
#include "predicates/order.h"

#ifdef LOCAL_HALVES
#define HALVES_MEMORY local
#define HALVES_FENCE CLK_LOCAL_MEM_FENCE
typedef ushort point_number;
#else
#define HALVES_MEMORY global
#define HALVES_FENCE CLK_GLOBAL_MEM_FENCE
typedef int point_number;
#endif

// A list of numbers in the memory of a group.
typedef HALVES_MEMORY point_number* number_list;

// The memory of a group: four lists, with room for all points of a block each. Keys take the room of the first two.
typedef struct {
  number_list lists;
  int64 room;
} group_memory;

static inline number_list list_of(group_memory memory, int k) { return memory.lists + k * memory.room; }

// A block, or none, which has no points: it ends at its first one. count: 0 if it has more than `largest` points.
typedef struct {
  int b, first, count, end;
} group_block;

// The block of a group. If they are listed, these are the blocks that were flagged.
static inline group_block block_of_group(int blocks, int are_listed, global const uint* larger_blocks, int largest,
                                         global const int* offsets) {
  const int g = get_group_id(0), is_listed = are_listed && (uint)g < larger_blocks[blocks];
  const int b = is_listed ? segment_of(g, blocks, (global const int*)larger_blocks) : are_listed ? blocks : g;
  group_block own = {b, 0, 0, 0};
  if (b < blocks) {
    own.first = offsets[b];
    own.end = offsets[b + 1];
    own.count = own.end - own.first <= largest ? own.end - own.first : 0;
  }
  return own;
}

// Points that are sorted along an axis. They are named by their numbers.
typedef struct {
  global const coordinate2* points;
  int count, axis;
#ifdef LOCAL_HALVES
  local uint* keys;
#endif
} points_to_sort;

// Whether point i comes before point j.
static inline int comes_first(int i, int j, const points_to_sort* s) {
#ifdef LOCAL_HALVES
  const uint a = s->keys[i], b = s->keys[j];
  if (a != b) return a < b;
#endif
  return precedes(s->points[i], s->points[j], s->axis);
}

// Where point i comes in its tile, in which equal points stay in their order.
static inline int place_in_tile(int i, const points_to_sort* s) {
  const int begin = i & ~(SORTED_TILE - 1), end = min(s->count, begin + SORTED_TILE);
  int place = begin;
#ifdef LOCAL_HALVES
  // Keys alone decide, unless two are equal.
  int equal_keys = 0;
  for (int j = begin; j < end; ++j) {
    place += s->keys[j] < s->keys[i];
    equal_keys += s->keys[j] == s->keys[i];
  }
  if (equal_keys == 1) return place;
  place = begin;
#endif
  for (int j = begin; j < end; ++j) place += j < i ? !comes_first(i, j, s) : j > i && comes_first(j, i, s);
  return place;
}

// Merges pairs of runs of `width` elements: writes the elements [begin, end) of the result, which are of one pair.
static inline void merge_runs(int begin, int end, int width, HALVES_MEMORY const point_number* from, number_list to,
                              const points_to_sort* s) {
  const int first = begin & ~(2 * width - 1), middle = min(s->count, first + width),
            last = min(s->count, middle + width);
  const int before = begin - first;
  // How many of the elements before `begin` are of the first run.
  int least = max(0, before - (last - middle)), most = min(before, middle - first);
  while (least < most) {
    const int at = (least + most) / 2;
    const int is_more = !comes_first(from[middle + before - 1 - at], from[first + at], s);
    least = is_more ? at + 1 : least;
    most = is_more ? most : at;
  }
  int low = first + least, high = middle + before - least;
  for (int i = begin; i < min(end, last); ++i) {
    const int p = from[low], q = from[min(high, last - 1)];
    const int takes_high = low == middle || (high < last && comes_first(q, p, s));
    to[i] = takes_high ? q : p;
    low += !takes_high;
    high += takes_high;
  }
}

#ifdef LOCAL_HALVES
// A number in the order of the coordinates, by the distance from some point's.
static inline uint key_of(coordinate x, coordinate from) {
  const uint bits = as_uint(convert_float(difference(x, from)) + 0.0f);  // without -0
  return bits >> 31 ? ~bits : bits | 0x80000000u;
}
#endif

// Sorts points stably along an axis. Returns their order, in the third or fourth list.
WITH_BARRIERS number_list sort_group(points_to_sort* s, group_memory memory) {
  const int me = get_local_id(0), lanes = get_local_size(0);
#ifdef LOCAL_HALVES
  s->keys = (local uint*)memory.lists;
  for (int i = me; i < s->count; i += lanes) {
    s->keys[i] = s->axis ? key_of(s->points[i].y, s->points[0].y) : key_of(s->points[i].x, s->points[0].x);
  }
  barrier(HALVES_FENCE);
#endif
  number_list order = list_of(memory, 2), merged = list_of(memory, 3);
  for (int i = me; i < s->count; i += lanes) order[place_in_tile(i, s)] = i;
  barrier(HALVES_FENCE);
  // Loops with barriers that may run zero times take PoCL longer to compile.
  int width = SORTED_TILE;
  do {
    for (int i = me * SORTED_TILE; i < s->count; i += lanes * SORTED_TILE) {
      merge_runs(i, i + SORTED_TILE, width, order, merged, s);
    }
    barrier(HALVES_FENCE);
    const number_list sorted = merged;
    merged = order;
    order = sorted;
    width *= 2;
  } while (width < s->count);
  return order;
}

// The list of the third and the fourth that is not `order`.
static inline number_list spare_beside(number_list order, group_memory memory) {
  return list_of(memory, order == list_of(memory, 2) ? 3 : 2);
}

// Whether the point at place i of the order differs from the one before.
static inline int is_distinct(int i, HALVES_MEMORY const point_number* order, const points_to_sort* s) {
  return i == 0 || comes_first(order[i - 1], order[i], s);
}

// The elements [low, high) of a list that a work-item takes, as item `rank` of the `items` of its team that take some.
typedef struct {
  int low, high, rank, items;
} lane_share;

static inline lane_share share_within(team t, int begin, int end) {
  const int size = max(1, (end - begin + t.size - 1) / t.size), low = min(end, begin + t.rank * size);
  const lane_share share = {low, min(end, low + size), t.rank, (end - begin + size - 1) / size};
  return share;
}

static inline int sum_of(HALVES_MEMORY const point_number* counts, int begin, int end) {
  int sum = 0;
  for (int i = begin; i < end; ++i) sum += counts[i];
  return sum;
}

// Returns the sum of the counts of a team's work-items before this one, and writes the sum of all to *total. sums: has
// room for a number per item, and may be used again afterwards. Loops with barriers would take PoCL long to compile.
WITH_BARRIERS int scan_team(int count, lane_share share, number_list sums, int* total) {
  const int has_share = share.rank < share.items, row = share.rank / SUMMED_ITEMS,
            rows = (share.items + SUMMED_ITEMS - 1) / SUMMED_ITEMS;
  if (has_share) sums[share.rank] = count;
  barrier(HALVES_FENCE);
  const int before = sum_of(sums, row * SUMMED_ITEMS, min(share.rank, share.items));
  barrier(HALVES_FENCE);
  if (has_share && (share.rank == share.items - 1 || share.rank % SUMMED_ITEMS == SUMMED_ITEMS - 1))
    sums[row] = before + count;
  barrier(HALVES_FENCE);
  const int before_row = sum_of(sums, 0, min(row, rows));
  *total = before_row + sum_of(sums, row, rows);
  barrier(HALVES_FENCE);
  return before_row + before;
}

// The orders of a block's distinct points, whose numbers are their ranks along x; their ranks along y.
typedef struct {
  global const coordinate2* points;
  global uchar* axes;  // by node
  number_list by_x, by_y, y_ranks, spare;
} block_orders;

static inline int rank_along(int point, int axis, const block_orders* s) { return axis ? s->y_ranks[point] : point; }

// Which axis a part is cut across: 1 if it is longer in y.
static inline int axis_of_part(int begin, int end, const block_orders* s) {
  const int low = low_quartile(begin, end), high = high_quartile(begin, end);
  return axis_between(s->points[s->by_x[low]], s->points[s->by_x[high]], s->points[s->by_y[low]],
                      s->points[s->by_y[high]]);
}

// Cuts each part of a depth at its middle.
WITH_BARRIERS void cut_parts(int count, int depth, const block_orders* s) {
  const int parts = 1 << depth;
  const team own = team_of(parts);
  int first = 0;
  do {
    const int number = first + own.first, has_part = number < parts;
    const int begin = has_part ? part_begin(count, depth, number) : 0;
    const int middle = has_part ? part_begin(count, depth + 1, 2 * number + 1) : 0;
    const int end = has_part ? part_begin(count, depth, number + 1) : 0;
    const int axis = has_part && axis_of_part(begin, end, s);
    const int middle_rank = has_part ? rank_along((axis ? s->by_y : s->by_x)[middle], axis, s) : 0;
    if (has_part && own.rank == 0) s->axes[parts + number] = axis;
    const number_list order = axis ? s->by_x : s->by_y;
    const lane_share share = share_within(own, begin, end);
    int lows = 0;
    for (int i = share.low; i < share.high; ++i) lows += rank_along(order[i], axis, s) < middle_rank;
    int all_lows;
    const int lows_before = scan_team(lows, share, s->spare + begin, &all_lows);
    int low = begin + lows_before, high = middle + share.low - low;
    for (int i = share.low; i < share.high; ++i) {
      const int point = order[i], goes_low = rank_along(point, axis, s) < middle_rank;
      s->spare[goes_low ? low : high] = point;
      low += goes_low;
      high += !goes_low;
    }
    barrier(HALVES_FENCE);
    for (int i = share.low; i < share.high; ++i) order[i] = s->spare[i];
    barrier(HALVES_FENCE);
    first += own.step;
  } while (first < parts);
}

// Halves a block's distinct points, which are in the order of x, and writes them in the order of the leaves.
WITH_BARRIERS void halve_sorted(int count, global const coordinate2* sorted, global const int* sorted_source,
                                group_memory memory, global uchar* axes, global coordinate2* points,
                                global int* source) {
  const int me = get_local_id(0), lanes = get_local_size(0);
  points_to_sort along_y = {sorted, count, 1};
  const number_list by_y = sort_group(&along_y, memory);
  const block_orders s = {sorted, axes, list_of(memory, 0), by_y, list_of(memory, 1), spare_beside(by_y, memory)};
  for (int i = me; i < count; i += lanes) {
    s.by_x[i] = i;
    s.y_ranks[by_y[i]] = i;
  }
  barrier(HALVES_FENCE);
  const int depth = halving_depth(count);
  for (int d = 0; d < depth; ++d) cut_parts(count, d, &s);
  for (int i = me; i < count; i += lanes) {
    points[i] = sorted[s.by_x[i]];
    source[i] = sorted_source[s.by_x[i]];
  }
}

#endif
