// Regions that are small enough for the solver of blocks: their points as blocks, and the triangles of the
// blocks that lie inside of the regions' borders.
//
// 1. region_offsets, place_points and place_corners make a block of each region: its internal points, and behind them
//    the vertices of its corners. A vertex with several corners is there several times; the solver drops equal points.
// 2. The solver triangulates the blocks. name_vertices names the rings' vertices by ids, and tells where they are;
//    corner_vertices finds the vertex of each corner. (strips.cl has the two passes that follow: border_edges finds the
//    edges of the borders, and restore_border flips in those that ties have kept out.)
// 3. The face left of an edge at a border's vertex is inside if and only if it is in the wedge of a corner
//    there. close_vertices marks all edges out of such vertices as having the outside on their left, by the
//    complement of the next edge; open_wedges takes the marks from the edges in wedges and counts the rows of
//    these vertices as blocks/mesh.cl does, each triangle at its middle vertex.
//
// Each kernel is one pass, with one work-item per region, point, corner or vertex.

#include "flattened/codes.h"
#include "mesh/records.h"
#include "mesh/rings.h"

kernel void region_offsets(int n, global const int* restrict point_offsets, global const int* restrict corner_offsets,
                           global int* restrict offsets) {
  const int r = get_global_id(0);
  if (r < n) offsets[r] = point_offsets[r] + corner_offsets[r];
}

// places: of internal points and, behind them, of corners; ids: of points by place; owners: their own places,
// later the place of the first of equal points.
static inline void put_point(int place, int id, global const double2* points, global double2* vertices,
                             global int* source, global int* owners, global int* ids) {
  vertices[place] = points[id];
  source[place] = place;
  owners[place] = place;
  ids[place] = id;
}

kernel void place_points(int n, global const int* restrict list, global const int* restrict regions,
                         global const int* restrict corner_offsets, global const double2* restrict points,
                         global double2* restrict vertices, global int* restrict source, global int* restrict owners,
                         global int* restrict ids) {
  const int i = get_global_id(0);
  if (i < n) put_point(i + corner_offsets[regions[i]], list[i], points, vertices, source, owners, ids);
}

kernel void place_corners(int n, global const int* restrict corners, global const int* restrict regions,
                          global const int* restrict point_offsets, global const double2* restrict points,
                          global double2* restrict vertices, global int* restrict source, global int* restrict owners,
                          global int* restrict ids) {
  const int c = get_global_id(0);
  if (c < n) {
    put_point(c + point_offsets[regions[c] + 1], corners[3 * c + 1], points, vertices, source, owners, ids);
  }
}

// source: the places of the solver's vertices; becomes their ids. vertex_of: by place. counts: the rows of
// internal points; rows of border vertices are counted later.
kernel void name_vertices(int n, global const int* restrict vertex_edge, global const int* restrict ids,
                          global const uchar* restrict side, global int* restrict source,
                          global int* restrict vertex_of, global uint* restrict counts) {
  const int v = get_global_id(0);
  if (v < n) {
    uint count = 0;
    if (vertex_edge[v] != NO_EDGE) {
      const int place = source[v];
      const int id = ids[place];
      source[v] = id;
      vertex_of[place] = v;
      count = side[id] == SIDE_BORDER ? 0 : 2;
    }
    counts[v] = count;
  }
}

kernel void corner_vertices(int n, global const int* restrict regions, global const int* restrict point_offsets,
                            global const int* restrict owners, global const int* restrict vertex_of,
                            global int* restrict corner_vertex) {
  const int c = get_global_id(0);
  if (c < n) corner_vertex[c] = vertex_of[owners[c + point_offsets[regions[c] + 1]]];
}

// The first of several corners at one vertex works.
kernel void close_vertices(int n, global const int* restrict regions, global const int* restrict point_offsets,
                           global const int* restrict owners, global const int* restrict corner_vertex,
                           global const int* restrict vertex_edge, global ring_edge* restrict edges) {
  const int c = get_global_id(0);
  if (c < n) {
    const int place = c + point_offsets[regions[c] + 1];
    if (owners[place] == place) {
      const int first = vertex_edge[corner_vertex[c]];
      int e = first;
      do {
        const int then = edges[e].next;
        edges[e].next = ~then;
        e = then;
      } while (e != first);
    }
  }
}

// A wedge runs counter-clockwise from the edge to `after` to the edge to `before`, and all around if both are one.
// broken[0] gets BROKEN_BORDER if the wedge does not end.
kernel void open_wedges(int n, global const int* restrict corners, global const int* restrict corner_vertex,
                        global const int* restrict border_edge, global const int* restrict ids,
                        global const double2* restrict points, global ring_edge* edges, global volatile uint* counts,
                        global volatile int* restrict broken) {
  const int c = get_global_id(0);
  if (c < n) {
    const int before = corners[3 * c];
    const int v = corner_vertex[c];
    const double2 vertex = points[v];
    const int first = border_edge[c];
    int e = first;
    uint count = 0;
    int right = precedes(vertex, points[edges[e].to], 0);
    int is_open = 1;
    while (is_open) {
      const int marked = edges[e].next;
      if (marked >= 0) {
        atomic_or(broken, BROKEN_BORDER);
        break;
      }
      const int then = ~marked;
      const int to = edges[then].to;
      const int then_right = precedes(vertex, points[to], 0);
      edges[e].next = then;
      count += right != then_right;
      right = then_right;
      e = then;
      is_open = ids[to] != before;
    }
    if (count > 0) atomic_add(&counts[v], count);
  }
}

// Rows stand behind others.
kernel void shift_rows(int n, uint base, global uint* restrict rows) {
  const int v = get_global_id(0);
  if (v < n) rows[v] += base;
}
