// Edge rings (mesh/rings.h) to triangles, neighbours and hulls.
//
// A triangle belongs to its middle vertex along x. A vertex is the middle one of two triangles, the one right below it
// and the one right above; on the lower hull it has only the one above, on the upper hull only the one below, and the
// ends of the hull have none. So rows are counted without looking at the triangles. vertex_triangles counts them in one
// pass over the vertices. mark_outside, with one work-item per set, walks the hull, marks the edges whose left side is
// outside and subtracts the rows that hull vertices do not have. After a scan, write_triangles, write_neighbors and
// write_halfedges are one pass each over pairs of edges. write_hulls walks the hulls again.
//
// Rings are not walked clockwise any more. write_triangles puts in the place of an edge's `previous` the place of the
// corner opposite of it, in the triangle on its left, for the passes behind it: there it is in a cache line that they
// need anyway, and takes no memory of its own.

#include "blocks/rows.h"
#include "mesh/halfedges.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "operations/prefetch.h"

kernel void vertex_triangles(int n, global const int* restrict vertex_edge, global uint* restrict counts) {
  const int v = get_global_id(0);
  // NO_EDGE, or HIDDEN_VERTEX of mesh/power_rings.h.
  if (v < n) counts[v] = vertex_edge[v] < 0 ? 0 : 2;
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
static inline int owns(coordinate2 v, int right, int to, int next, global const ring_edge* edges,
                       global const coordinate2* points) {
  const int other = is_outside(next) ? to : edges[next].to;
  return !is_outside(next) & (precedes(v, points[other], 0) != right);
}

// Writes the triangle left of edge e, which belongs to the edge's origin v; first_row: of v's rows, closed by the next
// vertex'. The row starts with the smallest index. With corners, each of its edges gets the place of the corner
// opposite of it. Other work-items do so meanwhile; their writes are not read here.
static inline void write_triangle(int e, int right, int with_corners, global const coordinate2* points,
                                  global const int* source, global ring_edge* edges, global const uint* first_rows,
                                  global int* triangles) {
  const int from_b = edges[e].next ^ 1;
  const int v = edges[e ^ 1].to, a = edges[e].to, b = edges[from_b ^ 1].to;
  const uint first = first_rows[v];
  const int is_second = (first_rows[v + 1] - first == 2) & right;
  const int row = 3 * (int)(first + is_second);
  const int at_v = source[v], at_a = source[a], at_b = source[b];
  const row_places to = places_in_row(at_v, at_a, at_b);
  triangles[row + to.v] = at_v;
  triangles[row + to.a] = at_a;
  triangles[row + to.b] = at_b;
  if (with_corners) {
    edges[e].previous = row + to.b;
    edges[edges[from_b].next ^ 1].previous = row + to.v;
    edges[from_b].previous = row + to.a;
  }
}

// Beside the number of an edge: its destination comes behind its origin along x.
#define GOES_RIGHT INT_MIN

// Pairs of edges that are tested before the triangles found among them are written.
#define PAIRS_AT_ONCE 64

// Edges and points are fetched ahead in the order of memory: edges lead anywhere within a block.
#define PAIRS_A_CACHE_LINE 2
#define POINTS_A_CACHE_LINE 4
static inline void fetch_ahead(int pair, int last, global const ring_edge* edges, global const coordinate2* points) {
#if FETCH_AHEAD
  const int begin = pair + FETCH_AHEAD, end = min(last, begin + PAIRS_AT_ONCE);
  for (int k = begin; k < end; k += PAIRS_A_CACHE_LINE) fetch(&edges[2 * k]);
  for (int v = begin / PAIRS_PER_VERTEX; v < end / PAIRS_PER_VERTEX; v += POINTS_A_CACHE_LINE) fetch(&points[v]);
#endif
}

// n pairs of edges.
kernel void write_triangles(int n, int chunk, int with_corners, global const coordinate2* restrict points,
                            global const int* restrict source, global ring_edge* edges,
                            global const uint* restrict first_rows, global int* restrict triangles) {
  const int c = get_global_id(0);
  if ((int64)c * chunk < n) {
    const int last = (int)min((int64)n, ((int64)c + 1) * chunk);
    for (int begin = c * chunk; begin < last; begin += PAIRS_AT_ONCE) {
      fetch_ahead(begin, last, edges, points);
      int owned[2 * PAIRS_AT_ONCE + 1];
      int count = 0;
      for (int k = begin; k < min(last, begin + PAIRS_AT_ONCE); ++k) {
        const int a = edges[2 * k + 1].to, b = edges[2 * k].to;
        if (b == NO_VERTEX) continue;
        const coordinate2 from = points[a], to = points[b];
        const int right = precedes(from, to, 0);
        owned[count] = 2 * k | (right ? GOES_RIGHT : 0);
        count += owns(from, right, b, edges[2 * k].next, edges, points);
        owned[count] = (2 * k + 1) | (right ? 0 : GOES_RIGHT);
        count += owns(to, !right, a, edges[2 * k + 1].next, edges, points);
      }
      for (int k = 0; k < count; ++k) {
        write_triangle(owned[k] & ~GOES_RIGHT, owned[k] < 0, with_corners, points, source, edges, first_rows,
                       triangles);
      }
    }
  }
}

// The places of the corners opposite of a pair of edges, which have triangles on their left, or of one of them. An edge
// without one has NO_CORNER, and so has a free edge.
#define NO_CORNER -1
typedef struct {
  int left, right;
} corner_pair;
static inline corner_pair corners_of_pair(int k, global const ring_edge* edges) {
  const ring_edge there = edges[2 * k], back = edges[2 * k + 1];
  const int is_free = there.to == NO_VERTEX;
  const corner_pair corners = {is_free || is_outside(there.next) ? NO_CORNER : there.previous,
                               is_free || is_outside(back.next) ? NO_CORNER : back.previous};
  return corners;
}

// n pairs of edges.
kernel void write_neighbors(int n, global const ring_edge* restrict edges, global int* restrict neighbors) {
  const int k = get_global_id(0);
  if (k < n) {
    const corner_pair of = corners_of_pair(k, edges);
    if (of.left != NO_CORNER) neighbors[of.left] = of.right == NO_CORNER ? -1 : of.right / 3;
    if (of.right != NO_CORNER) neighbors[of.right] = of.left == NO_CORNER ? -1 : of.left / 3;
  }
}

// n pairs of edges.
kernel void write_halfedges(int n, global const ring_edge* restrict edges, global int* restrict halfedges) {
  const int k = get_global_id(0);
  if (k < n) {
    const corner_pair of = corners_of_pair(k, edges);
    const int from_left = of.left == NO_CORNER ? -1 : opposite_halfedge(of.left);
    const int from_right = of.right == NO_CORNER ? -1 : opposite_halfedge(of.right);
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
