// The first half of solving blocks on devices with many lanes: each block's points are sorted along x and along y,
// duplicates are dropped, and the remaining points are cut in halves down to leaves (blocks/halving.h), exactly
// as solve_blocks of blocks/divide.cl does. blocks/merge.cl does the rest.
//
// halve_blocks is one launch, with one work-group per block. It names the block of each place, and sorts tiles of
// SORTED_TILE points by counting, then merges runs: each element finds its place by binary search in the other run. For
// blocks of more than `capacity` points, which have many equal points as a rule, launches over all places do the same
// before: name_blocks, sort_large_tiles, merge_large_runs for each width of runs, flag_distinct, a scan of its flags,
// move_distinct and name_duplicates. Each cut splits the order that is not cut by position, stably, by a scan over the
// group, for all parts of a depth at once.
//
// If most blocks are tiny, halve_tiny_blocks, per block, halves blocks of at most TINY_BLOCK points;
// flag_larger_blocks and a scan list the others for the groups of halve_blocks.

#include "blocks/arguments.h"
#include "blocks/halving.h"
#include "blocks/limits.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "operations/search.h"
#include "operations/work_group.h"
#include "predicates/order.h"

// A block's own arrays, which begin at its place in the arrays of all points.
typedef struct {
  global coordinate2* points;  // distinct, by x
  global int* source;
  global ranks* by_x;
  global ranks* by_y;
  global ranks* spare;
  global uchar* axes;  // by node
  global int* lows;    // by part: how many low vertices its lane has met before it
} block_arrays;

// Elements [low, high) of `count` are the work-item's.
typedef struct {
  int size, low, high;
} lane_share;

static inline lane_share own_share_of(int count) {
  lane_share share;
  share.size = max(1, share_of(count));
  share.low = min(count, (int)get_local_id(0) * share.size);
  share.high = min(count, share.low + share.size);
  return share;
}

// sums[i] becomes the sum of the counts of work-items 0 to i.
WITH_BARRIERS void scan_group(uint count, local uint* sums) {
  const int me = get_local_id(0), lanes = get_local_size(0);
  sums[me] = count;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int reach = 1; reach < lanes; reach *= 2) {
    const uint before = me >= reach ? sums[me - reach] : 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    sums[me] += before;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}

static inline uint sum_before(int lane, local const uint* sums) { return lane > 0 ? sums[lane - 1] : 0; }

// Where element i comes in its tile, in which equal points stay in their order.
static inline int place_in_tile(int i, int count, global const coordinate2* points, int axis) {
  const int begin = i & ~(SORTED_TILE - 1), end = min(count, begin + SORTED_TILE);
  const coordinate2 p = points[i];
  int place = begin;
  for (int j = begin; j < end; ++j) place += j < i ? !precedes(p, points[j], axis) : precedes(points[j], p, axis);
  return place;
}

// Where element i comes when its run of `width` elements and the neighbouring one are merged.
static inline int place_in_merge(int i, int width, int count, global const int* elements,
                                 global const coordinate2* points, int axis) {
  const int is_high = (i & width) != 0;
  const int begin = i & ~(2 * width - 1), middle = min(count, begin + width);
  const coordinate2 p = points[elements[i]];
  int low = is_high ? begin : middle, high = is_high ? middle : min(count, middle + width);
  while (low < high) {
    const int at = low + (high - low) / 2;
    const coordinate2 other = points[elements[at]];
    const int comes_first = is_high ? !precedes(p, other, axis) : precedes(other, p, axis);
    low = comes_first ? at + 1 : low;
    high = comes_first ? high : at;
  }
  return i + low - middle;
}

// Sorts the places of points stably along an axis. Both arrays have room for them; returns the one with the result.
WITH_BARRIERS global int* sort_group(global int* elements, global int* spare, int count,
                                     global const coordinate2* points, int axis) {
  const int me = get_local_id(0), lanes = get_local_size(0);
  for (int i = me; i < count; i += lanes) elements[place_in_tile(i, count, points, axis)] = i;
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int width = SORTED_TILE; width < count; width *= 2) {
    for (int i = me; i < count; i += lanes) {
      spare[place_in_merge(i, width, count, elements, points, axis)] = elements[i];
    }
    barrier(CLK_GLOBAL_MEM_FENCE);
    global int* const sorted = spare;
    spare = elements;
    elements = sorted;
  }
  return elements;
}

