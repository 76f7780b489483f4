// Regular triangulations of blocks of weighted points, and their merges: as in blocks/divide.cl, with the same
// order of vertices, in as many launches. weights: by index of the input. vertex_weights: by vertex.

#include "blocks/arguments.h"
#include "blocks/block.h"
#include "blocks/halving.h"
#include "blocks/rings_account.h"
#include "mesh/limits.h"
#include "mesh/power_rings.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "points/cut_tree.h"
#include "points/records.h"
#include "predicates/records.h"

#ifndef FIXED_POINT

static inline power_rings power_rings_on(global ring_edge* edges, global const double2* points, global int* vertex_edge,
                                         filter_bounds bounds, global const double* vertex_weights, global int* links,
                                         double weight_range) {
  power_rings g;
  g.all = rings_on(edges, points, vertex_edge, bounds);
  g.weights = vertex_weights;
  g.links = links;
  g.in_doubt = NO_VERTEX;
  g.weight_range = weight_range;
  g.error = INFINITY;
  return g;
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
kernel void merge_weighted_blocks(int n, int first_merge, global const block_merge* restrict merges,
                                  global const cut_node* restrict nodes, global const int* restrict offsets,
                                  filter_bounds bounds, global const double* restrict vertex_weights,
                                  double weight_range, global int* links, global const coordinate2* points,
                                  global ring_edge* edges, global int* vertex_edge, global solved_block* solved,
                                  global volatile uint* account COUNTERS) {
  const int m = get_global_id(0);
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

#endif
