// End game for large regions: the Delaunay triangulation of a region's border vertices by divide and conquer. The
// triangles inside the border are the region's.
//
// This is correct because border edges are Delaunay edges of the whole set, hence of the region's own vertices.
//
// 1. large_sizes, gather_large, vertex_flags and write_vertices bring each large region's distinct vertices into the
//    order of ids, which is by x: one pass each.
// 2. merge_strips merges the two halves of each block of consecutive vertices (mesh/rings.h): one pass per level from
//    the leaves up, with one work-item per vertex. The first one of a block works.
// 3. Between cocircular points the merges may have chosen other edges than the border's. border_edges looks
//    each border edge up, and restore_border flips in the missing ones, within the polygon of their circle.
// 4. count_fans counts, and in a second launch writes, the triangles in each corner's wedge whose smallest vertex is
//    the corner's, with one work-item per corner.

// Borders are not canonical, and a merge of two canonical triangulations of one circle's points would change every
// edge.
#define RINGS_TIE(a, b, c, d, bounds) 0
#include "flattened/arguments.h"
#include "flattened/codes.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "operations/search.h"
#include "predicates/records.h"

kernel void large_sizes(int n, global const int* restrict large, global const int* restrict offsets,
                        global uint* restrict sizes) {
  const int l = get_global_id(0);
  if (l < n) sizes[l] = offsets[large[l] + 1] - offsets[large[l]];
}

kernel void gather_large(int n, int regions, global const int* restrict large,
                         global const uint* restrict large_offsets, global const int* restrict offsets,
                         global const int* restrict corners, global int* restrict large_corners,
                         global int* restrict corner_region, global uint64* restrict keys, global int* restrict order) {
  const int c = get_global_id(0);
  if (c < n) {
    const int low = segment_of(c, regions, (global const int*)large_offsets);
    const int from = offsets[large[low]] + (c - (int)large_offsets[low]);
    for (int j = 0; j < 3; ++j) large_corners[3 * c + j] = corners[3 * from + j];
    corner_region[c] = low;
    keys[c] = (uint64)low << 32 | (uint)corners[3 * from + 1];
    order[c] = c;
  }
}

kernel void vertex_flags(int n, global const uint64* restrict keys, global uint* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) flags[i] = i == 0 || keys[i] != keys[i - 1];
}

