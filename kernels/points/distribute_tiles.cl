// Points to blocks as in distribute.cl, for devices with many lanes: by work-groups. cut_tree_tiles.cl and
// inspect_tiles.cl are parts of this program.
//
// The points are sorted stably by the numbers of their blocks, a digit of `bits` bits at a time, the lowest first; a
// million points have a single digit. One work-group takes a tile of points.
//
// 1. count_tile_blocks finds each point's block, and counts the lowest digits of each tile into table[digit][tile].
//    For each further digit, count_digits counts. Each table is scanned.
// 2. move_keys brings blocks and indices of points to their places by a digit; for the last one, move_tiles brings the
//    points themselves, scaled. Both sort their tile in local memory first, so that neighbours write to neighbouring
//    places.
// 3. block_starts finds where blocks begin, by a binary search for each.
//
// That makes two passes over the points for each digit. Where no set has a tree, copy_points makes the only pass.

#include "arithmetic/coordinates.h"
#include "arithmetic/records.h"
#include "operations/limits.h"
#include "operations/search.h"
#include "operations/work_group.h"
#include "points/cut_tree.h"
#include "points/cut_tree_tiles.cl"
#include "points/inspect_tiles.cl"
#include "points/limits.h"
#include "points/records.h"

SCAN_IN_GROUP(scan_fields, uint64)

// A work-group's points [first, last); none, if there are fewer tiles than groups.
typedef struct {
  int number, count, first, last;
} point_tile;

static inline point_tile points_of(int n, int size) {
  point_tile tile;
  tile.number = get_group_id(0);
  tile.count = (n - 1) / size + 1;
  tile.first = tile.number < tile.count ? tile.number * size : n;
  tile.last = tile.first + min(size, n - tile.first);
  return tile;
}

static inline int digit_at(int block, int shift, int bits) { return block >> shift & ((1 << bits) - 1); }

WITH_BARRIERS void clear_counts(local uint* counts, int bits) {
  for (int d = get_local_id(0); d < 1 << bits; d += get_local_size(0)) counts[d] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
}

WITH_BARRIERS void write_counts(point_tile tile, local const uint* counts, int bits, global uint* table) {
  barrier(CLK_LOCAL_MEM_FENCE);
  if (tile.number < tile.count) {
    for (int d = get_local_id(0); d < 1 << bits; d += get_local_size(0))
      table[d * tile.count + tile.number] = counts[d];
  }
}

// set_offsets: the first point of each set.
kernel void count_tile_blocks(int n, int size, int set_count, global const int* restrict set_offsets,
                              global const set_of_blocks* restrict sets, global const coordinate* restrict input,
                              global const cut_node* restrict nodes, int bits, global int* restrict block_of_point,
                              global int* restrict representatives, global uint* restrict table) {
  local uint counts[1 << MOST_BLOCK_BITS];
  const point_tile tile = points_of(n, size);
  clear_counts(counts, bits);
  // The tile's points lie in few sets as a rule.
  const int first_set = segment_of(min(tile.first, n - 1), set_count, set_offsets);
  const int end_set = segment_of(max(tile.last - 1, 0), set_count, set_offsets) + 1;
  for (int i = tile.first + (int)get_local_id(0); i < tile.last; i += get_local_size(0)) {
    const int s = first_set + segment_of(i, end_set - first_set, set_offsets + first_set);
    const set_of_blocks set = sets[s];
    const int block = set.block + leaf_of(vload2(i, input), nodes + set.nodes, set.depth);
    block_of_point[i] = block;
    representatives[i] = i;
    atomic_inc(&counts[digit_at(block, 0, bits)]);
  }
  write_counts(tile, counts, bits, table);
}

kernel void count_digits(int n, int size, int shift, int bits, global const int* restrict blocks,
                         global uint* restrict table) {
  local uint counts[1 << MOST_BLOCK_BITS];
  const point_tile tile = points_of(n, size);
  clear_counts(counts, bits);
  for (int i = tile.first + (int)get_local_id(0); i < tile.last; i += get_local_size(0)) {
    atomic_inc(&counts[digit_at(blocks[i], shift, bits)]);
  }
  write_counts(tile, counts, bits, table);
}

// Local memory for sorting a tile. Elements are digits with the points' places in the tile; a free element after each
// 32 lets the lanes of a warp, which take consecutive elements each, use different banks.
#define PLACE_BITS 16
#define PADDED_TILE (LARGEST_POINT_TILE + LARGEST_POINT_TILE / 32)
static inline int padded(int i) { return i + i / 32; }

// A digit of two bits. The group counts its four values at once, in fields of 16 bits.
#define PAIR_BITS 2
static inline int field_of(uint element, int shift) { return (int)(element >> (PLACE_BITS + shift) & 3) * 16; }

