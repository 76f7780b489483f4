// Cut trees of sets of points as in cut_tree.cl, for devices with many lanes: by work-groups.
//
// A chunk of samples of one tree is a tile, which one work-group takes.
//
// 1. draw_each_sample fetches one point from each of equal parts of a set.
// 2. sort_tiles sorts each tile along x and along y in local memory. merge_tiles merges MERGED_RUNS runs into one:
//    a sample's place is the number of samples before it, which it finds by a binary search in each run. The places in
//    both orders are the samples' ranks. All later comparisons are of ranks.
// 3. Nodes larger than a tile are cut level by level: count_tiles counts how many samples of each tile go low, and
//    split_tiles adds up the counts of the tiles before and moves the samples. cut_tiles then cuts all other nodes, a
//    tile in local memory, in one launch.
//
// So each three levels of nodes larger than a tile cost one launch for sorting, and each level two for cutting. All
// levels below cost two launches.

#include "operations/limits.h"
#include "operations/search.h"
#include "operations/work_group.h"
#include "points/arguments.h"
#include "points/limits.h"
#include "points/records.h"
#include "points/sampled_cuts.h"
#include "points/sorted_tile.h"

SCAN_IN_GROUP(scan_samples, uint)

// A work-group's tree and its samples [first, first + size); none, if there are fewer tiles than groups.
typedef struct {
  sampled_tree own;
  int first, size;
} sample_tile;

static inline sample_tile tile_of(int c, int tiles, int tree_count, global const int* first_chunks,
                                  global const sampled_tree* trees) {
  const int t = segment_of(c, tree_count, first_chunks);
  sample_tile tile;
  tile.own = trees[t];
  tile.first = tile.own.first_sample + (c - first_chunks[t]) * tile.own.chunk;
  tile.size = c < tiles ? tile.own.chunk : 0;
  return tile;
}

kernel void draw_each_sample(int n, int tree_count, global const int* restrict first_samples,
                             global const sampled_tree* restrict trees, global const coordinate* restrict input,
                             global coordinate2* restrict samples, global int* restrict indices) {
  const int i = get_global_id(0);
  if (i < n) {
    const sampled_tree own = trees[segment_of(i, tree_count, first_samples)];
    const int point = drawn_point(own, i - own.first_sample);
    indices[i] = point;
    samples[i] = vload2(point, input);
  }
}

// Two work-groups per tile, one per axis. order holds the order along x and then the one along y; ranks, for each
// sample, its places in both. Equal points stay in the order in which they were drawn, also later.
kernel void sort_tiles(int tiles, SAMPLED_CHUNKS(), global int* restrict order, global int* restrict ranks) {
  local coordinate2 points[LARGEST_SAMPLE_TILE];
  local ushort orders[TILE_ORDERS];
  const int me = get_local_id(0), group = get_local_size(0);
  const int w = get_group_id(0), axis = w % 2;
  const sample_tile tile = tile_of(w / 2, tiles, tree_count, first_chunks, trees);
  for (int i = me; i < tile.size; i += group) points[i] = samples[tile.first + i];
  const int from = sort_samples(tile.size, axis, 1, points, orders);
  for (int i = me; i < tile.size; i += group) {
    const int sample = tile.first + orders[from + i];
    order[axis * all_samples + tile.first + i] = sample;
    ranks[2 * sample + axis] = tile.first + i;
  }
}

