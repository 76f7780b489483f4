// Makes the edge rings of cocircular points canonical: their polygons become fans from their first vertices along x.
//
// Merges leave such polygons as they meet them (mesh/rings.h), all or the large ones: a merge of two fans would rebuild
// one of them. These passes follow the last merge. They do nothing if no ties were left, by the account of the merges:
// 1. find_inside, with one work-item per pair of edges, marks the edges that may be inside of polygons, by floating
//    point; find_inside_exactly decides exactly.
// 2. find_fans, with one work-item per pair, finds the first vertex of each polygon: as a polygon is convex, that one
//    comes before both of its neighbours on the polygon. It says so at one edge inside of the polygon: the first one at
//    that vertex, counter-clockwise, or the one opposite to it, if it has none. It also makes the vertices' own edges
//    ones that stay.
// 3. build_fans flips the edges of each polygon that do not leave its first vertex. It changes only edges that
//    lie inside of one polygon.
//
// Where blocks are not merged, they have no polygons in common: make_fans_of_blocks makes these passes over the pairs
// of each block, by a work-group per block, in one launch.

#include "blocks/codes.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "operations/prefetch.h"
#include "predicates/records.h"

// The third corner of the triangle left of edge e; NO_VERTEX if there is no such triangle. (For a set whose hull has
// three corners that is also the third of them, seen from outside.)
static inline int apex_left_of(int e, global const ring_edge* edges) {
  const int apex = edges[edges[e].next].to;
  return edges[edges[e ^ 1].previous].to == apex ? apex : NO_VERTEX;
}

// Edges lead anywhere within a block.
static inline void fetch_edges(int pair, int pairs, global const ring_edge* edges) {
  fetch(&edges[2 * min(pairs - 1, pair + FETCH_AHEAD)]);
}
static inline void fetch_points(int pair, int pairs, global const coordinate2* points) {
  fetch(&points[2 * min(pairs - 1, pair + FETCH_AHEAD) / EDGES_PER_VERTEX]);
}

#define NOT_INSIDE 0
#define INSIDE 1

// Whether the ends of pair k and the third corners of the triangles on either side are cocircular. Where there is a
// triangle on either side, these are the vertices behind the next edges; whether there is, is seldom worth asking.
static inline int inside_of(int k, filter_bound bound, int exactly, global const coordinate2* points,
                            global const ring_edge* edges) {
  const int from = edges[2 * k + 1].to, to = edges[2 * k].to;
  const int left = edges[edges[2 * k].next].to, right = edges[edges[2 * k + 1].next].to;
  if (left == right) return NOT_INSIDE;
  const coordinate2 a = points[from], b = points[to], c = points[left], d = points[right];
  const int sign =
      exactly ? circle_undecided(a, b, c, d, bound) : angle_compared(angle_at(d, a, b), angle_at(c, a, b), bound);
  if (sign == 1 || sign == -1) return NOT_INSIDE;
  if (apex_left_of(2 * k, edges) == NO_VERTEX || apex_left_of(2 * k + 1, edges) == NO_VERTEX) return NOT_INSIDE;
  return INSIDE;
}

// By floating point alone. Edges in doubt may be inside.
static inline int may_be_inside(int k, filter_bound bound, global const coordinate2* points,
                                global const ring_edge* edges) {
  return edges[2 * k].to == NO_VERTEX ? NOT_INSIDE : inside_of(k, angle_bound(bound), 0, points, edges);
}

// n pairs of edges; account: of the merges.
kernel void find_inside(int n, filter_bound bound, global const uint* restrict account,
                        global const coordinate2* restrict points, global const ring_edge* restrict edges,
                        global uchar* restrict unsure) {
  const int k = get_global_id(0);
  if (k < n && account[RINGS_TIES_LEFT] > 0) {
    fetch_edges(k, n, edges);
    fetch_points(k, n, points);
    unsure[k] = may_be_inside(k, bound, points, edges);
  }
}

// Whether a side of the triangles beside pair k may be inside of a polygon, too: of a quadrilateral, none is.
static inline int has_unsure_sides(int k, global const ring_edge* edges, global const uchar* unsure) {
  const ring_edge there = edges[2 * k], back = edges[2 * k + 1];
  return unsure[there.next >> 1] | unsure[there.previous >> 1] | unsure[back.next >> 1] | unsure[back.previous >> 1];
}

// n pairs of edges. with_quadrilaterals: whether these are not yet canonical; then find_inside is not needed.
kernel void find_inside_exactly(int n, int with_quadrilaterals, filter_bound bound, global const uint* restrict account,
                                global const coordinate2* restrict points, global const ring_edge* restrict edges,
                                global const uchar* restrict unsure, global uchar* restrict inside) {
  const int k = get_global_id(0);
  if (k < n && account[RINGS_TIES_LEFT] > 0) {
    const int may_be =
        with_quadrilaterals ? may_be_inside(k, bound, points, edges) : unsure[k] && has_unsure_sides(k, edges, unsure);
    inside[k] = may_be ? inside_of(k, angle_bound(bound), 1, points, edges) : NOT_INSIDE;
  }
}

