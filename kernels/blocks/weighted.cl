// Regular triangulations of blocks of weighted points, and their merges: as in blocks/divide.cl, with the same
// order of vertices, in as many launches. weights: by index of the input. vertex_weights: by vertex.
//
// scale_weights comes before, with one work-item per chunk of points. After the merges, rows_before_sets finds the
// number of triangles of each set, which hidden points reduce. flag_hidden is a pass over the vertices. flag_lighter
// and gather_lighter, per point, tell the host which points are in the place of heavier ones; settle_lighter takes the
// representatives that it gives them.

#include "arithmetic/bit_account.h"
#include "arithmetic/coordinates.h"
#include "blocks/arguments.h"
#include "blocks/block.h"
#include "blocks/halving.h"
#include "blocks/rings_account.h"
#include "mesh/limits.h"
#include "mesh/power_rings.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "operations/search.h"
#include "operations/spread.h"
#include "points/cut_tree.h"
#include "points/records.h"
#include "predicates/bounds.h"
#include "predicates/records.h"

#ifndef FIXED_POINT

// Whether a weight, scaled as the squares of its point's coordinates are, is such a sum of squares itself.
static inline int is_accepted(double weight, double scaled_weight) {
  if (!(fabs(scaled_weight) < ldexp(1.0, 2 * LARGEST_EXPONENT + 1))) return 0;
  bit_account bits = no_bits();
  account_for(as_ulong(scaled_weight) & MAGNITUDE_BITS, &bits);
  return weight == 0.0 || (scaled_weight != 0.0 && bits.lowest >= 2 * LOWEST_EXPONENT);
}

// shifts: as for scale_sets of points/inspect.cl. bad: becomes the first point whose weight is not accepted. ranges: by
// chunk, the least and the greatest weight.
kernel void scale_weights(int n, int chunk, int sets, global const int* restrict offsets,
                          global const int* restrict shifts, global const double* restrict weights,
                          global double* restrict scaled_weights, global volatile int* restrict bad,
                          global double2* restrict ranges) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    double least = INFINITY, greatest = -INFINITY;
    int first_bad = NO_BAD;
    for (int i = low; i < min(n, low + chunk); ++i) {
      const scaling scale = scale_of(shifts[segment_of(i, sets, offsets)]);
      const double weight = weights[i], scaled_weight = scaled(scaled(weight, scale), scale);
      if (!is_accepted(weight, scaled_weight)) first_bad = min(first_bad, i);
      scaled_weights[i] = scaled_weight;
      least = fmin(least, scaled_weight);
      greatest = fmax(greatest, scaled_weight);
    }
    ranges[c] = VECTOR(double2, least, greatest);
    if (first_bad != NO_BAD) atomic_min(bad, first_bad);
  }
}

// Triangulates one block, which is halved. Returns its hull's ends.
static inline hull_ends solve_weighted_block(power_rings* g, int first, int count, global const uchar* axes) {
  const int depth = halving_depth(count);
  hull_ends stack[MOST_DEPTH];
  int height = 0;
  for (int i = 0; i < 1 << depth; ++i) {
    const int begin = part_begin(count, depth, i);
    fetch_edges_ahead(g->all.edges, first + begin);
    hull_ends whole = make_power_leaf(g, first + begin, part_begin(count, depth, i + 1) - begin);
    for (int node = ((1 << depth) + i); node & 1 && node > 1; node >>= 1) {
      const hull_ends low = stack[--height];
      whole = merge_power_triangulations(g, low, whole, axes[node >> 1], first + begin_of_node(count, node));
    }
    stack[height++] = whole;
  }
  return stack[0];
}