// Sorts the tile's elements stably by their digits. Returns where in `elements` the result begins.
WITH_BARRIERS int sort_digits(local uint* elements, int count, int bits, local uint64* sums) {
  const int share = share_of(count);
  const int first = min(count, (int)get_local_id(0) * share), last = min(count, first + share);
  int from = 0;
  for (int shift = 0; shift < bits; shift += PAIR_BITS) {
    const int to = PADDED_TILE - from;
    uint64 mine = 0, all;
    for (int i = first; i < last; ++i) mine += (uint64)1 << field_of(elements[from + padded(i)], shift);
    uint64 places = scan_fields(mine, sums, &all);
    // The elements of smaller values come first.
    places += (all << 16) + (all << 32) + (all << 48);
    for (int i = first; i < last; ++i) {
      const uint element = elements[from + padded(i)];
      const int field = field_of(element, shift);
      elements[to + padded((int)(places >> field & 0xffff))] = element;
      places += (uint64)1 << field;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    from = to;
  }
  return from;
}

// Sorts a tile by a digit. starts[d]: where its elements of digit d go, minus the place of the first one in the
// tile. So place i of the sorted tile goes to starts[d] + i.
WITH_BARRIERS int sort_tile(point_tile tile, int shift, int bits, global const int* blocks, global const uint* scanned,
                            local uint* elements, local int* starts, local uint64* sums) {
  const int me = get_local_id(0), group = get_local_size(0);
  const int count = tile.last - tile.first;
  for (int i = me; i < count; i += group) {
    elements[padded(i)] = (uint)digit_at(blocks[tile.first + i], shift, bits) << PLACE_BITS | (uint)i;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const int sorted = sort_digits(elements, count, bits, sums);
  for (int i = me; i < count; i += group) {
    const int digit = (int)(elements[sorted + padded(i)] >> PLACE_BITS);
    if (i == 0 || (int)(elements[sorted + padded(i - 1)] >> PLACE_BITS) != digit) {
      starts[digit] = (int)scanned[digit * tile.count + tile.number] - i;
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  return sorted;
}

static inline int place_of(uint element) { return (int)(element & ((1u << PLACE_BITS) - 1)); }
static inline int digit_of(uint element) { return (int)(element >> PLACE_BITS); }

// indices: of the points whose blocks these are, unless they are all points in their order (is_first).
kernel void move_keys(int n, int size, int shift, int bits, int is_first, global const int* restrict blocks,
                      global const int* restrict indices, global const uint* restrict scanned,
                      global int* restrict moved_blocks, global int* restrict moved_indices) {
  local uint elements[2 * PADDED_TILE];
  local int starts[1 << MOST_BLOCK_BITS];
  local uint64 sums[LARGEST_TILE_GROUP];
  const point_tile tile = points_of(n, size);
  const int sorted = sort_tile(tile, shift, bits, blocks, scanned, elements, starts, sums);
  for (int i = get_local_id(0); i < tile.last - tile.first; i += get_local_size(0)) {
    const uint element = elements[sorted + padded(i)];
    const int from = tile.first + place_of(element), to = starts[digit_of(element)] + i;
    moved_blocks[to] = blocks[from];
    moved_indices[to] = is_first ? from : indices[from];
  }
}

// indices: as for move_keys. If the blocks have one digit (is_first), `scanned` says where each of them begins;
// otherwise block_starts finds that in moved_blocks.
kernel void move_tiles(int n, int size, int shift, int bits, int is_first, global const int* restrict blocks,
                       global const int* restrict indices, global const uint* restrict scanned,
                       global const coordinate* restrict input, scaling scale, int block_count,
                       global int* restrict offsets, global int* restrict moved_blocks,
                       global coordinate2* restrict points, global int* restrict source) {
  local uint elements[2 * PADDED_TILE];
  local int starts[1 << MOST_BLOCK_BITS];
  local uint64 sums[LARGEST_TILE_GROUP];
  const point_tile tile = points_of(n, size);
  const int sorted = sort_tile(tile, shift, bits, blocks, scanned, elements, starts, sums);
  if (is_first && get_group_id(0) == 0) {
    for (int b = get_local_id(0); b <= block_count; b += get_local_size(0)) {
      offsets[b] = b < block_count ? (int)scanned[b * tile.count] : n;
    }
  }
  for (int i = get_local_id(0); i < tile.last - tile.first; i += get_local_size(0)) {
    const uint element = elements[sorted + padded(i)];
    const int from = tile.first + place_of(element), to = starts[digit_of(element)] + i;
    const int point = is_first ? from : indices[from];
    if (!is_first) moved_blocks[to] = blocks[from];
    points[to] = scaled_point(point, input, scale);
    source[to] = point;
  }
}

kernel void copy_points(int n, global const coordinate* restrict input, scaling scale,
                        global coordinate2* restrict points, global int* restrict source,
                        global int* restrict representatives) {
  const int i = get_global_id(0);
  if (i < n) {
    points[i] = scaled_point(i, input, scale);
    source[i] = representatives[i] = i;
  }
}

// Where each block begins, and the end. blocks: of the points in their new order.
kernel void block_starts(int n, int points, global const int* restrict blocks, global int* restrict offsets) {
  const int b = get_global_id(0);
  if (b < n) {
    int least = 0, most = points;
    while (least < most) {
      const int middle = least + (most - least) / 2;
      if (blocks[middle] < b) {
        least = middle + 1;
      } else {
        most = middle;
      }
    }
    offsets[b] = least;
  }
}
