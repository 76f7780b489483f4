// End game for large regions: the Delaunay triangulation of a region's border vertices by divide and conquer, of
// which the triangles inside the border are the region's.
//
// Border edges are Delaunay edges of the whole set, hence of the region's own vertices. So: large_sizes, gather_large,
// vertex_flags and write_vertices bring each large region's distinct vertices into the order of ids (which is by x).
// merge_strips, one pass a level from the leaves up, a work-item a block of consecutive vertices, is Guibas and Stolfi's
// merge (1985) on edge rings. Of cocircular points it may have chosen other edges than the border's: border_edges looks
// each border edge up, restore_border flips in those that are missing, within their circle's polygon. count_fans
// counts and then writes, a work-item a corner, the triangles in the corner's wedge whose smallest vertex it is.

#include "shared/counting.h"
#include "shared/planar.h"
#include "shared/search.h"

kernel void large_sizes(int n, global const int* restrict large, global const int* restrict offsets,
                        global uint* restrict sizes) {
  const int l = get_global_id(0);
  if (l < n) sizes[l] = offsets[large[l] + 1] - offsets[large[l]];
}

kernel void gather_large(int n, int regions, global const int* restrict large, global const uint* restrict large_offsets,
                         global const int* restrict offsets, global const int* restrict corners,
                         global int* restrict large_corners, global int* restrict corner_region,
                         global ulong* restrict keys, global int* restrict order) {
  const int c = get_global_id(0);
  if (c < n) {
    const int low = segment_of(c, regions, (global const int*)large_offsets);
    const int from = offsets[large[low]] + (c - (int)large_offsets[low]);
    for (int j = 0; j < 3; ++j) large_corners[3 * c + j] = corners[3 * from + j];
    corner_region[c] = low;
    keys[c] = (ulong)low << 32 | (uint)corners[3 * from + 1];
    order[c] = c;
  }
}

kernel void vertex_flags(int n, global const ulong* restrict keys, global uint* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) flags[i] = i == 0 || keys[i] != keys[i - 1];
}

kernel void write_vertices(int n, int regions, global const ulong* restrict keys, global const int* restrict order,
                           global const uint* restrict scanned, global int* restrict vertices,
                           global int* restrict vertex_region, global int* restrict vertex_offsets,
                           global int* restrict corner_vertex) {
  const int i = get_global_id(0);
  if (i < n) {
    const int v = (int)scanned[i + 1] - 1;
    const int l = (int)(keys[i] >> 32);
    corner_vertex[order[i]] = v;
    if (scanned[i + 1] != scanned[i]) {
      vertices[v] = (int)(uint)keys[i];
      vertex_region[v] = l;
    }
    if (i == 0 || (int)(keys[i - 1] >> 32) != l) vertex_offsets[l] = v;
    if (i == n - 1) vertex_offsets[regions] = v + 1;
  }
}

// Edge rings (Guibas and Stolfi's quad-edges without the dual half): directed edge e and its reverse e ^ 1; origin[e] is a
// vertex, or -1 for a free edge; around[e].x is the next edge counter-clockwise about its origin, .y the one before.
// Vertex v brings the edges 6v to 6v + 5 into its block, whose free edges form a list through around[].x.
typedef struct {
  global int* origin;
  global int2* around;
  global const int* vertices;
  global const double2* points;
  double orient_bound;
  double circle_bound;
  int free_head;
  COUNTED(uint orientations; uint circles;)
} rings;

static inline rings rings_on(global int* origin, global int2* around, global const int* vertices,
                             global const double2* points, double orient_bound, double circle_bound) {
  rings g;
  g.origin = origin;
  g.around = around;
  g.vertices = vertices;
  g.points = points;
  g.orient_bound = orient_bound;
  g.circle_bound = circle_bound;
  g.free_head = -1;
  COUNTED(g.orientations = g.circles = 0;)
  return g;
}

static inline int edge_destination(const rings* g, int e) { return g->origin[e ^ 1]; }
static inline int next_left(const rings* g, int e) { return g->around[e ^ 1].y; }
static inline int previous_right(const rings* g, int e) { return g->around[e ^ 1].x; }
static inline double2 place_of(const rings* g, int v) { return g->points[g->vertices[v]]; }

#define COUNT_RINGS(g)                                                                                       \
  COUNTED(COUNT(COMPONENT_ENDGAME, KIND_ORIENTATION, (g).orientations);                                      \
          COUNT(COMPONENT_ENDGAME, KIND_CIRCLE, (g).circles);                                                \
          atomic_max(counters + COUNTER_DEAREST,                                                             \
                     ORIENT_OPERATIONS * (g).orientations + CIRCLE_OPERATIONS * (g).circles);)