kernel void write_vertices(int n, int regions, global const uint64* restrict keys, global const int* restrict order,
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

// The block's first vertex, relative to the region's: block j of the 2^depth into which size vertices are cut.
static inline int block_begin(int size, int depth, int64 j) { return (int)((j * size) >> depth); }

// places: the vertices' coordinates, written at the leaves. free_lists[v]: of the block that begins with vertex v.
kernel void merge_strips(int n, int depth, filter_bounds bounds, global const int* restrict vertices,
                         global const int* restrict vertex_region, global const int* restrict vertex_offsets,
                         global const double2* restrict points, global double2* places, global ring_edge* edges,
                         global int* vertex_edge, global free_edges* free_lists COUNTERS) {
  const int v = get_global_id(0);
  if (v < n) {
    const int region = vertex_region[v];
    const int base = vertex_offsets[region];
    const int count = vertex_offsets[region + 1] - base;
    const int relative = v - base;
    // Finds whether v is the first vertex of a block at this depth, and the block.
    const int64 blocks = (int64)1 << depth;
    const int64 j = ((int64)relative * blocks + count - 1) / count;
    const int begins = j < blocks && block_begin(count, depth, j) == relative;
    const int size = begins ? block_begin(count, depth, j + 1) - relative : 0;
    const int parent = !begins || depth == 0
                           ? INT_MAX
                           : block_begin(count, depth - 1, j / 2 + 1) - block_begin(count, depth - 1, j / 2);
    rings g = rings_on(edges, places, vertex_edge, bounds);
    if (size > LEAF_VERTICES) {
      const int middle = base + block_begin(count, depth + 1, 2 * j + 1);
      join_free_lists(&g, free_lists[v], free_lists[middle]);
      merge_in_order(&g, middle - 1);
      free_lists[v] = free_list(&g);
    } else if (size > 0 && parent > LEAF_VERTICES) {
      for (int w = v; w < v + size; ++w) places[w] = points[vertices[w]];
      g.unused = EDGES_PER_VERTEX * v;
      make_leaf(&g, v, size);
      free_unused(&g, EDGES_PER_VERTEX * (v + size));
      free_lists[v] = free_list(&g);
    }
    COUNT_TALLY(ENDGAME, g);
  }
}

// The edge out of vertex v whose destination has the given id, or -1.
static inline int find_edge(global const ring_edge* restrict edges, global const int* restrict vertices, int start,
                            int id) {
  int e = start;
  do {
    if (vertices[edges[e].to] == id) return e;
    e = edges[e].next;
  } while (e != start);
  return -1;
}

kernel void border_edges(int n, STRIP_CORNERS(), global const int* restrict vertex_edge,
                         global const ring_edge* restrict edges, global int* restrict border_edge,
                         global volatile int* restrict missing) {
  const int c = get_global_id(0);
  if (c < n) {
    const int e = find_edge(edges, vertices, vertex_edge[corner_vertex[c]], corners[3 * c + 2]);
    border_edge[c] = e;
    if (e < 0) atomic_or(&missing[corner_region[c]], 1);
  }
}

// More steps than any border takes that is not broken.
#define STEPS_MOST (1 << 26)

// Edges e and f follow each other about vertex m; the edge between their ends becomes one out of m, between e and f.
static inline void flip(rings* g, int m, int e, int f) {
  global const ring_edge* edges = g->edges;
  const int crossing = edges[e ^ 1].previous;
  const int beyond = edges[crossing].previous;
  const int opposite = edges[beyond].to;
  take_out(g, crossing, edges[e].to);
  take_out(g, crossing ^ 1, edges[f].to);
  put_edge(g, crossing, m, crossing, crossing);
  put_edge(g, crossing ^ 1, opposite, crossing ^ 1, crossing ^ 1);
  insert_before(g, crossing, beyond ^ 1);
  insert_after(g, crossing ^ 1, e);
}

// One work-item per large region; those that miss border edges work. Around the origin of a missing edge, the edges
// that cross it are flipped. Each is the diagonal of a convex quadrilateral, since all their ends are on one circle;
// broken[0] gets BROKEN_BORDER if that does not hold.
kernel void restore_border(int n, global const int* restrict missing, global const uint* restrict large_offsets,
                           STRIP_CORNERS(), global const double2* restrict places,
                           global const double2* restrict points, filter_bounds bounds, global ring_edge* edges,
                           global int* vertex_edge, global int* border_edge,
                           global volatile int* restrict broken COUNTERS) {
  const int l = get_global_id(0);
  if (l < n && missing[l]) {
    rings g = rings_on(edges, places, vertex_edge, bounds);
    for (int c = large_offsets[l]; c < (int)large_offsets[l + 1]; ++c) {
      if (border_edge[c] >= 0) continue;
      const int m = corner_vertex[c];
      const int id = corners[3 * c + 2];
      const double2 p = places[m];
      const double2 target = points[id];
      int e = vertex_edge[m];
      for (int steps = 0; vertices[edges[e].to] != id; ++steps) {
        if (steps > STEPS_MOST) {
          atomic_or(broken, BROKEN_BORDER);
          break;
        }
        const int f = edges[e].next;
        const int q = edges[e].to, r = edges[f].to;
        if (vertices[r] != id && turns_left(&g, p, places[q], target) && turns_left(&g, p, target, places[r])) {
          flip(&g, m, e, f);
        } else {
          e = f;
        }
      }
      border_edge[c] = e;
    }
    COUNT_TALLY(ENDGAME, g);
  }
}

// The fan of corner c: triangles (m, e's end, next edge's end) from the border edge that leaves to the one that comes
// in. Without `write` into counts[], which are scanned in place.
kernel void count_fans(int n, int write, STRIP_CORNERS(), global const ring_edge* restrict edges,
                       global const int* restrict border_edge, global const int* restrict large,
                       global const uint* restrict large_offsets, global const int* restrict offsets,
                       global const uint* scanned, global uint* counts, global int* restrict triangles,
                       global volatile int* restrict broken) {
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
    while (vertices[edges[e].to] != before) {
      const int f = edges[e].next;
      const int q = vertices[edges[e].to];
      const int r = vertices[edges[f].to];
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
        atomic_or(broken, BROKEN_BORDER);
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
