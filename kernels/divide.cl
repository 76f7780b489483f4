// Dwyer's divide and conquer (Algorithmica 2, 1987) on blocks of points, and the merges of blocks.
//
// solve_blocks: work-items take one block after the other. Each sorts a block's points along x and along y, drops
// duplicates, cuts the block in halves down to leaves of one to four vertices, across the longer interquartile range, and
// merges from the leaves up (shared/rings.h). Vertices are numbered in the order of the leaves, so what a merge touches
// lies together. merge_blocks, one launch a level of the trees from the leaves up, a work-item a node, merges the two
// triangulations on either side of the node's cut.

#include "shared/cut_tree.h"
#include "shared/rings.h"

// Where a point stands in either order.
typedef int2 ranks;
#define MOST_DEPTH 32

// A work-item's own arrays, with room for one block.
typedef struct {
  global double2* points;  // distinct, by x
  global int* source;
  global ranks* by_x;
  global ranks* by_y;
  global ranks* spare;
  global uchar* axes;  // by node
} block_scratch;

// Brings a block's distinct points, in the order of x, into scratch and returns their number.
static inline int distinct_by_x(int count, global const double2* points, global const int* source,
                                const block_scratch* s, global int* representatives) {
  global keyed* elements = (global keyed*)s->by_x;
  for (int i = 0; i < count; ++i) elements[i] = (keyed)(0, i);
  elements = sort_along(elements, (global keyed*)s->by_y, count, points, 0);
  int distinct = 0;
  double2 last = (double2)(0.0, 0.0);
  for (int i = 0; i < count; ++i) {
    const int from = elements[i].y;
    const double2 p = points[from];
    if (distinct > 0 && p.x == last.x && p.y == last.y) {
      representatives[source[from]] = s->source[distinct - 1];
    } else {
      s->points[distinct] = last = p;
      s->source[distinct++] = source[from];
    }
  }
  return distinct;
}

static inline void rank(int count, block_scratch* s) {
  global keyed* elements = (global keyed*)s->by_y;
  // Of equal y, the larger x comes first.
  for (int i = 0; i < count; ++i) elements[i] = (keyed)(0, count - 1 - i);
  elements = sort_along(elements, (global keyed*)s->spare, count, s->points, 1);
  if (elements != (global keyed*)s->by_y) {
    s->spare = s->by_y;
    s->by_y = (global ranks*)elements;
  }
  for (int r = 0; r < count; ++r) {
    const ranks both = (ranks)((int)elements[r].y, r);
    s->by_y[r] = both;
    s->by_x[both.x] = both;
  }
}

// Block j of the 2^depth into which count vertices are cut begins there.
static inline int part_begin(int count, int depth, int j) { return (int)(((long)j * count) >> depth); }

// 1 if the part is longer in y, by its interquartile ranges.
static inline int axis_of(int begin, int end, const block_scratch* s) {
  const int low = begin + (end - begin) / 4, high = end - 1 - (end - begin) / 4;
  const double width = s->points[s->by_x[high].x].x - s->points[s->by_x[low].x].x;
  const double height = s->points[s->by_y[high].x].y - s->points[s->by_y[low].x].y;
  return height > width;
}

// The order along the axis falls apart by position, the other one by a stable split.
static inline int cut_part(int begin, int middle, int end, const block_scratch* s) {
  const int axis = axis_of(begin, end, s);
  global ranks* const order = axis ? s->by_x : s->by_y;
  const int threshold = axis ? s->by_y[middle].y : s->by_x[middle].x;
  int low = begin, high = 0;
  for (int i = begin; i < end; ++i) {
    const ranks both = order[i];
    const int is_low = (axis ? both.y : both.x) < threshold;
    order[low] = both;  // low <= i
    s->spare[high] = both;
    low += is_low;
    high += !is_low;
  }
  for (int i = 0; i < high; ++i) order[low + i] = s->spare[i];
  return axis;
}