// Whether the point at i of the order is another than the one before it.
static inline int is_distinct(int i, global const int* elements, global const coordinate2* points) {
  if (i == 0) return 1;
  const coordinate2 p = points[elements[i - 1]], q = points[elements[i]];
  return p.x != q.x || p.y != q.y;
}

// Writes a block's distinct points in the order of x, and returns their number.
WITH_BARRIERS int distinct_by_x(int count, global const coordinate2* points, global const int* source,
                                const block_arrays* s, global int* representatives, local uint* sums) {
  global int* const space = (global int*)s->spare;
  global const int* const elements = sort_group(space, space + count, count, points, 0);
  const lane_share share = own_share_of(count);
  uint own = 0;
  for (int i = share.low; i < share.high; ++i) own += is_distinct(i, elements, points);
  scan_group(own, sums);
  const int before = sum_before(get_local_id(0), sums), distinct = sums[get_local_size(0) - 1];
  for (int i = share.low, place = before; i < share.high; ++i) {
    if (is_distinct(i, elements, points)) {
      s->points[place] = points[elements[i]];
      s->source[place] = source[elements[i]];
      ++place;
    }
  }
  barrier(CLK_GLOBAL_MEM_FENCE | CLK_LOCAL_MEM_FENCE);
  for (int i = share.low, place = before; i < share.high; ++i) {
    if (is_distinct(i, elements, points)) {
      ++place;
    } else {
      representatives[source[elements[i]]] = s->source[place - 1];
    }
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
  return distinct;
}

WITH_BARRIERS void rank(int count, const block_arrays* s) {
  global int* const space = (global int*)s->spare;
  global const int* const elements = sort_group(space, space + count, count, s->points, 1);
  for (int r = get_local_id(0); r < count; r += get_local_size(0)) {
    const int point = elements[r];
    s->by_y[r] = ranks_of(r, point);
    s->by_x[point] = ranks_of(point, r);
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
}

// A part that is cut. Its vertices whose place along the axis is below the threshold go low.
typedef struct {
  int number, begin, middle, end, axis;
  ranks threshold;
} part_to_cut;

static inline part_to_cut part_with(int number, int count, int depth, const block_arrays* s) {
  part_to_cut part;
  part.number = number;
  part.begin = part_begin(count, depth, number);
  part.middle = part_begin(count, depth + 1, 2 * number + 1);
  part.end = part_begin(count, depth, number + 1);
  part.axis = s->axes[(1 << depth) + number];
  part.threshold = ranks_of(0, own_rank((part.axis ? s->by_y : s->by_x)[part.middle]));
  return part;
}

static inline int is_low(ranks both, part_to_cut part) { return both < part.threshold; }

static inline global ranks* order_to_split(part_to_cut part, const block_arrays* s) {
  return part.axis ? s->by_x : s->by_y;
}

// How many low vertices there are before a part, when all work-items with shares of this size have counted theirs.
static inline int lows_before(part_to_cut part, int share, const block_arrays* s, local const uint* sums) {
  return sum_before(part.begin / share, sums) + s->lows[part.number];
}

// Cuts each part of a depth at its middle.
WITH_BARRIERS void cut_parts(int count, int depth, const block_arrays* s, local uint* sums) {
  for (int j = get_local_id(0); j < 1 << depth; j += get_local_size(0)) {
    s->axes[(1 << depth) + j] =
        axis_of(part_begin(count, depth, j), part_begin(count, depth, j + 1), s->points, s->by_x, s->by_y);
  }
  barrier(CLK_GLOBAL_MEM_FENCE | CLK_LOCAL_MEM_FENCE);
  const lane_share share = own_share_of(count);
  // A work-item's first part begins in its share or in one before; without a share, any part will do.
  const int first_part = part_from(count, depth, min(share.low, count - 1) + 1) - 1;
  uint own = 0;
  part_to_cut part = part_with(first_part, count, depth, s);
  for (int i = share.low; i < share.high; ++i) {
    if (i == part.end) part = part_with(part.number + 1, count, depth, s);
    if (i == part.begin) s->lows[part.number] = own;
    own += is_low(order_to_split(part, s)[i], part);
  }
  scan_group(own, sums);
  barrier(CLK_GLOBAL_MEM_FENCE);
  int lows = sum_before(get_local_id(0), sums);
  part = part_with(first_part, count, depth, s);
  int first_low = lows_before(part, share.size, s, sums);
  for (int i = share.low; i < share.high; ++i) {
    if (i == part.end) {
      part = part_with(part.number + 1, count, depth, s);
      first_low = lows_before(part, share.size, s, sums);
    }
    const ranks both = order_to_split(part, s)[i];
    const int low = lows - first_low;
    if (is_low(both, part)) {
      s->spare[part.begin + low] = both;
      ++lows;
    } else {
      s->spare[part.middle + i - part.begin - low] = both;
    }
  }
  barrier(CLK_GLOBAL_MEM_FENCE | CLK_LOCAL_MEM_FENCE);
  part = part_with(first_part, count, depth, s);
  for (int i = share.low; i < share.high; ++i) {
    if (i == part.end) part = part_with(part.number + 1, count, depth, s);
    order_to_split(part, s)[i] = s->spare[i];
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
}

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

kernel void name_blocks(int n, int blocks, global const int* restrict offsets, global int* restrict block_of_place) {
  const int i = get_global_id(0);
  if (i < n) block_of_place[i] = i < offsets[blocks] ? segment_of(i, blocks, offsets) : -1;
}

// order: by place of a large block, the point that stands there, counted from the block's first.
kernel void sort_large_tiles(int n, int capacity, global const int* restrict offsets,
                             global const int* restrict block_of_place, global const coordinate2* restrict points,
                             global int* restrict order) {
  const int i = get_global_id(0);
  const large_place at = large_place_at(i, n, capacity, block_of_place, offsets);
  if (at.first >= 0) {
    order[at.first + place_in_tile(i - at.first, at.count, points + at.first, 0)] = i - at.first;
  }
}

kernel void merge_large_runs(int n, int capacity, int width, global const int* restrict offsets,
                             global const int* restrict block_of_place, global const coordinate2* restrict points,
                             global const int* restrict order, global int* restrict merged) {
  const int i = get_global_id(0);
  const large_place at = large_place_at(i, n, capacity, block_of_place, offsets);
  if (at.first >= 0) {
    merged[at.first + place_in_merge(i - at.first, width, at.count, order + at.first, points + at.first, 0)] = order[i];
  }
}

kernel void flag_distinct(int n, int capacity, global const int* restrict offsets,
                          global const int* restrict block_of_place, global const coordinate2* restrict points,
                          global const int* restrict order, global uint* restrict flags) {
  const int i = get_global_id(0);
  const large_place at = large_place_at(i, n, capacity, block_of_place, offsets);
  if (i < n) flags[i] = at.first >= 0 && is_distinct(i - at.first, order + at.first, points + at.first);
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

// The block that is number k of those that were flagged; `blocks` if there are fewer.
static inline int listed_block(int k, int blocks, global const uint* scanned) {
  return (uint)k < scanned[blocks] ? segment_of(k, blocks, (global const int*)scanned) : blocks;
}

// n blocks.
kernel void flag_larger_blocks(int n, global const int* restrict offsets, global uint* restrict flags) {
  const int b = get_global_id(0);
  if (b < n) flags[b] = offsets[b + 1] - offsets[b] > TINY_BLOCK;
}

// Where point i comes in the order along an axis, in which equal points stay in their order.
static inline int rank_along(int i, int count, global const coordinate2* points, int axis) {
  return place_in_tile(i, count, points, axis);
}

// The point that has a rank along an axis.
static inline coordinate2 point_of_rank(int rank, int count, global const coordinate2* points, int axis) {
  int i = 0;
  while (rank_along(i, count, points, axis) != rank) ++i;
  return points[i];
}

// Sorts a few points along x, drops duplicates, and returns the number of those that are left, in the block's arrays.
static inline int sort_tiny_block(int count, global const coordinate2* points, global const int* source,
                                  const block_arrays* s, global int* representatives) {
  for (int i = 0; i < count; ++i) {
    const int to = rank_along(i, count, points, 0);
    s->points[to] = points[i];
    s->source[to] = source[i];
  }
  int distinct = 0;
  for (int i = 0; i < count; ++i) {
    const coordinate2 p = s->points[i];
    const int own = s->source[i];
    if (distinct > 0 && p.x == s->points[distinct - 1].x && p.y == s->points[distinct - 1].y) {
      representatives[own] = s->source[distinct - 1];
    } else {
      s->points[distinct] = p;
      s->source[distinct] = own;
      ++distinct;
    }
  }
  return distinct;
}

// axis_of for all of a few points, which are in the order along x.
static inline int axis_of_tiny(int count, global const coordinate2* points) {
  const int low = count / 4, high = count - 1 - count / 4;
  return rounded_difference(point_of_rank(high, count, points, 1).y, point_of_rank(low, count, points, 1).y) >
         rounded_difference(points[high].x, points[low].x);
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
    block_arrays s;
    s.points = scratch_points + first;
    s.source = scratch_source + first;
    const int distinct = sort_tiny_block(count, points + first, source + first, &s, representatives);
    int axis = 0;
    if (halving_depth(distinct) > 0) {
      axis = axis_of_tiny(distinct, s.points);
      axes[first + 1] = axis;
    }
    const int middle = part_begin(distinct, 1, 1);
    for (int part = 0, to = first; part < (axis == 0 ? 1 : 2); ++part) {
      for (int k = 0; k < distinct; ++k) {
        if (axis != 0 && (rank_along(k, distinct, s.points, 1) >= middle) != part) continue;
        points[to] = s.points[k];
        source[to] = s.source[k];
        ++to;
      }
    }
    end_block(b, distinct, solved, distinct_counts);
  }
}

// Writes the vertices of each block in the order of the leaves, their sources, the axis of each cut, and the number of
// vertices. scratch_ranks has 3 elements per point, the other scratch arrays 1. Groups beyond the last block are idle.
// Large blocks have their distinct points in scratch_points and scratch_source; their number is a difference in
// scanned. Blocks of more than `largest` points get no vertices.
// are_listed: the groups take the blocks that flag_larger_blocks has flagged; larger_blocks: the flags' prefix sums.
kernel void halve_blocks(int blocks, int are_listed, global const uint* restrict larger_blocks, int capacity,
                         int largest, int places, global const int* restrict offsets,
                         global const uint* restrict scanned, BLOCK_POINTS(), global int* restrict block_of_place,
                         global uchar* axes, BLOCK_SCRATCH(), global int* scratch_lows) {
  local uint sums[LARGEST_GROUP];
  const int me = get_local_id(0), lanes = get_local_size(0);
  const int b = are_listed ? listed_block(get_group_id(0), blocks, larger_blocks) : (int)get_group_id(0);
  const int first = b < blocks ? offsets[b] : 0, points_of_block = b < blocks ? offsets[b + 1] - first : 0;
  const int count = points_of_block <= largest ? points_of_block : 0;
  name_places(b, first, first + points_of_block, me, lanes, block_of_place);
  name_places_behind(offsets[blocks], places, block_of_place);
  block_arrays s;
  s.points = scratch_points + first;
  s.source = scratch_source + first;
  s.by_x = scratch_ranks + 3 * (int64)first;
  s.by_y = s.by_x + count;
  s.spare = s.by_y + count;
  s.axes = axes + first;
  s.lows = scratch_lows + first;
  const int is_large = count > capacity;
  int distinct = distinct_by_x(is_large ? 0 : count, points + first, source + first, &s, representatives, sums);
  if (is_large) distinct = scanned[first + count] - scanned[first];
  rank(distinct, &s);
  const int depth = halving_depth(distinct);
  for (int d = 0; d < depth; ++d) cut_parts(distinct, d, &s, sums);
  for (int k = me; k < distinct; k += lanes) {
    const int r = own_rank(s.by_x[k]);
    points[first + k] = s.points[r];
    source[first + k] = s.source[r];
  }
  if (me == 0 && b < blocks) end_block(b, distinct, solved, distinct_counts);
}