// Merges MERGED_RUNS runs into one, each of MERGED_RUNS^widenings tiles. One work-item per sample and axis. Trees that
// are sorted already are copied.
kernel void merge_tiles(int n, int tree_count, global const int* restrict first_samples,
                        global const sampled_tree* restrict trees, int all_samples, int widenings,
                        global const coordinate2* restrict samples, global const int* restrict from,
                        global int* restrict to, global int* restrict ranks) {
  const int w = get_global_id(0);
  if (w < n) {
    const int axis = w / all_samples, i = w % all_samples;
    const sampled_tree own = trees[segment_of(i, tree_count, first_samples)];
    const int run = own.chunk << (widenings * MERGED_RUNS_BITS);
    const int sample = from[w];
    int place = i;
    if (run < own.samples) {
      const int inside = i - own.first_sample;
      const int my_run = inside / run % MERGED_RUNS, first_run = inside / run - my_run;
      const int runs = min(MERGED_RUNS, own.samples / run - first_run);
      const int begin = own.first_sample + first_run * run;
      global const int* const order = from + axis * all_samples + begin;
      const coordinate2 p = samples[sample];
      int before[MERGED_RUNS];
      for (int r = 0; r < MERGED_RUNS; ++r) before[r] = 0;
      // All runs are as long as each other, so that the searches take their steps at the same time.
      for (int step = 1 << (31 - clz(run)); step > 0; step /= 2) {
        for (int r = 0; r < MERGED_RUNS; ++r) {
          const int next = before[r] + step;
          if (r < runs && next <= run) {
            const coordinate2 q = samples[order[r * run + next - 1]];
            if (r < my_run ? !precedes(p, q, axis) : precedes(q, p, axis)) before[r] = next;
          }
        }
      }
      place = begin + inside % run;
      for (int r = 0; r < MERGED_RUNS; ++r) place += r == my_run ? 0 : before[r];
    }
    to[axis * all_samples + place] = sample;
    ranks[2 * sample + axis] = place;
  }
}

// A tile's part of a node that is larger than a tile. For other nodes, is_large is 0.
typedef struct {
  int is_large, begin, size;
  sample_cut cut;
  int pivot_rank;
} node_part;

static inline node_part part_of(sample_tile tile, int level, int all_samples, global const coordinate2* samples,
                                global const int* order, global const int* ranks) {
  node_part part;
  part.size = node_samples(tile.own, level);
  part.is_large = part.size > tile.own.chunk && tile.size > 0;
  part.begin = tile.first;
  if (part.is_large) {
    part.begin -= (tile.first - tile.own.first_sample) % part.size;
    part.cut = cut_of(part.begin, part.size, samples, order, order + all_samples);
    part.pivot_rank = ranks[2 * part.cut.sample + part.cut.axis];
  }
  return part;
}

static inline int goes_below(int sample, node_part part, global const int* ranks) {
  return ranks[2 * sample + part.cut.axis] < part.pivot_rank;
}

// Writes the nodes of a level, if they are larger than tiles. Counts how many samples of each tile of the other order
// than the one along the axis go low. order: along x, then along y.
kernel void count_tiles(int tiles, SAMPLED_CHUNKS(), int level, global const int* restrict order,
                        global const int* restrict ranks, global cut_node* restrict nodes,
                        global uint* restrict counts) {
  local uint sums[LARGEST_TILE_GROUP];
  const int me = get_local_id(0), group = get_local_size(0);
  const int c = get_group_id(0);
  const sample_tile tile = tile_of(c, tiles, tree_count, first_chunks, trees);
  const node_part part = part_of(tile, level, all_samples, samples, order, ranks);
  uint low = 0, all;
  if (part.is_large) {
    global const int* const other = order + (part.cut.axis ? 0 : all_samples) + tile.first;
    for (int i = me; i < tile.size; i += group) low += goes_below(other[i], part, ranks);
  }
  scan_samples(low, sums, &all);
  if (part.is_large && me == 0) {
    counts[c] = all;
    if (part.begin == tile.first) {
      const int number = (tile.first - tile.own.first_sample) / part.size;
      nodes[tile.own.first_node + (1 << level) + number] = node_of(part.cut.axis, part.cut.pivot);
    }
  }
}

// Moves the halves of nodes that are larger than tiles to their places in both orders; copies other samples.
// The order along the axis is split by position, the other one by a stable split.
kernel void split_tiles(int tiles, SAMPLED_CHUNKS(), int level, global const uint* restrict counts,
                        global const int* restrict from, global const int* restrict ranks, global int* restrict to) {
  local uint sums[LARGEST_TILE_GROUP];
  const int me = get_local_id(0), group = get_local_size(0);
  const int c = get_group_id(0);
  const sample_tile tile = tile_of(c, tiles, tree_count, first_chunks, trees);
  const node_part part = part_of(tile, level, all_samples, samples, from, ranks);
  const int cut_order = part.is_large && part.cut.axis ? all_samples : 0, other = all_samples - cut_order;
  for (int i = tile.first + me; i < tile.first + tile.size; i += group) to[cut_order + i] = from[cut_order + i];
  const int share = share_of(tile.size);
  const int first = tile.first + min(tile.size, me * share), last = min(tile.first + tile.size, first + share);
  uint lows_before = 0, lows = 0, all;
  if (part.is_large) {
    for (int k = c - (tile.first - part.begin) / tile.own.chunk + me; k < c; k += group) lows_before += counts[k];
    for (int i = first; i < last; ++i) lows += goes_below(from[other + i], part, ranks);
  }
  scan_samples(lows_before, sums, &lows_before);
  lows_before += scan_samples(lows, sums, &all);
  int low = part.begin + (int)lows_before;
  int high = part.begin + part.size / 2 + (first - part.begin - (int)lows_before);
  for (int i = first; i < last; ++i) {
    const int sample = from[other + i];
    const int place = !part.is_large ? i : goes_below(sample, part, ranks) ? low++ : high++;
    to[other + place] = sample;
  }
}

