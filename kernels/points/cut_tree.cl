// Cut trees (points/cut_tree.h) of sets of points, made from samples of the points; all sets at once.
//
// The samples of a tree are cut in halves down to the leaves: each node's samples at the median, across the
// longer of their interquartile ranges. One work-item takes one chunk of samples of one tree: as many as a leaf
// has, or 2, 4, 8... times as many. cut_tree_tiles.cl does the same for devices with many lanes.
//
// 1. draw_samples fetches one point from each of equal parts of a set.
// 2. sort_chunks sorts each chunk along x and along y. merge_runs merges sorted runs, in one launch per doubling.
// 3. Nodes larger than a chunk are cut level by level: count_low counts how many samples of each chunk go low, the
//    counts are scanned, and split_chunks moves the samples. cut_chunks then cuts all other nodes, in one launch.
//
// So each level of nodes larger than chunks costs one pass over the samples for sorting and two for cutting. The levels
// below cost one pass each, all in two launches.

#include "operations/search.h"
#include "points/arguments.h"
#include "points/records.h"
#include "points/sampled_cuts.h"
#include "predicates/order.h"

// A chunk's tree and its first sample.
typedef struct {
  sampled_tree own;
  int first;
} sample_chunk;

// Chunk c of all trees; of each, the first is known.
static inline sample_chunk chunk_of(int c, int tree_count, global const int* first_chunks,
                                    global const sampled_tree* trees) {
  const int t = segment_of(c, tree_count, first_chunks);
  sample_chunk chunk;
  chunk.own = trees[t];
  chunk.first = chunk.own.first_sample + (c - first_chunks[t]) * chunk.own.chunk;
  return chunk;
}

kernel void draw_samples(int n, int tree_count, global const int* restrict first_chunks,
                         global const sampled_tree* restrict trees, global const coordinate* restrict input,
                         global coordinate2* restrict samples, global int* restrict indices) {
  const int c = get_global_id(0);
  if (c < n) {
    const sample_chunk chunk = chunk_of(c, tree_count, first_chunks, trees);
    const sampled_tree own = chunk.own;
    const int first = chunk.first;
    for (int i = first; i < first + own.chunk; ++i) {
      indices[i] = drawn_point(own, i - own.first_sample);
      samples[i] = vload2(indices[i], input);
    }
  }
}

// Two work-items per chunk, one per axis. elements, spare and order hold the order along x and then the one
// along y. Equal points stay in the order in which they were drawn, also later.
kernel void sort_chunks(int n, SAMPLED_CHUNKS(), global keyed* elements, global keyed* spare, global int* order) {
  const int w = get_global_id(0);
  if (w < n) {
    const int c = w / 2, axis = w % 2;
    const sample_chunk chunk = chunk_of(c, tree_count, first_chunks, trees);
    const sampled_tree own = chunk.own;
    const int first = chunk.first;
    const int place = axis * all_samples + first;
    for (int i = 0; i < own.chunk; ++i) elements[place + i] = keyed_place(0, i);
    global const keyed* const sorted = sort_along(elements + place, spare + place, own.chunk, samples + first, axis);
    for (int i = 0; i < own.chunk; ++i) order[place + i] = first + place_of_keyed(sorted[i]);
  }
}

// How many of the first `taken` elements of two merged runs are from the low one.
static inline int taken_from_low(int taken, int run, global const int* low, global const int* high,
                                 global const coordinate2* samples, int axis) {
  int least = max(0, taken - run), most = min(taken, run);
  while (least < most) {
    const int middle = (least + most) / 2;
    if (precedes(samples[high[taken - 1 - middle]], samples[low[middle]], axis)) {
      most = middle;
    } else {
      least = middle + 1;
    }
  }
  return least;
}

// Merges pairs of runs of 2^doublings chunks each. Two work-items per chunk of the result, one per axis. Trees that are
// sorted already are copied.
kernel void merge_runs(int n, SAMPLED_CHUNKS(), int doublings, global const int* from, global int* to) {
  const int w = get_global_id(0);
  if (w < n) {
    const int c = w / 2, axis = w % 2;
    const sample_chunk chunk = chunk_of(c, tree_count, first_chunks, trees);
    const sampled_tree own = chunk.own;
    const int first = axis * all_samples + chunk.first;
    const int run = own.chunk << doublings;
    if (run >= own.samples) {
      for (int i = first; i < first + own.chunk; ++i) to[i] = from[i];
    } else {
      const int tree_first = axis * all_samples + own.first_sample;
      const int pair = tree_first + (first - tree_first) / (2 * run) * (2 * run);
      global const int* const low = from + pair;
      global const int* const high = low + run;
      int a = taken_from_low(first - pair, run, low, high, samples, axis);
      int b = first - pair - a;
      for (int i = first; i < first + own.chunk; ++i) {
        const int take_high = a == run || (b < run && precedes(samples[high[b]], samples[low[a]], axis));
        to[i] = take_high ? high[b++] : low[a++];
      }
    }
  }
}

