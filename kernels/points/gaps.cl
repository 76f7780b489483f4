// Cut trees (points/cut_tree.h) of points that lie along the cuts of an earlier tree, made from samples of them
// (cut_tree_tiles.cl), on devices with many lanes.
//
// Medians would fall onto the old cuts, since that is where the points are. Each node is cut in the middle of its
// widest gap instead: of all stretches of about sqrt(m) consecutive samples of m, along either axis, the longest. Gaps
// that would make a part much larger or smaller than a half are not considered, so that all leaves have about as many
// points.
//
// cut_at_gaps cuts a few levels of all trees in one launch, with one work-group per node of the first of these levels.
// The group finds which of the samples of the node a few levels above are in its node, and takes as many of them as its
// tile has room for, evenly. It sorts these along both axes in local memory and cuts them level by level. A large node
// is thus cut by some of its samples, and the nodes below it by others.

#include "operations/limits.h"
#include "operations/search.h"
#include "operations/work_group.h"
#include "points/cut_tree.h"
#include "points/limits.h"
#include "points/records.h"
#include "points/sampled_cuts.h"
#include "points/sorted_tile.h"

SCAN_IN_GROUP(scan_pairs, uint64)

// Two counts that are scanned together.
static inline uint64 pair_of(int low, int high) { return (uint64)high << 32 | (uint64)low; }
static inline int low_of(uint64 pair) { return (int)(pair & 0xffffffffU); }
static inline int high_of(uint64 pair) { return (int)(pair >> 32); }

static inline int is_high(coordinate2 p, global const cut_node* cut) {
  const point_keys keys = keys_of(p);
  return goes_high(&keys, cut);
}

// Where a point comes among the nodes `levels` levels below one of its nodes: before (-1) a node, in it (0) or behind.
static inline int side_of_node(coordinate2 p, int number, int levels, global const cut_node* tree) {
  for (int k = levels; k > 0; --k) {
    const int difference = is_high(p, &tree[number >> k]) - (number >> (k - 1) & 1);
    if (difference != 0) return difference;
  }
  return 0;
}

// A node's samples [begin, begin + size) in both orders of a tile, and how many each half has if all leaves are equal.
typedef struct {
  int begin, size, half_size;
} gap_node;

// Each half shall have samples between these shares of the number that it would have if all were equal.
#define MOST_OF_HALF REAL(1.4)
#define LEAST_OF_HALF REAL(0.5)
// No part shall have less than this share of its node.
#define LEAST_OF_NODE REAL(0.3)

// A stretch of `size` samples that begins at `first`; the longest of those considered.
typedef struct {
  int size, first, last;  // may begin at `first` to `last`
} gap_range;

// Devices may round a square root in their own ways.
static inline int whole_root(int x) {
  int root = 0;
  for (int bit = 1 << 14; bit > 0; bit /= 2) {
    if ((root + bit) * (root + bit) <= x) root += bit;
  }
  return root;
}

static inline gap_range gaps_of(gap_node node) {
  gap_range gaps;
  gaps.size = max(1, whole_root(node.size));
  const int least = max((int)(LEAST_OF_NODE * node.size), (int)(LEAST_OF_HALF * node.half_size));
  const int most = max(least, node.size - (int)(MOST_OF_HALF * node.half_size));
  // If no cut leaves both parts enough, the node is cut in the middle.
  const int low = clamp(most, 1, max(1, node.size / 2));
  const int high = max(low, node.size - low);
  gaps.first = max(0, low - gaps.size / 2);
  gaps.last = min(node.size - 1 - gaps.size, high - gaps.size / 2);
  return gaps;
}

// A tile's samples and their orders.
typedef struct {
  local const coordinate2* points;
  local const ushort* orders;  // along x, and TILE_ORDERS behind along y
} sorted_tile;

static inline coordinate2 sorted_sample(sorted_tile tile, int axis, int place) {
  return tile.points[tile.orders[axis * TILE_ORDERS + place]];
}
static inline coordinate along(sorted_tile tile, int axis, int place) {
  const coordinate2 p = sorted_sample(tile, axis, place);
  return axis ? p.y : p.x;
}

// A stretch: along an axis, from a place in the order. Extent 0 and axis NO_AXIS: none.
#define NO_AXIS 2
typedef struct {
  coordinate extent;
  int axis, place;
} gap;

