// Cut trees (points/cut_tree.h) of points that lie along the cuts of an earlier tree, made from sorted samples of them
// (cut_tree_tiles.cl), on devices with many lanes.
//
// Medians would fall onto the old cuts, since that is where the points are. Each node is cut in the middle of its
// widest gap instead: of all stretches of about sqrt(m) consecutive samples of m, along either axis, the longest. Gaps
// that would make a part much larger or smaller than a half are not considered, so that all leaves have about as many
// points.
//
// cut_at_gaps cuts the nodes of one level of all trees, in one launch with one work-group per node: it finds the gap,
// writes the node, and splits the samples of the other order than the one along the axis. That makes one launch per
// level.

#include "operations/limits.h"
#include "operations/search.h"
#include "operations/work_group.h"
#include "points/records.h"
#include "points/sampled_cuts.h"

SCAN_IN_GROUP(scan_low, uint)

// A node's samples [begin, begin + size) in both orders, and how many samples each half has if all leaves are equal.
typedef struct {
  sampled_tree own;
  int number;  // in the heap
  int begin, size, half_size;
} gap_node;

// Group w's node at a level. first_groups: of each tree. If there are fewer nodes, it has no samples.
static inline gap_node node_of_group(int w, int groups, int level, int tree_count, global const int* first_groups,
                                     global const sampled_tree* trees, global const int2* ranges) {
  gap_node node;
  const int t = segment_of(min(w, groups - 1), tree_count, first_groups);
  node.own = trees[t];
  node.number = (1 << level) + w - first_groups[t];
  node.begin = node.own.first_sample;
  node.size = node.own.samples;
  node.half_size = node.own.samples >> (level + 1);
  if (w >= groups) {
    node.size = 0;
  } else if (level > 0) {
    const int2 range = ranges[node.own.first_node + node.number];
    node.begin = range.x;
    node.size = range.y - range.x;
  }
  return node;
}

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

static inline coordinate along(int sample, int axis, global const coordinate2* samples) {
  return axis ? samples[sample].y : samples[sample].x;
}

// A cut of a node: samples of the order along the axis before place `split` go low.
typedef struct {
  int axis, split;
  cut_node node;
} gap_cut;

// Cuts in the middle of the gap at a place, or without a gap (extent 0) at the node's median sample.
static inline gap_cut cut_in_gap(gap_node node, gap_range gaps, coordinate extent, int first, int axis, int all_samples,
                                 global const coordinate2* samples, global const int* order) {
  gap_cut cut;
  cut.axis = axis;
  global const int* const sorted = order + axis * all_samples + node.begin;
  cut.split = node.size / 2;
  const coordinate2 median = samples[sorted[min(cut.split, node.size - 1)]];
  cut.node = node_of(axis, median);
  if (extent > 0) {
    const coordinate low = along(sorted[first], axis, samples);
    const coordinate middle = low + extent / 2;
    const coordinate at = middle > low ? middle : low + extent;
    int before = first, behind = first + gaps.size;  // the one is below the cut, the other is not
    while (behind - before > 1) {
      const int between = (before + behind) / 2;
      if (along(sorted[between], axis, samples) < at) {
        before = between;
      } else {
        behind = between;
      }
    }
    cut.split = behind;
    // All points that are as high as the cut go high.
    cut.node = node_of(axis, axis ? VECTOR(coordinate2, 0, at) : VECTOR(coordinate2, at, 0));
    cut.node.minor = 0;
  }
  return cut;
}

// groups: the number of nodes of the level. order: along x, then along y; ranks: for each sample, its places in both
// when they were made. ranges: of each node, where its samples begin and end.
kernel void cut_at_gaps(int groups, int level, int tree_count, global const int* restrict first_groups,
                        global const sampled_tree* restrict trees, int all_samples,
                        global const coordinate2* restrict samples, global const int* restrict ranks,
                        global const int* restrict from, global int* restrict to, global int2* ranges,
                        global cut_node* restrict nodes) {
  local coordinate extents[LARGEST_TILE_GROUP];
  local int2 places[LARGEST_TILE_GROUP];
  local uint sums[LARGEST_TILE_GROUP];
  const int me = get_local_id(0), group = get_local_size(0);
  const gap_node node = node_of_group(get_group_id(0), groups, level, tree_count, first_groups, trees, ranges);
  const gap_range gaps = gaps_of(node);
  coordinate extent = 0;
  int2 place = VECTOR(int2, 0, 0);
  for (int axis = 0; axis < 2; ++axis) {
    global const int* const sorted = from + axis * all_samples + node.begin;
    for (int i = gaps.first + me; i <= gaps.last; i += group) {
      const coordinate here = along(sorted[i + gaps.size], axis, samples) - along(sorted[i], axis, samples);
      if (here > extent) {
        extent = here;
        place = VECTOR(int2, i, axis);
      }
    }
  }
  extents[me] = extent;
  places[me] = place;
  barrier(CLK_LOCAL_MEM_FENCE);
  // If gaps are equally wide, the first along x is taken, or else the first along y.
  for (int k = 0; k < group; ++k) {
    const int2 other = places[k];
    const int is_before = other.y < place.y || (other.y == place.y && other.x < place.x);
    if (extents[k] > extent || (extents[k] == extent && is_before)) {
      extent = extents[k];
      place = other;
    }
  }
  const int has_samples = node.size > 0;
  // The cut of a node without samples.
  gap_cut cut;
  cut.axis = cut.split = 0;
  cut.node = node_of(0, VECTOR(coordinate2, 0, 0));
  int rank = 0;
  if (has_samples) {
    cut = cut_in_gap(node, gaps, extent, place.x, place.y, all_samples, samples, from);
    rank = ranks[2 * from[cut.axis * all_samples + node.begin + cut.split] + cut.axis];
  }
  const int along_axis = cut.axis * all_samples, other = all_samples - along_axis;
  for (int i = node.begin + me; i < node.begin + node.size; i += group) to[along_axis + i] = from[along_axis + i];
  const int share = share_of(node.size);
  const int first = min(node.size, me * share), last = min(node.size, first + share);
  uint lows = 0, all;
  for (int i = first; i < last; ++i) lows += ranks[2 * from[other + node.begin + i] + cut.axis] < rank;
  const int lows_before = (int)scan_low(lows, sums, &all);
  int low = node.begin + lows_before, high = node.begin + cut.split + first - lows_before;
  for (int i = first; i < last; ++i) {
    const int sample = from[other + node.begin + i];
    to[other + (ranks[2 * sample + cut.axis] < rank ? low++ : high++)] = sample;
  }
  if ((int)get_group_id(0) < groups && me == 0) {
    nodes[node.own.first_node + node.number] = cut.node;
    if (2 * node.number < node.own.samples / node.own.leaf) {
      const int split = node.begin + cut.split;
      ranges[node.own.first_node + 2 * node.number] = VECTOR(int2, node.begin, split);
      ranges[node.own.first_node + 2 * node.number + 1] = VECTOR(int2, split, node.begin + node.size);
    }
  }
}