// Whether a sample, by its ranks, goes low at a cut: by its axis and the rank of its pivot.
static inline int is_below(int2 sample, int2 cut) { return (cut.x ? sample.y : sample.x) < cut.y; }

// Cuts the nodes of a tile's samples and all nodes below. sorted: all samples as they were sorted along x, from which
// ranks lead back to samples. order: both orders are then that of the leaves.
kernel void cut_tiles(int tiles, SAMPLED_CHUNKS(), global const int* restrict sorted, global const int* restrict ranks,
                      global const int* from, global cut_node* restrict nodes, global int* order) {
  local int2 by_axis[2 * LARGEST_SAMPLE_TILE];
  local int2 moved[LARGEST_SAMPLE_TILE];
  local int2 cuts[LARGEST_SAMPLE_TILE / 2];
  local uint sums[LARGEST_TILE_GROUP];
  const int me = get_local_id(0), group = get_local_size(0);
  const sample_tile tile = tile_of(get_group_id(0), tiles, tree_count, first_chunks, trees);
  const sampled_tree own = tile.own;
  const int share = share_of(tile.size);
  const int first = min(tile.size, me * share), last = min(tile.size, first + share);
  for (int axis = 0; axis < 2; ++axis) {
    for (int i = me; i < tile.size; i += group) {
      by_axis[axis * LARGEST_SAMPLE_TILE + i] = vload2(from[axis * all_samples + tile.first + i], ranks);
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
  local int2* const by_x = by_axis;
  local int2* const by_y = by_axis + LARGEST_SAMPLE_TILE;
  for (int size = tile.size; size > own.leaf; size /= 2) {
    for (int begin = me * size; begin < tile.size; begin += group * size) {
      const int low = begin + size / 4, high = begin + size - 1 - size / 4;
      const coordinate width = rounded_difference(samples[sorted[by_x[high].x]].x, samples[sorted[by_x[low].x]].x);
      const coordinate height = rounded_difference(samples[sorted[by_y[high].x]].y, samples[sorted[by_y[low].x]].y);
      const int axis = height > width;
      const int2 pivot = axis ? by_y[begin + size / 2] : by_x[begin + size / 2];
      cuts[begin / size] = VECTOR(int2, axis, axis ? pivot.y : pivot.x);
      nodes[own.first_node + (own.samples + tile.first + begin - own.first_sample) / size] =
          node_of(axis, samples[sorted[pivot.x]]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    uint lows = 0, all;
    for (int i = first; i < last; ++i) {
      const int2 cut = cuts[i / size];
      lows += is_below(cut.x ? by_x[i] : by_y[i], cut);
    }
    // Half of the samples of each node before went low.
    int low = (int)scan_samples(lows, sums, &all);
    for (int i = first; i < last; ++i) {
      const int2 cut = cuts[i / size];
      const int2 sample = cut.x ? by_x[i] : by_y[i];
      const int begin = i / size * size, low_before = low - begin / 2;
      const int goes_low = is_below(sample, cut);
      moved[begin + (goes_low ? low_before : size / 2 + (i - begin) - low_before)] = sample;
      low += goes_low;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int i = me; i < tile.size; i += group) {
      if (cuts[i / size].x) {
        by_x[i] = moved[i];
      } else {
        by_y[i] = moved[i];
      }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  for (int axis = 0; axis < 2; ++axis) {
    for (int i = me; i < tile.size; i += group) {
      order[axis * all_samples + tile.first + i] = sorted[by_axis[axis * LARGEST_SAMPLE_TILE + i].x];
    }
  }
}