static inline int turns_left(rings* g, int a, int b, int c) {
  COUNTED(++g->orientations;)
  const double2 p = place_of(g, a), q = place_of(g, b), r = place_of(g, c);
  const int sign = orient_filtered(p, q, r, g->orient_bound);
  return (sign != UNDECIDED ? sign : orient_exact(p, q, r)) > 0;
}

static inline int in_circle(rings* g, int a, int b, int c, int d) {
  COUNTED(++g->circles;)
  const double2 p = place_of(g, a), q = place_of(g, b), r = place_of(g, c), s = place_of(g, d);
  const int sign = circle_filtered(p, q, r, s, g->circle_bound);
  return (sign != UNDECIDED ? sign : circle_exact(p, q, r, s)) > 0;
}

static inline void splice(rings* g, int a, int b) {
  const int after_a = g->around[a].x;
  const int after_b = g->around[b].x;
  g->around[a].x = after_b;
  g->around[after_b].y = a;
  g->around[b].x = after_a;
  g->around[after_a].y = b;
}

static inline int make_edge(rings* g, int from, int to) {
  const int e = g->free_head;
  g->free_head = g->around[e].x;
  g->origin[e] = from;
  g->origin[e ^ 1] = to;
  g->around[e] = (int2)(e, e);
  g->around[e ^ 1] = (int2)(e ^ 1, e ^ 1);
  return e;
}

// A new edge from a's destination to b's origin, in the left face of both.
static inline int connect(rings* g, int a, int b) {
  const int e = make_edge(g, edge_destination(g, a), g->origin[b]);
  splice(g, e, next_left(g, a));
  splice(g, e ^ 1, b);
  return e;
}

static inline void remove_edge(rings* g, int e) {
  e &= ~1;
  splice(g, e, g->around[e].y);
  splice(g, e ^ 1, g->around[e ^ 1].y);
  g->origin[e] = g->origin[e ^ 1] = -1;
  g->around[e].x = g->free_head;
  g->free_head = e;
}

static inline int left_of(rings* g, int v, int e) { return turns_left(g, v, g->origin[e], edge_destination(g, e)); }
static inline int right_of(rings* g, int v, int e) { return turns_left(g, v, edge_destination(g, e), g->origin[e]); }

// Two or three vertices, in order: an edge or a triangle or a straight pair of edges. Returns the counter-clockwise hull
// edge out of the first vertex and the clockwise one out of the last.
static inline int2 make_leaf(rings* g, int low, int size) {
  const int a = make_edge(g, low, low + 1);
  if (size == 2) return (int2)(a, a ^ 1);
  const int b = make_edge(g, low + 1, low + 2);
  splice(g, a ^ 1, b);
  if (turns_left(g, low, low + 1, low + 2)) {
    connect(g, b, a);
    return (int2)(a, b ^ 1);
  }
  if (turns_left(g, low, low + 2, low + 1)) {
    const int c = connect(g, b, a);
    return (int2)(c ^ 1, c);
  }
  return (int2)(a, b ^ 1);
}

static inline int2 merge_halves(rings* g, int2 left, int2 right) {
  int left_outer = left.x, left_inner = left.y, right_inner = right.x, right_outer = right.y;
  // The lower common tangent.
  for (int moving = 1; moving;) {
    if (left_of(g, g->origin[right_inner], left_inner)) {
      left_inner = next_left(g, left_inner);
    } else if (right_of(g, g->origin[left_inner], right_inner)) {
      right_inner = previous_right(g, right_inner);
    } else {
      moving = 0;
    }
  }
  int base = connect(g, right_inner ^ 1, left_inner);
  if (g->origin[left_inner] == g->origin[left_outer]) left_outer = base ^ 1;
  if (g->origin[right_inner] == g->origin[right_outer]) right_outer = base;
  for (int rising = 1; rising;) {
    const int from = g->origin[base];
    const int to = edge_destination(g, base);
    // Either side's candidate: the next edge that rises above the base, without those that its circle rules out.
    int candidate[2];
    int valid[2];
    for (int side = 0; side < 2; ++side) {
      int e = side ? g->around[base].y : g->around[base ^ 1].x;
      valid[side] = right_of(g, edge_destination(g, e), base);
      for (int dropping = valid[side]; dropping;) {
        const int then = side ? g->around[e].y : g->around[e].x;
        dropping = in_circle(g, to, from, edge_destination(g, e), edge_destination(g, then));
        if (dropping) {
          remove_edge(g, e);
          e = then;
        }
      }
      candidate[side] = e;
    }
    if (!valid[0] && !valid[1]) {
      rising = 0;
    } else if (!valid[0] || (valid[1] && in_circle(g, edge_destination(g, candidate[0]), g->origin[candidate[0]],
                                                   g->origin[candidate[1]], edge_destination(g, candidate[1])))) {
      base = connect(g, candidate[1], base ^ 1);
    } else {
      base = connect(g, base ^ 1, candidate[0] ^ 1);
    }
  }
  return (int2)(left_outer, right_outer);
}