// See solve_blocks. A point in the place of a heavier one gets as representative the complement of that one.
kernel void solve_weighted_blocks(int workers, int blocks, int capacity, int larger, global const int* restrict offsets,
                                  filter_bounds bounds, global const double* restrict weights, double weight_range,
                                  global double* vertex_weights, global int* links, global volatile int* next,
                                  BLOCK_POINTS(), global ring_edge* edges, global int* vertex_edge,
                                  global volatile uint* account, BLOCK_SCRATCH(), global uchar* scratch_axes COUNTERS) {
  const int w = get_global_id(0);
  if (w < workers) {
    const int64 base = (int64)w * capacity;
    for (int b = atomic_inc(next); b < blocks; b = atomic_inc(next)) {
      const int first = offsets[b], count = offsets[b + 1] - first;
      if (count > capacity || count <= larger) continue;
      block_scratch s = scratch_from(base, capacity, scratch_points, scratch_source, scratch_ranks, scratch_axes);
      const int distinct = order_block(first, count, weights, &s, points, source, representatives);
      for (int v = first; v < first + distinct; ++v) vertex_weights[v] = weights[source[v]];
      power_rings g = power_rings_on(edges, points, vertex_edge, bounds, vertex_weights, links, weight_range);
      g.all.unused = EDGES_PER_VERTEX * first;
      const hull_ends ends = distinct == 0 ? no_ends() : solve_weighted_block(&g, first, distinct, s.axes);
      for (int v = first + distinct; v < first + count; ++v) vertex_edge[v] = NO_EDGE;
      free_unused(&g.all, EDGES_PER_VERTEX * (first + count));
      const solved_block done = {ends, free_list(&g.all)};
      solved[b] = done;
      distinct_counts[b] = distinct;
      add_to_account(&g.all, account);
      COUNT_STEPS(g.all.counted.steps);
    }
  }
}

// See merge_blocks.
kernel void merge_weighted_blocks(int n, int spread, int first_merge, global const block_merge* restrict merges,
                                  global const cut_node* restrict nodes, global const int* restrict offsets,
                                  filter_bounds bounds, global const double* restrict vertex_weights,
                                  double weight_range, global int* links, global const coordinate2* points,
                                  global ring_edge* edges, global int* vertex_edge, global solved_block* solved,
                                  global volatile uint* account COUNTERS) {
  const int m = spread_item(n, spread);
  if (m < n) {
    const block_merge merge = merges[first_merge + m];
    const hull_ends low = solved[merge.low].ends, high = solved[merge.high].ends;
    const int axis = cut_axis(nodes[merge.node]);
    power_rings g = power_rings_on(edges, points, vertex_edge, bounds, vertex_weights, links, weight_range);
    join_free_lists(&g.all, solved[merge.low].unused, solved[merge.high].unused);
    hull_ends both = joined_ends(&g.all, low, high, axis);
    if (low.first_x != NO_VERTEX && high.first_x != NO_VERTEX) {
      both = merge_power_triangulations(&g, low, high, axis, offsets[merge.high]);
    }
    solved[merge.low].ends = both;
    solved[merge.low].unused = free_list(&g.all);
    add_to_account(&g.all, account);
    COUNT_STEPS(g.all.counted.steps);
  }
}

// n sets, and where the last one ends: the rows before.
kernel void rows_before_sets(int n, global const int* restrict set_blocks, global const int* restrict offsets,
                             global const uint* restrict first_rows, global uint* restrict rows) {
  const int s = get_global_id(0);
  if (s < n) rows[s] = first_rows[offsets[set_blocks[s]]];
}

// Whether each point is in the place of a heavier one.
kernel void flag_lighter(int n, global const int* restrict representatives, global uchar* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) flags[i] = representatives[i] < 0;
}

kernel void gather_lighter(int n, global const int* restrict lighter, global const int* restrict representatives,
                           global const double* restrict weights, global int* restrict names,
                           global double* restrict their_weights) {
  const int k = get_global_id(0);
  if (k < n) {
    names[k] = representatives[lighter[k]];
    their_weights[k] = weights[lighter[k]];
  }
}

// names: the representatives of lighter points. Those of themselves are hidden.
kernel void settle_lighter(int n, global const int* restrict lighter, global const int* restrict names,
                           global int* restrict representatives, global uchar* restrict hidden) {
  const int k = get_global_id(0);
  if (k < n) {
    representatives[lighter[k]] = names[k];
    hidden[lighter[k]] = names[k] == lighter[k];
  }
}

// n places of vertices. hidden: by point, 0 at first.
kernel void flag_hidden(int n, global const int* restrict vertex_edge, global const int* restrict source,
                        global uchar* restrict hidden) {
  const int v = get_global_id(0);
  if (v < n && vertex_edge[v] == HIDDEN_VERTEX) hidden[source[v]] = 1;
}

#endif
