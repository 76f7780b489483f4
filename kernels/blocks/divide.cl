// Dwyer's divide and conquer (Algorithmica 2, 1987) on blocks of points, and the merges of blocks.
//
// solve_blocks is one launch; each work-item takes one block after the other. It sorts the block's points along x and
// along y, drops duplicates, cuts the block in halves down to leaves of one to four vertices, each time across the
// longer interquartile range, and merges from the leaves up (mesh/rings.h). Vertices are numbered in the order of the
// leaves, so the data of a merge is contiguous. merge_blocks merges the two triangulations on either side of
// the cut of a tree's node: one launch per level of the trees, from the leaves up, with one work-item per node.

#include "blocks/arguments.h"
#include "blocks/block.h"
#include "blocks/halving.h"
#include "blocks/rings_account.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "points/cut_tree.h"
#include "points/records.h"
#include "predicates/records.h"

// Triangulates one block, which is halved. Returns its hull's ends.
static inline hull_ends solve_block(rings* g, int first, int count, global const uchar* axes) {
  const int depth = halving_depth(count);
  // Depth first: after leaf i, as many merges as its number has trailing ones.
  hull_ends stack[MOST_DEPTH];
  int height = 0;
  for (int i = 0; i < 1 << depth; ++i) {
    const int begin = part_begin(count, depth, i);
    fetch_edges_ahead(g->edges, first + begin);
    hull_ends whole = make_leaf(g, first + begin, part_begin(count, depth, i + 1) - begin);
    for (int node = ((1 << depth) + i); node & 1 && node > 1; node >>= 1) {
      const hull_ends low = stack[--height];
      whole = merge_triangulations(g, low, whole, axes[node >> 1]);
    }
    stack[height++] = whole;
  }
  return stack[0];
}

// Solves the blocks of more than `larger` and at most `capacity` points. Each work-item's part of the scratch arrays
// has room for `capacity` points. next: the next block to be taken; 0 at first.
kernel void solve_blocks(int workers, int blocks, int capacity, int larger, global const int* restrict offsets,
                         filter_bounds bounds, uint most_ties, global volatile int* next, BLOCK_POINTS(),
                         global ring_edge* edges, global int* vertex_edge, global volatile uint* account,
                         BLOCK_SCRATCH(), global uchar* scratch_axes COUNTERS) {
  const int w = get_global_id(0);
  if (w < workers) {
    const int64 base = (int64)w * capacity;
    for (int b = atomic_inc(next); b < blocks; b = atomic_inc(next)) {
      const int first = offsets[b], count = offsets[b + 1] - first;
      if (count > capacity || count <= larger) continue;
      block_scratch s = scratch_from(base, capacity, scratch_points, scratch_source, scratch_ranks, scratch_axes);
      const int distinct = order_block(first, count, 0, &s, points, source, representatives);
      rings g = rings_on(edges, points, vertex_edge, bounds);
      g.unused = EDGES_PER_VERTEX * first;
      g.most_ties = most_ties;
      const hull_ends ends = distinct == 0 ? no_ends() : solve_block(&g, first, distinct, s.axes);
      for (int v = first + distinct; v < first + count; ++v) vertex_edge[v] = NO_EDGE;
      free_unused(&g, EDGES_PER_VERTEX * (first + count));
      const solved_block done = {ends, free_list(&g)};
      solved[b] = done;
      distinct_counts[b] = distinct;
      add_to_account(&g, account);
      COUNT_STEPS(g.counted.steps);
    }
  }
}

// The first block of either side of a merge has the side's triangulation.
kernel void merge_blocks(int n, int first_merge, global const block_merge* restrict merges,
                         global const cut_node* restrict nodes, filter_bounds bounds, uint most_ties,
                         global const coordinate2* points, global ring_edge* edges, global int* vertex_edge,
                         global solved_block* solved, global volatile uint* account COUNTERS) {
  const int m = get_global_id(0);
  if (m < n) {
    const block_merge merge = merges[first_merge + m];
    const hull_ends low = solved[merge.low].ends, high = solved[merge.high].ends;
    const int axis = cut_axis(nodes[merge.node]);
    rings g = rings_on(edges, points, vertex_edge, bounds);
    g.most_ties = most_ties;
    join_free_lists(&g, solved[merge.low].unused, solved[merge.high].unused);
    const hull_ends both = joined_ends(&g, low, high, axis);
    if (low.first_x != NO_VERTEX && high.first_x != NO_VERTEX) {
      continue_merge(&g, MERGE_IS_NEW, low, high, both, axis);
    }
    solved[merge.low].ends = both;
    solved[merge.low].unused = free_list(&g);
    add_to_account(&g, account);
    COUNT_STEPS(g.counted.steps);
  }
}