// The block's first vertex, relative to the region's: block j of the 2^depth into which size vertices are cut.
static inline int block_begin(int size, int depth, long j) { return (int)((j * size) >> depth); }

// hull_edges[v], free_lists[v] (head, last): of the block that begins with vertex v.
kernel void merge_strips(int n, int depth, double orient_bound, double circle_bound,
                         global const int* restrict vertices, global const int* restrict vertex_region,
                         global const int* restrict vertex_offsets, global const double2* restrict points,
                         global int* origin, global int2* around, global int2* hull_edges,
                         global int2* free_lists COUNTERS) {
  const int v = get_global_id(0);
  if (v < n) {
    const int region = vertex_region[v];
    const int base = vertex_offsets[region];
    const int count = vertex_offsets[region + 1] - base;
    const int relative = v - base;
    // Is v the first of a block at this depth, and of which?
    const long blocks = 1L << depth;
    const long j = ((long)relative * blocks + count - 1) / count;
    const int begins = j < blocks && block_begin(count, depth, j) == relative;
    const int size = begins ? block_begin(count, depth, j + 1) - relative : 0;
    const int parent = !begins || depth == 0
                           ? INT_MAX
                           : block_begin(count, depth - 1, j / 2 + 1) - block_begin(count, depth - 1, j / 2);
    rings g = rings_on(origin, around, vertices, points, orient_bound, circle_bound);
    if (begins && size >= 2 && size <= 3 && parent > 3) {
      const int first = 6 * v;
      const int last = 6 * (v + size) - 2;
      for (int e = first; e <= last; e += 2) {
        origin[e] = origin[e + 1] = -1;
        around[e].x = e == last ? -1 : e + 2;
      }
      g.free_head = first;
      hull_edges[v] = make_leaf(&g, v, size);
      free_lists[v] = (int2)(g.free_head, last);
    } else if (begins && size > 3) {
      const int middle = base + block_begin(count, depth + 1, 2 * j + 1);
      // The left half's free edges first; its list always has a last one, since a half never needs all.
      const int2 left = free_lists[v];
      const int2 right = free_lists[middle];
      around[left.y].x = right.x;
      g.free_head = left.x;
      hull_edges[v] = merge_halves(&g, hull_edges[v], hull_edges[middle]);
      free_lists[v] = (int2)(g.free_head, right.y);
    }
    COUNT_RINGS(g)
  }
}

// The smallest edge out of each vertex; vertex_edge holds INT_MAX before.
kernel void vertex_edges(int n, global const int* restrict origin, global volatile int* restrict vertex_edge) {
  const int e = get_global_id(0);
  if (e < n && origin[e] >= 0) atomic_min(&vertex_edge[origin[e]], e);
}

// The edge out of vertex v whose destination has the given id, or -1.
static inline int find_edge(global const int* restrict origin, global const int2* restrict around,
                            global const int* restrict vertices, int start, int id) {
  int e = start;
  do {
    if (vertices[origin[e ^ 1]] == id) return e;
    e = around[e].x;
  } while (e != start);
  return -1;
}

kernel void border_edges(int n, global const int* restrict corners, global const int* restrict corner_region,
                         global const int* restrict corner_vertex, global const int* restrict vertices,
                         global const int* restrict vertex_edge, global const int* restrict origin,
                         global const int2* restrict around, global int* restrict border_edge,
                         global volatile int* restrict missing) {
  const int c = get_global_id(0);
  if (c < n) {
    const int e = find_edge(origin, around, vertices, vertex_edge[corner_vertex[c]], corners[3 * c + 2]);
    border_edge[c] = e;
    if (e < 0) atomic_or(&missing[corner_region[c]], 1);
  }
}

// Only a broken border could take so many.
#define STEPS_MOST (1 << 26)