// The leaves' vertices, and the ends of the whole.
static inline ends solve_block(rings* g, int first, int count, const block_scratch* s, global double2* points,
                               global int* source) {
  int depth = 0;
  while (count > LEAF_VERTICES << depth) ++depth;
  for (int d = 0; d < depth; ++d) {
    for (int j = 0; j < 1 << d; ++j) {
      s->axes[(1 << d) + j] =
          cut_part(part_begin(count, d, j), part_begin(count, d + 1, 2 * j + 1), part_begin(count, d, j + 1), s);
    }
  }
  for (int k = 0; k < count; ++k) {
    const int r = s->by_x[k].x;
    points[first + k] = s->points[r];
    source[first + k] = s->source[r];
  }
  // Depth first: after leaf i, as many merges as its number has trailing ones.
  ends stack[MOST_DEPTH];
  int height = 0;
  for (int i = 0; i < 1 << depth; ++i) {
    const int begin = part_begin(count, depth, i);
    ends whole = make_leaf(g, first + begin, part_begin(count, depth, i + 1) - begin);
    for (int node = ((1 << depth) + i); node & 1 && node > 1; node >>= 1) {
      const int axis = s->axes[node >> 1];
      const ends low = stack[--height];
      merge_triangulations(g, last_along(low, axis), first_along(whole, axis));
      whole = joined_ends(g, low, whole, axis);
    }
    stack[height++] = whole;
  }
  return stack[0];
}

// Solves the blocks of more than `larger` and at most `capacity` points, which is what each work-item's part of the
// scratch arrays has room for. next: 0 at first.
kernel void solve_blocks(int workers, int blocks, int capacity, int larger, global const int* restrict offsets,
                         double orient_bound, double circle_bound, global volatile int* next, global double2* points,
                         global int* source, global int* representatives, global ring_edge* edges,
                         global int* vertex_edge, global int4* block_ends, global int2* free_lists,
                         global int* distinct_counts, global volatile uint* undecided,
                         global double2* scratch_points, global int* scratch_source, global int2* scratch_ranks,
                         global uchar* scratch_axes) {
  const int w = get_global_id(0);
  if (w < workers) {
    const long base = (long)w * capacity;
    for (int b = atomic_inc(next); b < blocks; b = atomic_inc(next)) {
      const int first = offsets[b], count = offsets[b + 1] - first;
      if (count > capacity || count <= larger) continue;
      block_scratch s;
      s.points = scratch_points + base;
      s.source = scratch_source + base;
      s.by_x = scratch_ranks + 3 * base;
      s.by_y = s.by_x + capacity;
      s.spare = s.by_y + capacity;
      s.axes = scratch_axes + base;
      const int distinct = distinct_by_x(count, points + first, source + first, &s, representatives);
      rank(distinct, &s);
      rings g = rings_on(edges, points, vertex_edge, orient_bound, circle_bound);
      g.unused = EDGES_PER_VERTEX * first;
      block_ends[b] = distinct == 0 ? (ends)(NO_VERTEX) : solve_block(&g, first, distinct, &s, points, source);
      for (int v = first + distinct; v < first + count; ++v) vertex_edge[v] = NO_EDGE;
      free_unused(&g, EDGES_PER_VERTEX * (first + count));
      free_lists[b] = free_list(&g);
      distinct_counts[b] = distinct;
      if (g.undecided > 0) atomic_add(undecided, g.undecided);
    }
  }
}

// A merge: the first blocks of either side, which have the sides' ends and free edges; the node that cuts between them.
kernel void merge_blocks(int n, int first_merge, global const int4* restrict merges,
                         global const cut_node* restrict nodes, double orient_bound, double circle_bound,
                         global const double2* points, global ring_edge* edges, global int* vertex_edge,
                         global int4* block_ends, global int2* free_lists, global volatile uint* undecided) {
  const int m = get_global_id(0);
  if (m < n) {
    const int4 merge = merges[first_merge + m];
    const ends low = block_ends[merge.x], high = block_ends[merge.y];
    const int axis = cut_axis(nodes[merge.z]);
    rings g = rings_on(edges, points, vertex_edge, orient_bound, circle_bound);
    join_free_lists(&g, free_lists[merge.x], free_lists[merge.y]);
    if (low.x != NO_VERTEX && high.x != NO_VERTEX) {
      merge_triangulations(&g, last_along(low, axis), first_along(high, axis));
    }
    block_ends[merge.x] = joined_ends(&g, low, high, axis);
    free_lists[merge.x] = free_list(&g);
    if (g.undecided > 0) atomic_add(undecided, g.undecided);
  }
}
