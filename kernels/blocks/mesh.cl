// Edge rings (mesh/rings.h) to triangles, neighbours and hulls.
//
// A triangle belongs to its middle vertex along x. A vertex is the middle one of two triangles, the one right below it
// and the one right above; on the lower hull it has only the one above, on the upper hull only the one below, and the
// ends of the hull have none. So rows are counted without looking at the triangles. vertex_triangles counts them in one
// pass over the vertices. mark_outside, with one work-item per set, walks the hull, marks the edges whose left side is
// outside and subtracts the rows that hull vertices do not have. After a scan, write_triangles, write_neighbors and
// write_halfedges are one pass each over pairs of edges. write_hulls walks the hulls again.

#include "blocks/rows.h"
#include "mesh/halfedges.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "operations/prefetch.h"

kernel void vertex_triangles(int n, global const int* restrict vertex_edge, global uint* restrict counts) {
  const int v = get_global_id(0);
  if (v < n) counts[v] = vertex_edge[v] == NO_EDGE ? 0 : 2;
}

// An edge with the outside on its left has the complement of the next edge.
static inline int is_outside(int next) { return next < 0; }

kernel void mark_outside(int n, global const int* restrict set_blocks, global const solved_block* restrict solved,
                         global const int* restrict vertex_edge, global ring_edge* edges, global uint* restrict counts,
                         global int* restrict hull_sizes COUNTERS) {
  const int s = get_global_id(0);
  if (s < n) {
    int size = 0;
    const hull_ends corners = set_blocks[s] < set_blocks[s + 1] ? solved[set_blocks[s]].ends : no_ends();
    const int start = corners.first_x == NO_VERTEX ? NO_EDGE : vertex_edge[corners.first_x];
    if (start != NO_EDGE) {
      int e = start;
      do {
        const int then = edges[e ^ 1].next;
        edges[e ^ 1].next = ~then;
        // Points on one line are walked there and back.
        --counts[edges[e].to];
        ++size;
        e = then;
      } while (e != start);
      counts[corners.first_x] = counts[corners.last_x] = 0;
    }
    hull_sizes[s] = size;
    COUNT_STEPS(size);
  }
}

// Whether the triangle left of edge e, which leaves v and goes right or not, belongs to v. Without branches, since they
// could not be predicted.
static inline int owns(coordinate2 v, int right, ring_edge e, global const ring_edge* edges,
                       global const coordinate2* points) {
  const int other = is_outside(e.next) ? e.to : edges[e.next].to;
  return !is_outside(e.next) & (precedes(v, points[other], 0) != right);
}

// Writes the triangle left of edge e, which belongs to the edge's origin v; first_row: of v's rows, closed by the next
// vertex'. The row starts with the smallest index. corner_of_edge, if there is one, gets the place of the corner
// opposite of each edge.
static inline void write_triangle(int e, int with_corners, global const coordinate2* points, global const int* source,
                                  global const ring_edge* edges, global const uint* first_rows, global int* triangles,
                                  global int* corner_of_edge) {
  const ring_edge there = edges[e], back = edges[e ^ 1];
  const int v = back.to, a = there.to, b = edges[there.next].to;
  const uint first = first_rows[v];
  const int is_second = (first_rows[v + 1] - first == 2) & precedes(points[v], points[a], 0);
  const int row = 3 * (int)(first + is_second);
  const int at_v = source[v], at_a = source[a], at_b = source[b];
  const row_places to = places_in_row(at_v, at_a, at_b);
  triangles[row + to.v] = at_v;
  triangles[row + to.a] = at_a;
  triangles[row + to.b] = at_b;
  if (with_corners) {
    corner_of_edge[e] = row + to.b;
    corner_of_edge[back.previous] = row + to.v;
    corner_of_edge[there.next ^ 1] = row + to.a;
  }
}

// Pairs of edges that are tested before the triangles found among them are written.
#define PAIRS_AT_ONCE 64

