// Makes the edge rings of cocircular points canonical: their polygons become fans from their first vertices along x.
//
// Merges leave such polygons as they meet them (shared/rings.h): a merge of two fans would rebuild one of them. These
// passes follow the last merge, if there were ties:
// 1. find_inside, with one work-item per pair of edges, marks the edges inside of polygons.
// 2. leave_inside, with one work-item per vertex, makes the vertices' own edges ones that stay.
// 3. find_fans, with one work-item per pair, finds the first vertex of each polygon: as a polygon is convex, that one
//    comes before both of its neighbours on the polygon. It says so at one edge inside of the polygon: the first one at
//    that vertex, counter-clockwise, or the one opposite to it, if it has none.
// 4. build_fans flips the edges of each polygon that do not leave its first vertex. It changes nothing but what lies
//    inside of one polygon.

#include "shared/prefetch.h"
#include "shared/rings.h"

// The third corner of the triangle left of edge e; NO_VERTEX if there is no such triangle. (For a set whose hull has
// three corners that is also the third of them, seen from outside.)
static inline int apex_left_of(int e, global const ring_edge* edges) {
  const int apex = edges[edges[e].next].to;
  return edges[edges[e ^ 1].previous].to == apex ? apex : NO_VERTEX;
}

// c and d lie on either side of the edge from a to b.
static inline int are_cocircular(double2 a, double2 b, double2 c, double2 d, double bound) {
  const int sign = angle_compared(angle_at(d, a, b), angle_at(c, a, b), bound);
  return (sign == UNDECIDED ? circle_undecided(a, b, c, d, bound) : sign) == 0;
}

// Edges lead anywhere within a block.
static inline void fetch_edges(int pair, int pairs, global const ring_edge* edges) {
  fetch(&edges[2 * min(pairs - 1, pair + FETCH_AHEAD)]);
}
static inline void fetch_points(int pair, int pairs, global const double2* points) {
  fetch(&points[2 * min(pairs - 1, pair + FETCH_AHEAD) / EDGES_PER_VERTEX]);
}

// n pairs of edges.
kernel void find_inside(int n, double bound, global const double2* restrict points,
                        global const ring_edge* restrict edges, global uchar* restrict inside) {
  const int k = get_global_id(0);
  if (k < n) {
    fetch_edges(k, n, edges);
    fetch_points(k, n, points);
    const int from = edges[2 * k + 1].to, to = edges[2 * k].to;
    int found = 0;
    if (to != NO_VERTEX) {
      // Where there is a triangle on either side, these are their third corners; whether there is, is seldom worth
      // asking.
      const int left = edges[edges[2 * k].next].to, right = edges[edges[2 * k + 1].next].to;
      found = left != right &&
              are_cocircular(points[from], points[to], points[left], points[right], angle_bound(bound)) &&
              apex_left_of(2 * k, edges) != NO_VERTEX && apex_left_of(2 * k + 1, edges) != NO_VERTEX;
    }
    inside[k] = found;
  }
}

static inline int is_inside(int e, global const uchar* inside) { return inside[e >> 1]; }

// n vertices.
kernel void leave_inside(int n, global const ring_edge* restrict edges, global const uchar* restrict inside,
                         global int* restrict vertex_edge) {
  const int v = get_global_id(0);
  if (v < n) {
    int e = vertex_edge[v];
    if (e != NO_EDGE && is_inside(e, inside)) {
      while (is_inside(e, inside)) e = edges[e].next;
      vertex_edge[v] = e;
    }
  }
}

// Whether a polygon's first vertex is the origin of e, an edge inside of it, and e comes behind the polygon's first
// edge there.
static inline int is_first_of_fan(int e, global const double2* points, global const ring_edge* edges,
                                  global const uchar* inside) {
  if (is_inside(edges[e].previous, inside)) return 0;
  const double2 vertex = points[edges[e ^ 1].to];
  int last = edges[e].next;
  while (is_inside(last, inside)) last = edges[last].next;
  return comes_before(vertex, points[edges[edges[e].previous].to]) && comes_before(vertex, points[edges[last].to]);
}

// Whether it is the apex left of e, an edge inside of it, and no edge inside of it ends there.
static inline int is_opposite_of_fan(int e, global const double2* points, global const ring_edge* edges,
                                     global const uchar* inside) {
  if (is_inside(edges[e].next, inside) || is_inside(edges[e ^ 1].previous, inside)) return 0;
  const double2 apex = points[edges[edges[e].next].to];
  return comes_before(apex, points[edges[e].to]) && comes_before(apex, points[edges[e ^ 1].to]);
}

// Where find_fans finds a polygon's first vertex, seen from an edge; plus 1 for the second edge of the pair.
#define NOT_HERE 0
#define AT_ORIGIN 2
#define AT_APEX 4

// n pairs of edges.
kernel void find_fans(int n, global const double2* restrict points, global const ring_edge* restrict edges,
                      global const uchar* restrict inside, global uchar* restrict found) {
  const int k = get_global_id(0);
  if (k < n) {
    fetch_edges(k, n, edges);
    int where = NOT_HERE;
    for (int odd = 0; inside[k] && odd < 2; ++odd) {
      if (is_first_of_fan(2 * k + odd, points, edges, inside)) where = AT_ORIGIN + odd;
      if (is_opposite_of_fan(2 * k + odd, points, edges, inside)) where = AT_APEX + odd;
    }
    found[k] = where;
  }
}

// The other diagonal of the two triangles beside an edge, to the vertex of edge e, which has one of them on its left
// and the edge opposite to it. The diagonal comes right behind e.
static inline void flip_towards(rings* g, int e, int opposite) {
  global const ring_edge* const edges = g->edges;
  const int from_apex = edges[opposite ^ 1].next ^ 1;
  const int apex = edges[from_apex ^ 1].to, vertex = edges[e ^ 1].to;
  unlink(g, opposite);
  unlink(g, opposite ^ 1);
  g->edges[opposite].to = apex;
  g->edges[opposite ^ 1].to = vertex;
  insert_after(g, opposite, e);
  insert_after(g, opposite ^ 1, from_apex);
}

// n pairs of edges.
kernel void build_fans(int n, global const uchar* restrict inside, global const uchar* restrict found,
                       global ring_edge* edges) {
  const int k = get_global_id(0);
  if (k < n) fetch_edges(k, n, edges);
  if (k < n && found[k] != NOT_HERE) {
    const filter_bounds no_bounds = {0.0, 0.0, 0.0};
    rings g = rings_on(edges, 0, 0, no_bounds);
    const int seen_from = 2 * k + (found[k] & 1);
    int e = found[k] < AT_APEX ? edges[seen_from].previous : edges[seen_from].next ^ 1;
    for (int grows = 1; grows;) {
      const int opposite = edges[e ^ 1].previous, next = edges[e].next;
      grows = is_inside(opposite, inside) || is_inside(next, inside);
      if (is_inside(opposite, inside)) {
        flip_towards(&g, e, opposite);
      } else {
        e = next;
      }
    }
  }
}