static inline int is_inside(int e, global const uchar* inside) { return inside[e >> 1]; }

// The first edge around a vertex from e on that is not inside of a polygon.
static inline int first_outside(int e, global const ring_edge* edges, global const uchar* inside) {
  while (e != NO_EDGE && is_inside(e, inside)) e = edges[e].next;
  return e;
}

// Whether a polygon's first vertex is the origin of e, an edge inside of it, and e comes behind the polygon's first
// edge there.
static inline int is_first_of_fan(int e, global const coordinate2* points, global const ring_edge* edges,
                                  global const uchar* inside) {
  if (is_inside(edges[e].previous, inside)) return 0;
  const coordinate2 vertex = points[edges[e ^ 1].to];
  int last = edges[e].next;
  while (is_inside(last, inside)) last = edges[last].next;
  return comes_before(vertex, points[edges[edges[e].previous].to]) && comes_before(vertex, points[edges[last].to]);
}

// Whether it is the apex left of e, an edge inside of it, and no edge inside of it ends there.
static inline int is_opposite_of_fan(int e, global const coordinate2* points, global const ring_edge* edges,
                                     global const uchar* inside) {
  if (is_inside(edges[e].next, inside) || is_inside(edges[e ^ 1].previous, inside)) return 0;
  const coordinate2 apex = points[edges[edges[e].next].to];
  return comes_before(apex, points[edges[e].to]) && comes_before(apex, points[edges[e ^ 1].to]);
}

// Where find_fans finds a polygon's first vertex, seen from an edge; plus 1 for the second edge of the pair.
#define NOT_HERE 0
#define AT_ORIGIN 2
#define AT_APEX 4

static inline int where_fan_is(int k, global const coordinate2* points, global const ring_edge* edges,
                               global const uchar* inside) {
  int where = NOT_HERE;
  for (int odd = 0; inside[k] && odd < 2; ++odd) {
    if (is_first_of_fan(2 * k + odd, points, edges, inside)) where = AT_ORIGIN + odd;
    if (is_opposite_of_fan(2 * k + odd, points, edges, inside)) where = AT_APEX + odd;
  }
  return where;
}

// n pairs of edges.
kernel void find_fans(int n, global const uint* restrict account, global const coordinate2* restrict points,
                      global const ring_edge* restrict edges, global const uchar* restrict inside,
                      global int* restrict vertex_edge, global uchar* restrict found) {
  const int k = get_global_id(0);
  if (k < n && account[RINGS_TIES_LEFT] > 0) {
    if (k < n / PAIRS_PER_VERTEX) vertex_edge[k] = first_outside(vertex_edge[k], edges, inside);
    found[k] = where_fan_is(k, points, edges, inside);
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

// found: where the first vertex of pair k's polygon is.
static inline void build_fan(int k, int found, global const uchar* inside, global ring_edge* edges) {
  const filter_bounds no_bounds = {0, 0, 0, 0};
  rings g = rings_on(edges, 0, 0, no_bounds);
  const int seen_from = 2 * k + (found & 1);
  int e = found < AT_APEX ? edges[seen_from].previous : edges[seen_from].next ^ 1;
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

// n pairs of edges.
kernel void build_fans(int n, global const uint* restrict account, global const uchar* restrict inside,
                       global const uchar* restrict found, global ring_edge* edges) {
  const int k = get_global_id(0);
  if (k < n && account[RINGS_TIES_LEFT] > 0 && found[k] != NOT_HERE) build_fan(k, found[k], inside, edges);
}

// offsets: the first place of each block, and the end.
kernel void make_fans_of_blocks(int blocks, global const int* restrict offsets, filter_bound bound,
                                global const uint* restrict account, global const coordinate2* restrict points,
                                global ring_edge* edges, global int* restrict vertex_edge, global uchar* inside,
                                global uchar* restrict found) {
  const int b = get_group_id(0), lanes = get_local_size(0);
  const int is_wanted = b < blocks && account[RINGS_TIES_LEFT] > 0;
  const int begin = is_wanted ? offsets[b] : 0, end = is_wanted ? offsets[b + 1] : 0;
  const int first = PAIRS_PER_VERTEX * begin + (int)get_local_id(0), last = PAIRS_PER_VERTEX * end;
  for (int k = first; k < last; k += lanes) {
    inside[k] =
        may_be_inside(k, bound, points, edges) ? inside_of(k, angle_bound(bound), 1, points, edges) : NOT_INSIDE;
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int v = begin + (int)get_local_id(0); v < end; v += lanes) {
    vertex_edge[v] = first_outside(vertex_edge[v], edges, inside);
  }
  for (int k = first; k < last; k += lanes) found[k] = where_fan_is(k, points, edges, inside);
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (int k = first; k < last; k += lanes) {
    if (found[k] != NOT_HERE) build_fan(k, found[k], inside, edges);
  }
}