// If gaps are equally wide, the first along x is taken, or else the first along y.
static inline gap wider_gap(gap a, gap b) {
  const int is_before = b.axis < a.axis || (b.axis == a.axis && b.place < a.place);
  return b.extent > a.extent || (b.extent == a.extent && is_before) ? b : a;
}

static inline gap gap_at(sorted_tile tile, gap_range gaps, int axis, int place) {
  gap found;
  found.extent = along(tile, axis, place + gaps.size) - along(tile, axis, place);
  found.axis = axis;
  found.place = place;
  return found;
}

static inline gap no_gap(void) {
  const gap none = {0, NO_AXIS, 0};
  return none;
}

// The widest of a node's gaps, of those that begin `step` places apart from place `lane` on.
static inline gap widest_gap(sorted_tile tile, gap_node node, gap_range gaps, int lane, int step) {
  gap widest = no_gap();
  for (int axis = 0; axis < 2; ++axis) {
    for (int i = gaps.first + lane; i <= gaps.last; i += step) {
      const gap here = gap_at(tile, gaps, axis, node.begin + i);
      if (here.extent > widest.extent) widest = here;
    }
  }
  return widest;
}

// The cut in the middle of a gap, or without a gap at the node's median sample along x.
static inline cut_node cut_in_gap(sorted_tile tile, gap_node node, gap found) {
  if (node.size == 0) return node_of(0, VECTOR(coordinate2, 0, 0));
  if (!(found.extent > 0)) return node_of(0, sorted_sample(tile, 0, node.begin + node.size / 2));
  const coordinate low = along(tile, found.axis, found.place);
  const coordinate middle = low + found.extent / 2;
  const coordinate at = middle > low ? middle : low + found.extent;
  // All points that are as high as the cut go high.
  cut_node cut = node_of(found.axis, found.axis ? VECTOR(coordinate2, 0, at) : VECTOR(coordinate2, at, 0));
  cut.minor = 0;
  return cut;
}

// The place of the node's first sample that goes high.
static inline int split_at(sorted_tile tile, gap_node node, global const cut_node* cut) {
  int begin = node.begin, end = node.begin + node.size;
  while (begin < end) {
    const int middle = (begin + end) / 2;
    if (is_high(sorted_sample(tile, cut_axis(*cut), middle), cut)) {
      end = middle;
    } else {
      begin = middle + 1;
    }
  }
  return begin;
}

// The node of a place in a tile's orders, and how many samples of the nodes before it go low.
typedef struct {
  int number, begin, split, end, lows_before;
} cut_part;

static inline cut_part no_part(void) {
  const cut_part none = {-1, 0, 0, 0, 0};
  return none;
}

// Moves on to the node of place i, which is not before `part`. count: the number of nodes.
static inline cut_part part_of_place(int i, cut_part part, int count, int size, local const int* starts) {
  while (i >= part.end) {
    part.lows_before += part.split - part.begin;
    ++part.number;
    part.begin = part.end;
    part.split = starts[2 * (count + part.number) + 1];
    part.end = part.number + 1 < count ? starts[count + part.number + 1] : size;
  }
  return part;
}