static inline int goes_low(int sample, sample_cut cut, global const coordinate2* samples) {
  const coordinate2 p = samples[sample];
  const int is_equal = (p.x == cut.pivot.x) & (p.y == cut.pivot.y);
  return precedes(p, cut.pivot, cut.axis) | (is_equal & (sample < cut.sample));
}

// Writes the nodes of a level, if they are larger than chunks. Counts how many samples of each chunk of the other order
// than the one along the axis go low. order: along x, then along y.
kernel void count_low(int n, SAMPLED_CHUNKS(), int level, global const int* order, global cut_node* restrict nodes,
                      global uint* restrict counts) {
  const int c = get_global_id(0);
  if (c < n) {
    const sample_chunk chunk = chunk_of(c, tree_count, first_chunks, trees);
    const sampled_tree own = chunk.own;
    const int size = node_samples(own, level);
    uint low = 0;
    if (size > own.chunk) {
      const int first = chunk.first;
      const int number = (first - own.first_sample) / size;
      const int begin = own.first_sample + number * size;
      const sample_cut cut = cut_of(begin, size, samples, order, order + all_samples);
      if (first == begin) nodes[own.first_node + (1 << level) + number] = node_of(cut.axis, cut.pivot);
      global const int* const other = order + (cut.axis ? 0 : all_samples);
      for (int i = first; i < first + own.chunk; ++i) low += goes_low(other[i], cut, samples);
    }
    counts[c] = low;
  }
}

// Moves the halves of nodes that are larger than chunks to their places in both orders; copies other samples.
// The order along the axis is split by position, the other one by a stable split.
kernel void split_chunks(int n, SAMPLED_CHUNKS(), int level, global const uint* restrict scanned,
                         global const int* from, global int* to) {
  const int c = get_global_id(0);
  if (c < n) {
    const sample_chunk chunk = chunk_of(c, tree_count, first_chunks, trees);
    const sampled_tree own = chunk.own;
    const int first = chunk.first;
    const int size = node_samples(own, level);
    if (size > own.chunk) {
      const int begin = first - (first - own.first_sample) % size;
      const sample_cut cut = cut_of(begin, size, samples, from, from + all_samples);
      const int cut_order = cut.axis ? all_samples : 0, other = all_samples - cut_order;
      const int before = (int)(scanned[c] - scanned[c - (first - begin) / own.chunk]);
      int low = begin + before, high = begin + size / 2 + (first - begin - before);
      for (int i = first; i < first + own.chunk; ++i) {
        to[cut_order + i] = from[cut_order + i];
        const int sample = from[other + i];
        to[other + (goes_low(sample, cut, samples) ? low++ : high++)] = sample;
      }
    } else {
      for (int i = first; i < first + own.chunk; ++i) {
        to[i] = from[i];
        to[all_samples + i] = from[all_samples + i];
      }
    }
  }
}

// Splits [begin, begin + size) of an order stably.
static inline void split_run(int begin, int size, sample_cut cut, global const coordinate2* samples, global int* order,
                             global int* spare) {
  int low = begin, high = begin;
  for (int i = begin; i < begin + size; ++i) {
    const int sample = order[i];
    const int is_low = goes_low(sample, cut, samples);
    order[low] = sample;  // low <= i
    spare[high] = sample;
    low += is_low;
    high += !is_low;
  }
  for (int i = begin; i < high; ++i) order[low + i - begin] = spare[i];
}

// Cuts the nodes of a chunk's samples and all nodes below. Both orders are then that of the leaves.
kernel void cut_chunks(int n, SAMPLED_CHUNKS(), global int* order, global int* spare, global cut_node* restrict nodes) {
  const int c = get_global_id(0);
  if (c < n) {
    const sample_chunk chunk = chunk_of(c, tree_count, first_chunks, trees);
    const sampled_tree own = chunk.own;
    const int first = chunk.first;
    for (int size = own.chunk; size > own.leaf; size /= 2) {
      for (int begin = first; begin < first + own.chunk; begin += size) {
        const sample_cut cut = cut_of(begin, size, samples, order, order + all_samples);
        nodes[own.first_node + (own.samples + begin - own.first_sample) / size] = node_of(cut.axis, cut.pivot);
        split_run(begin, size, cut, samples, order + (cut.axis ? 0 : all_samples), spare);
      }
    }
  }
}
