// The polygon between a base and a chain of vertices left of it: its triangulation by one work-item, and the steps that
// work-items take together (constrained/chains.cl, constrained/chain_rounds.cl; docs/constrained.md).
//
// Vertices are numbered by their positions in the chain. Half-edge 3t + k runs from corner k of triangle t to the next
// one, counter-clockwise. Its twin is a half-edge, or a side of the polygon: side_from(p) is the edge from position p
// to the next one, and from the last position it is the base.
#ifndef FLAUNAY_CHAINS_H
#define FLAUNAY_CHAINS_H

#include "constrained/records.h"
#include "mesh/halfedges.h"
#include "predicates/bounds.h"
#include "predicates/planar.h"

BEGIN_SHARED

// The next vertex of the last one is 0. Vertex v brings triangle v - 1.
typedef struct {
  filter_bound bound;  // of in-circle tests
  int last;            // position
  GLOBAL const coordinate2* places;
  GLOBAL chain_vertex* vertices;
  GLOBAL chain_edge* edges;
} polygon;

static inline polygon polygon_at(filter_bound bound, int first, int size, GLOBAL const coordinate2* places,
                                 GLOBAL chain_vertex* vertices, GLOBAL chain_edge* edges) {
  polygon g;
  g.bound = bound;
  g.last = size - 1;
  g.places = places + first;
  g.vertices = vertices + first;
  g.edges = edges + (int64)3 * first;
  return g;
}

static inline int side_from(int position) { return -1 - position; }
static inline int position_of(int side) { return -1 - side; }
static inline int own_triangle(int vertex) { return vertex - 1; }

static inline int polygon_orient(const polygon* g, int a, int b, int c) {
  return orient_sign(g->places[a], g->places[b], g->places[c], g->bound == 0 ? 0 : ORIENT_BOUND);
}
static inline int polygon_circle(const polygon* g, int a, int b, int c, int d) {
  return circle_canonical(g->places[a], g->places[b], g->places[c], g->places[d], g->bound);
}

// ---------------------------------------------------------------------------------------------------------------------
// Gift-wrapping

// All vertices between are left of the chord, so the circles through its ends and one of them are nested.
static inline int apex_of(const polygon* g, int i, int k) {
  const coordinate2 from = g->places[i], to = g->places[k];
  int best = i + 1;
  coordinate2 apex = g->places[best];
  for (int j = best + 1; j < k; ++j) {
    const coordinate2 other = g->places[j];
    if (circle_canonical(from, to, apex, other, g->bound) > 0) {
      best = j;
      apex = other;
    }
  }
  return best;
}