// Cuts levels [level, level + levels) of all trees. groups: the number of nodes of the first of these levels.
// first_groups: of each tree. capacity: how many samples a group takes. from: the samples of the nodes `levels` levels
// above, which `ranges` says by node; of the first node, all samples of the tree. to: those of the groups' nodes.
kernel void cut_at_gaps(int groups, int level, int levels, int capacity, int tree_count,
                        global const int* restrict first_groups, global const sampled_tree* restrict trees,
                        global const coordinate2* restrict from, global coordinate2* to, global int2* ranges,
                        global cut_node* nodes) {
  local coordinate2 points[LARGEST_SAMPLE_TILE];
  local ushort orders[2 * TILE_ORDERS];
  local uint64 sums[LARGEST_TILE_GROUP];
  local int starts[2 << GAP_LEVELS];  // by node, in the order of a heap
  const int me = get_local_id(0), group = get_local_size(0);
  const int w = get_group_id(0);
  const int t = segment_of(min(w, groups - 1), tree_count, first_groups);
  const sampled_tree own = trees[t];
  const int number = (1 << level) + w - first_groups[t], above = level == 0 ? number : number >> levels;
  global cut_node* const tree = nodes + own.first_node;
  global int2* const tree_ranges = ranges + own.first_node;
  int2 range = VECTOR(int2, own.first_sample, w < groups ? own.samples : 0);
  if (above > 1 && w < groups) range = tree_ranges[above];
  // The first node's samples are there.
  const int divided = level > 0 ? range.y : 0, divided_share = share_of(divided);
  const int first_divided = range.x + min(divided, me * divided_share);
  const int last_divided = min(range.x + divided, first_divided + divided_share);
  int before = 0, inside = 0;
  for (int i = first_divided; i < last_divided; ++i) {
    const int side = side_of_node(from[i], number, levels, tree);
    before += side < 0;
    inside += side == 0;
  }
  uint64 all;
  const uint64 counts_before = scan_pairs(pair_of(before, inside), sums, &all);
  if (level > 0) range = VECTOR(int2, range.x + low_of(all), high_of(all));
  int to_place = range.x + high_of(counts_before);
  for (int i = first_divided; i < last_divided; ++i) {
    if (side_of_node(from[i], number, levels, tree) == 0) to[to_place++] = from[i];
  }
  if (level > 0 && me == 0 && w < groups) tree_ranges[number] = range;
  barrier(CLK_GLOBAL_MEM_FENCE);
  global const coordinate2* const source = level > 0 ? to : from;
  const int size = min(range.y, capacity);
  for (int i = me; i < size; i += group) points[i] = source[range.x + (int)((int64)i * range.y / size)];
  int at = sort_samples(size, 0, 2, points, orders);
  // How many samples the node would have if all leaves were equal.
  const int equal = (int)((int64)(own.samples >> level) * size / max(1, range.y));
  const int leaves = own.samples / own.leaf;
  if (me == 0) starts[1] = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int depth = 0; w < groups && depth < levels && (1 << (level + depth)) < leaves; ++depth) {
    const sorted_tile tile = {points, orders + at};
    const int count = 1 << depth, lanes = max(1, group / count), at_once = group / lanes;
    int nodes_before = 0;
    do {
      const int lane = me % lanes, j = nodes_before + me / lanes, is_own = me / lanes < at_once && j < count;
      gap_node node;
      node.begin = is_own ? starts[count + j] : 0;
      node.size = !is_own ? 0 : (j + 1 < count ? starts[count + j + 1] : size) - node.begin;
      node.half_size = equal >> (depth + 1);
      const gap_range gaps = gaps_of(node);
      gap found = widest_gap(tile, node, gaps, lane, lanes);
      sums[me] = pair_of(found.place, found.axis);
      int step = 1;
      do {
        barrier(CLK_LOCAL_MEM_FENCE);
        const int other = is_own && lane + step < lanes && lane % (2 * step) == 0 ? me + step : me;
        const uint64 pair = sums[other];
        if (other != me && high_of(pair) != NO_AXIS)
          found = wider_gap(found, gap_at(tile, gaps, high_of(pair), low_of(pair)));
        barrier(CLK_LOCAL_MEM_FENCE);
        sums[me] = pair_of(found.place, found.axis);
        step *= 2;
      } while (step < lanes);
      if (is_own && lane == 0) {
        global cut_node* const cut = &tree[(number << depth) + j];
        *cut = cut_in_gap(tile, node, found);
        starts[2 * (count + j)] = node.begin;
        starts[2 * (count + j) + 1] = split_at(tile, node, cut);
      }
      nodes_before += at_once;
    } while (nodes_before < count);
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    global const cut_node* const cuts = tree + (number << depth);
    const int share = share_of(size), first = min(size, me * share), last = min(size, first + share);
    int lows[2] = {0, 0};
    cut_part part = no_part();
    for (int i = first; i < last; ++i) {
      part = part_of_place(i, part, count, size, starts);
      for (int axis = 0; axis < 2; ++axis) lows[axis] += !is_high(sorted_sample(tile, axis, i), &cuts[part.number]);
    }
    const uint64 scanned = scan_pairs(pair_of(lows[0], lows[1]), sums, &all);
    lows[0] = low_of(scanned);
    lows[1] = high_of(scanned);
    at = LARGEST_SAMPLE_TILE - at;
    part = no_part();
    for (int i = first; i < last; ++i) {
      part = part_of_place(i, part, count, size, starts);
      for (int axis = 0; axis < 2; ++axis) {
        const ushort sample = tile.orders[axis * TILE_ORDERS + i];
        const int low = lows[axis] - part.lows_before, goes_low = !is_high(points[sample], &cuts[part.number]);
        const int place = goes_low ? part.begin + low : part.split + i - part.begin - low;
        orders[axis * TILE_ORDERS + at + place] = sample;
        lows[axis] += goes_low;
      }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
}