// What will be needed is fetched in the order of memory: edges lead anywhere within a block.
#define PAIRS_A_CACHE_LINE 2
#define POINTS_A_CACHE_LINE 4
static inline void fetch_ahead(int pair, int last, global const ring_edge* edges, global const coordinate2* points) {
#if FETCH_AHEAD
  const int begin = pair + FETCH_AHEAD, end = min(last, begin + PAIRS_AT_ONCE);
  for (int k = begin; k < end; k += PAIRS_A_CACHE_LINE) fetch(&edges[2 * k]);
  for (int v = begin / PAIRS_PER_VERTEX; v < end / PAIRS_PER_VERTEX; v += POINTS_A_CACHE_LINE) fetch(&points[v]);
#endif
}

// An edge without a triangle on its left has no corner.
#define NO_CORNER -1

// n pairs of edges.
kernel void write_triangles(int n, int chunk, int with_corners, global const coordinate2* restrict points,
                            global const int* restrict source, global const ring_edge* restrict edges,
                            global const uint* restrict first_rows, global int* restrict triangles,
                            global int* restrict corner_of_edge) {
  const int c = get_global_id(0);
  if ((long)c * chunk < n) {
    const int last = (int)min((long)n, (c + 1L) * chunk);
    for (int begin = c * chunk; begin < last; begin += PAIRS_AT_ONCE) {
      fetch_ahead(begin, last, edges, points);
      int owned[2 * PAIRS_AT_ONCE + 1];
      int count = 0;
      for (int k = begin; k < min(last, begin + PAIRS_AT_ONCE); ++k) {
        const ring_edge there = edges[2 * k], back = edges[2 * k + 1];
        if (with_corners && (there.to == NO_VERTEX || is_outside(there.next))) corner_of_edge[2 * k] = NO_CORNER;
        if (with_corners && (there.to == NO_VERTEX || is_outside(back.next))) corner_of_edge[2 * k + 1] = NO_CORNER;
        if (there.to == NO_VERTEX) continue;
        const coordinate2 from = points[back.to], to = points[there.to];
        const int right = precedes(from, to, 0);
        owned[count] = 2 * k;
        count += owns(from, right, there, edges, points);
        owned[count] = 2 * k + 1;
        count += owns(to, !right, back, edges, points);
      }
      for (int k = 0; k < count; ++k) {
        write_triangle(owned[k], with_corners, points, source, edges, first_rows, triangles, corner_of_edge);
      }
    }
  }
}

// n pairs of edges.
kernel void write_neighbors(int n, global const int* restrict corner_of_edge, global int* restrict neighbors) {
  const int k = get_global_id(0);
  if (k < n) {
    fetch(&corner_of_edge[2 * min(n - 1, k + STREAM_AHEAD)]);
    const int left = corner_of_edge[2 * k], right = corner_of_edge[2 * k + 1];
    if (left != NO_CORNER) neighbors[left] = right == NO_CORNER ? -1 : right / 3;
    if (right != NO_CORNER) neighbors[right] = left == NO_CORNER ? -1 : left / 3;
  }
}

// n pairs of edges.
kernel void write_halfedges(int n, global const int* restrict corner_of_edge, global int* restrict halfedges) {
  const int k = get_global_id(0);
  if (k < n) {
    fetch(&corner_of_edge[2 * min(n - 1, k + STREAM_AHEAD)]);
    const int left = corner_of_edge[2 * k], right = corner_of_edge[2 * k + 1];
    const int from_left = left == NO_CORNER ? -1 : opposite_halfedge(left);
    const int from_right = right == NO_CORNER ? -1 : opposite_halfedge(right);
    if (from_left >= 0) halfedges[from_left] = from_right;
    if (from_right >= 0) halfedges[from_right] = from_left;
  }
}

// The hull's vertices from the first along x on; of a set without triangles its vertices in the order of x.
kernel void write_hulls(int n, global const int* restrict set_blocks, global const solved_block* restrict solved,
                        global const int* restrict vertex_edge, global const ring_edge* restrict edges,
                        global const int* restrict source, global const int* restrict offsets,
                        global int* restrict hull COUNTERS) {
  const int s = get_global_id(0);
  if (s < n && offsets[s] < offsets[s + 1]) {
    const int v = solved[set_blocks[s]].ends.first_x;
    int e = vertex_edge[v];
    hull[offsets[s]] = source[v];
    for (int k = offsets[s] + 1; k < offsets[s + 1]; ++k) {
      hull[k] = source[edges[e].to];
      e = ~edges[e ^ 1].next;
    }
    COUNT_STEPS(offsets[s + 1] - offsets[s]);
  }
}