// Rows whose triangles are not known yet hold their chords.
static inline void wrap(const polygon* g, GLOBAL int* rows) {
  rows[0] = 0;
  rows[2] = g->last;
  for (int place = 0; place < g->last - 1; ++place) {
    GLOBAL int* const row = rows + 3 * place;
    const int i = row[0], k = row[2];
    const int j = apex_of(g, i, k);
    row[1] = j;
    if (j - i > 1) {
      row[3] = i;
      row[5] = j;
    }
    if (k - j > 1) {
      GLOBAL int* const child = row + 3 * (j - i);
      child[0] = j;
      child[2] = k;
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Insertion of a vertex beyond a side

// Whether a vertex is nearer to the base than another one.
static inline int is_nearer(const polygon* g, int v, int other) {
  return cross_sign(g->places[0], g->places[g->last], g->places[other], g->places[v]) < 0;
}

// A vertex that is nearer to the base than its neighbours must not be removed before one of them: otherwise polygons
// could turn inside out.
static inline int may_be_removed(const polygon* g, int before, int v, int after) {
  return !is_nearer(g, v, before) || !is_nearer(g, v, after);
}

// The ends of the edge before a twin, as a new vertex on the other side sees it counter-clockwise.
static inline int edge_from(const polygon* g, int twin) {
  return twin >= 0 ? g->edges[next_halfedge(twin)].origin : g->vertices[position_of(twin)].next;
}
static inline int edge_to(const polygon* g, int twin) { return twin >= 0 ? g->edges[twin].origin : position_of(twin); }

// Whether a new vertex takes away the triangle of a half-edge that it sees.
static inline int takes_away(const polygon* g, int halfedge, int vertex) {
  const int from = edge_from(g, halfedge), to = edge_to(g, halfedge);
  return polygon_orient(g, from, to, vertex) <= 0 ||
         polygon_circle(g, from, to, vertex, g->edges[previous_halfedge(halfedge)].origin) > 0;
}

static inline void attach(const polygon* g, int halfedge, int twin) {
  g->edges[halfedge].twin = twin;
  if (twin >= 0) {
    g->edges[twin].twin = halfedge;
  } else {
    g->vertices[position_of(twin)].inside = halfedge;
  }
}

// The triangle at the base, when it is the only one.
static inline void put_first(const polygon* g, int vertex) {
  const int h = 3 * own_triangle(vertex);
  g->edges[h].origin = 0;
  g->edges[h + 1].origin = g->last;
  g->edges[h + 2].origin = vertex;
  attach(g, h, side_from(g->last));
  attach(g, h + 1, side_from(vertex));
  attach(g, h + 2, side_from(0));
  g->vertices[0].next = vertex;
  g->vertices[vertex].next = g->last;
  g->vertices[g->last].next = 0;
}

// A stack of edges, by their twins, which are linked where the edges' new triangles will be attached.
#define NO_TWIN INT_MIN

static inline GLOBAL int* link_of(const polygon* g, int twin) {
  return twin >= 0 ? &g->edges[twin].twin : &g->vertices[position_of(twin)].inside;
}
static inline int pop_twin(const polygon* g, int* top) {
  const int twin = *top;
  *top = *link_of(g, twin);
  return twin;
}
static inline void push_twin(const polygon* g, int twin, int* top) {
  *link_of(g, twin) = *top;
  *top = twin;
}

// Inserts a vertex between two that follow each other: removes the triangles that it takes away, as far as it is
// connected to them, and fills the hole with triangles at it. If owners are given, it removes the triangles
// that belong to the key.
static inline void insert_vertex(const polygon* g, int before, int vertex, int after, GLOBAL const uint* owners,
                                 uint key) {
  int top = NO_TWIN, unused = NO_TWIN, h = 3 * own_triangle(vertex), beside = side_from(before);
  push_twin(g, g->vertices[before].inside, &top);
  while (top != NO_TWIN) {
    const int twin = pop_twin(g, &top);
    if (twin >= 0 && (owners ? owners[twin / 3] == key : takes_away(g, twin, vertex))) {
      push_twin(g, g->edges[previous_halfedge(twin)].twin, &top);
      push_twin(g, g->edges[next_halfedge(twin)].twin, &top);
      const int removed = twin - twin % 3;
      g->edges[removed].origin = unused;
      unused = removed;
      continue;
    }
    const int from = edge_from(g, twin), to = edge_to(g, twin);
    if (h == NO_TWIN) {
      h = unused;
      unused = g->edges[h].origin;
    }
    g->edges[h].origin = from;
    g->edges[h + 1].origin = to;
    g->edges[h + 2].origin = vertex;
    attach(g, h, twin);
    attach(g, h + 2, beside);
    beside = h + 1;
    h = NO_TWIN;
  }
  attach(g, beside, side_from(vertex));
  g->vertices[before].next = vertex;
  g->vertices[vertex].next = after;
}

// Triangles that are all counter-clockwise and have a polygon as their border, as these have, do not overlap. If also
// all edges between them are canonical, they are the polygon's only such triangulation.
static inline int is_right(const polygon* g, int triangle) {
  const int a = g->edges[3 * triangle].origin, b = g->edges[3 * triangle + 1].origin;
  const int c = g->edges[3 * triangle + 2].origin;
  if (polygon_orient(g, a, b, c) <= 0) return 0;
  for (int h = 3 * triangle; h < 3 * triangle + 3; ++h) {
    const int twin = g->edges[h].twin;
    if (twin > h && polygon_circle(g, a, b, c, g->edges[previous_halfedge(twin)].origin) > 0) return 0;
  }
  return 1;
}

// ---------------------------------------------------------------------------------------------------------------------
// A walk around the triangles that a vertex takes away, which changes nothing

// The half-edge of a triangle that separates it from the side between a position and the next one.
static inline int entry_of(const polygon* g, int triangle, int before) {
  const int h = 3 * triangle;
  const int a = g->edges[h].origin, b = g->edges[h + 1].origin, c = g->edges[h + 2].origin;
  // Half-edges lead to smaller positions, but for the one that has the base on its side.
  if (b <= before && before < a) return h;
  if (c <= before && before < b) return h + 1;
  if (a <= before && before < c) return h + 2;
  return a < b ? h : b < c ? h + 1 : h + 2;
}

// After the twin behind which all is known: the half-edge to be crossed next, or the side if all is known.
static inline int edge_after(const polygon* g, int twin, int before) {
  int h = *link_of(g, twin);
  while (h >= 0) {
    const int entry = entry_of(g, h / 3, before);
    if (h == next_halfedge(entry)) return previous_halfedge(entry);
    h = g->edges[entry].twin;
  }
  return h;
}

// ---------------------------------------------------------------------------------------------------------------------
// Random insertion by one work-item

// Takes the high bits of a linear congruential generator (Knuth), since its low bits are bad.
static inline int random_below(uint64* state, int end) {
  *state = *state * 6364136223846793005UL + 1442695040888963407UL;
  return (int)((*state >> 32) * (uint64)end >> 32);
}

// Where a work-item alone has the order of insertion, the vertex after another one is the next one.
#define ORDER after

// Removes the vertices between the ends in random order from the list, but one.
static inline void choose_order(const polygon* g) {
  const int count = g->last - 1;
  GLOBAL chain_vertex* const vertices = g->vertices;
  for (int k = 0; k <= g->last; ++k) {
    vertices[k].next = k + 1;
    vertices[k].before = k - 1;
    vertices[k].ORDER = k + 1;
  }
  uint64 state = 0;
  for (int i = count - 1; i > 0; --i) {
    int v;
    do {
      const int picked = random_below(&state, i + 1);
      v = vertices[picked].ORDER;
      vertices[picked].ORDER = vertices[i].ORDER;
      vertices[i].ORDER = v;
    } while (!may_be_removed(g, vertices[v].before, v, vertices[v].next));
    vertices[vertices[v].before].next = vertices[v].next;
    vertices[vertices[v].next].before = vertices[v].before;
  }
}

// Returns whether the result is right.
static inline int insert_all(const polygon* g) {
  const int count = g->last - 1;
  choose_order(g);
  put_first(g, g->vertices[0].ORDER);
  for (int i = 1; i < count; ++i) {
    const int v = g->vertices[i].ORDER;
    insert_vertex(g, g->vertices[v].before, v, g->vertices[v].next, 0, 0);
  }
  int right = 1;
  for (int t = 0; t < count && right; ++t) right = is_right(g, t);
  return right;
}

// Rows whose triangles are not known yet hold the half-edges inside of their chords.
static inline void write_rows(const polygon* g, GLOBAL int* rows) {
  rows[0] = g->vertices[g->last].inside;
  for (int place = 0; place < g->last - 1; ++place) {
    GLOBAL int* const row = rows + 3 * place;
    const int h = row[0];
    const int i = g->edges[h].origin, j = g->edges[previous_halfedge(h)].origin, k = g->edges[next_halfedge(h)].origin;
    row[0] = i;
    row[1] = j;
    row[2] = k;
    if (j - i > 1) row[3] = g->edges[previous_halfedge(h)].twin;
    if (k - j > 1) row[3 * (j - i)] = g->edges[next_halfedge(h)].twin;
  }
}

END_SHARED

#endif