// One work-item a region that misses border edges. From a missing edge's begin, the edges that cross it are
// flipped, each the diagonal of a convex quadrilateral, as all their ends are on one circle. broken[0] gets bit 2 if not.
kernel void restore_border(int n, global const int* restrict missing, global const uint* restrict large_offsets,
                           global const int* restrict corners, global const int* restrict corner_vertex,
                           global const int* restrict vertices, global int* vertex_edge,
                           global const double2* restrict points, double orient_bound, double circle_bound,
                           global int* origin, global int2* around, global int* border_edge,
                           global volatile int* restrict broken COUNTERS) {
  const int l = get_global_id(0);
  if (l < n && missing[l]) {
    rings g = rings_on(origin, around, vertices, points, orient_bound, circle_bound);
    for (int c = large_offsets[l]; c < (int)large_offsets[l + 1]; ++c) {
      if (border_edge[c] >= 0) continue;
      const int m = corner_vertex[c];
      const int id = corners[3 * c + 2];
      const double2 p = points[vertices[m]];
      const double2 target = points[id];
      int e = vertex_edge[m];
      int found = -1;
      int steps = 0;
      while (found < 0) {
        const int f = around[e].x;
        if (vertices[origin[e ^ 1]] == id) {
          found = e;
        } else {
          const double2 q = place_of(&g, origin[e ^ 1]);
          const double2 r = place_of(&g, origin[f ^ 1]);
          COUNTED(g.orientations += 2;)
          const int a = orient_filtered(p, q, target, orient_bound);
          const int b = orient_filtered(p, target, r, orient_bound);
          const int after = (a != UNDECIDED ? a : orient_exact(p, q, target)) > 0;
          const int before = (b != UNDECIDED ? b : orient_exact(p, target, r)) > 0;
          if (after && before && vertices[origin[f ^ 1]] != id) {
            // Flip the edge between q and r (Guibas and Stolfi's swap): it becomes one out of m, between e and f.
            const int crossing = next_left(&g, e);
            for (int end = 0; end < 2; ++end) {
              const int u = origin[crossing ^ end];
              if (vertex_edge[u] == (crossing ^ end)) vertex_edge[u] = around[crossing ^ end].x;
            }
            const int g_a = around[crossing].y;
            const int g_b = around[crossing ^ 1].y;
            splice(&g, crossing, g_a);
            splice(&g, crossing ^ 1, g_b);
            splice(&g, crossing, next_left(&g, g_a));
            splice(&g, crossing ^ 1, next_left(&g, g_b));
            origin[crossing] = edge_destination(&g, g_a);
            origin[crossing ^ 1] = edge_destination(&g, g_b);
          } else {
            e = f;
          }
        }
        if (++steps > STEPS_MOST) {
          atomic_or(broken, 2);
          found = e;
        }
      }
      border_edge[c] = found;
    }
    COUNT_RINGS(g)
  }
}

// The fan of corner c: triangles (m, e's end, next edge's end) from the border edge that leaves to the one that comes
// in. Without `write` into counts[], which are scanned in place.
kernel void count_fans(int n, int write, global const int* restrict corners, global const int* restrict corner_region,
                       global const int* restrict corner_vertex, global const int* restrict vertices,
                       global const int* restrict origin, global const int2* restrict around,
                       global const int* restrict border_edge, global const int* restrict large,
                       global const uint* restrict large_offsets, global const int* restrict offsets,
                       global const uint* scanned, global uint* counts, global int* restrict triangles, global volatile int* restrict broken) {
  const int c = get_global_id(0);
  if (c < n) {
    const int m = corners[3 * c + 1];
    const int before = corners[3 * c];
    const int first = border_edge[c];
    int e = first;
    uint count = 0;
    int to = 0;
    if (write) {
      const int l = corner_region[c];
      to = offsets[large[l]] + (int)(scanned[c] - scanned[large_offsets[l]]);
    }
    while (vertices[origin[e ^ 1]] != before) {
      const int f = around[e].x;
      const int q = vertices[origin[e ^ 1]];
      const int r = vertices[origin[f ^ 1]];
      if (m < q && m < r) {
        if (write) {
          triangles[3 * (to + (int)count)] = m;
          triangles[3 * (to + (int)count) + 1] = q;
          triangles[3 * (to + (int)count) + 2] = r;
        }
        ++count;
      }
      e = f;
      if (e == first) {
        atomic_or(broken, 2);
        break;
      }
    }
    if (!write) counts[c] = count;
  }
}

kernel void large_counts(int n, global const int* restrict large, global const uint* restrict large_offsets,
                         global const uint* restrict scanned, global uint* restrict counts) {
  const int l = get_global_id(0);
  if (l < n) counts[large[l]] = scanned[large_offsets[l + 1]] - scanned[large_offsets[l]];
}
