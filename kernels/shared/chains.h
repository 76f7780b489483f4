// The polygon between a base and a chain of vertices left of it: its triangulation by one work-item, and the steps that
// work-items take together (constrained/chains.cl, constrained/chain_rounds.cl; docs/constrained.md).
//
// Vertices are numbered by their positions in the chain. Half-edge 3t + k runs from corner k of triangle t to the next
// one, counter-clockwise. Its twin is a half-edge, or a side of the polygon: side_from(p) is the edge from position p
// to the next one, and from the last position it is the base.
#ifndef FLAUNAY_CHAINS_H
#define FLAUNAY_CHAINS_H

#include "shared/bounds.h"
#include "shared/halfedges.h"
#include "shared/planar.h"

BEGIN_SHARED

typedef struct {
  double bound;  // of in-circle tests
  int last;      // position
  GLOBAL const double2* places;
  // Of the polygon of those vertices that are inserted, per position: the next one, and the half-edge inside of the
  // edge to it. The next one of the last one is 0.
  GLOBAL int* next;
  GLOBAL int* inside;
  // Per half-edge: its origin and its twin. Vertex v brings triangle v - 1.
  GLOBAL int* corners;
  GLOBAL int* twins;
} polygon;

static inline int side_from(int position) { return -1 - position; }
static inline int position_of(int side) { return -1 - side; }
static inline int own_triangle(int vertex) { return vertex - 1; }

static inline int polygon_orient(const polygon* g, int a, int b, int c) {
  return orient_sign(g->places[a], g->places[b], g->places[c], g->bound == 0.0 ? 0.0 : ORIENT_BOUND);
}
static inline int polygon_circle(const polygon* g, int a, int b, int c, int d) {
  return circle_canonical(g->places[a], g->places[b], g->places[c], g->places[d], g->bound);
}

// ---------------------------------------------------------------------------------------------------------------------
// Gift-wrapping

// All vertices between are left of the chord, so the circles through its ends and one of them are nested.
static inline int apex_of(const polygon* g, int i, int k) {
  const double2 from = g->places[i], to = g->places[k];
  int best = i + 1;
  double2 apex = g->places[best];
  for (int j = best + 1; j < k; ++j) {
    const double2 other = g->places[j];
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

// How near a vertex is to the base.
static inline double base_distance(const polygon* g, int v) {
  const double2 origin = g->places[0];
  const double2 along = g->places[g->last] - origin, from = g->places[v] - origin;
  return fabs(along.x * from.y - along.y * from.x);
}

// A vertex that is nearer to the base than its neighbours must not be removed before one of them: otherwise polygons
// could turn inside out.
static inline int may_be_removed(const polygon* g, int before, int v, int after) {
  const double distance = base_distance(g, v);
  return distance >= base_distance(g, before) || distance >= base_distance(g, after);
}

// The ends of the edge before a twin, as a new vertex on the other side sees it counter-clockwise.
static inline int edge_from(const polygon* g, int twin) {
  return twin >= 0 ? g->corners[next_halfedge(twin)] : g->next[position_of(twin)];
}
static inline int edge_to(const polygon* g, int twin) { return twin >= 0 ? g->corners[twin] : position_of(twin); }

// Whether a new vertex takes away the triangle of a half-edge that it sees.
static inline int takes_away(const polygon* g, int halfedge, int vertex) {
  const int from = edge_from(g, halfedge), to = edge_to(g, halfedge);
  return polygon_orient(g, from, to, vertex) <= 0 ||
         polygon_circle(g, from, to, vertex, g->corners[previous_halfedge(halfedge)]) > 0;
}

static inline void attach(const polygon* g, int halfedge, int twin) {
  g->twins[halfedge] = twin;
  if (twin >= 0) {
    g->twins[twin] = halfedge;
  } else {
    g->inside[position_of(twin)] = halfedge;
  }
}

// The triangle at the base, when it is the only one.
static inline void put_first(const polygon* g, int vertex) {
  const int h = 3 * own_triangle(vertex);
  g->corners[h] = 0;
  g->corners[h + 1] = g->last;
  g->corners[h + 2] = vertex;
  attach(g, h, side_from(g->last));
  attach(g, h + 1, side_from(vertex));
  attach(g, h + 2, side_from(0));
  g->next[0] = vertex;
  g->next[vertex] = g->last;
  g->next[g->last] = 0;
}

// A stack of edges, by their twins, which are linked where the edges' new triangles will be attached.
#define NO_TWIN INT_MIN

static inline GLOBAL int* link_of(const polygon* g, int twin) {
  return twin >= 0 ? &g->twins[twin] : &g->inside[position_of(twin)];
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
// connected to them, and fills the hole with triangles at it. If owners are given, it takes away those that are the
// key's.
static inline void insert_vertex(const polygon* g, int before, int vertex, int after, GLOBAL const uint* owners,
                                 uint key) {
  int top = NO_TWIN, unused = NO_TWIN, h = 3 * own_triangle(vertex), beside = side_from(before);
  push_twin(g, g->inside[before], &top);
  while (top != NO_TWIN) {
    const int twin = pop_twin(g, &top);
    if (twin >= 0 && (owners ? owners[twin / 3] == key : takes_away(g, twin, vertex))) {
      push_twin(g, g->twins[previous_halfedge(twin)], &top);
      push_twin(g, g->twins[next_halfedge(twin)], &top);
      const int removed = twin - twin % 3;
      g->corners[removed] = unused;
      unused = removed;
      continue;
    }
    const int from = edge_from(g, twin), to = edge_to(g, twin);
    if (h == NO_TWIN) {
      h = unused;
      unused = g->corners[h];
    }
    g->corners[h] = from;
    g->corners[h + 1] = to;
    g->corners[h + 2] = vertex;
    attach(g, h, twin);
    attach(g, h + 2, beside);
    beside = h + 1;
    h = NO_TWIN;
  }
  attach(g, beside, side_from(vertex));
  g->next[before] = vertex;
  g->next[vertex] = after;
}

// Triangles that are all counter-clockwise and have a polygon as their border, as these have, do not overlap. If also
// all edges between them are canonical, they are the polygon's only such triangulation.
static inline int is_right(const polygon* g, int triangle) {
  GLOBAL const int* const t = &g->corners[3 * triangle];
  if (polygon_orient(g, t[0], t[1], t[2]) <= 0) return 0;
  for (int h = 3 * triangle; h < 3 * triangle + 3; ++h) {
    const int twin = g->twins[h];
    if (twin > h && polygon_circle(g, t[0], t[1], t[2], g->corners[previous_halfedge(twin)]) > 0) return 0;
  }
  return 1;
}

// ---------------------------------------------------------------------------------------------------------------------
// Random insertion by one work-item

// As of a linear congruential generator (Knuth), whose low bits are bad.
static inline int random_below(ulong* state, int end) {
  *state = *state * 6364136223846793005UL + 1442695040888963407UL;
  return (int)((*state >> 32) * (ulong)end >> 32);
}

// Removes the vertices between the ends in random order from the list, but one.
static inline void choose_order(const polygon* g, GLOBAL int* before, GLOBAL int* order) {
  const int count = g->last - 1;
  for (int k = 0; k <= g->last; ++k) {
    g->next[k] = k + 1;
    before[k] = k - 1;
  }
  for (int i = 0; i < count; ++i) order[i] = i + 1;
  ulong state = 0;
  for (int i = count - 1; i > 0; --i) {
    int v;
    do {
      const int picked = random_below(&state, i + 1);
      v = order[picked];
      order[picked] = order[i];
      order[i] = v;
    } while (!may_be_removed(g, before[v], v, g->next[v]));
    g->next[before[v]] = g->next[v];
    before[g->next[v]] = before[v];
  }
}

// Returns whether the result is right.
static inline int insert_all(const polygon* g, GLOBAL int* before, GLOBAL int* order) {
  const int count = g->last - 1;
  choose_order(g, before, order);
  put_first(g, order[0]);
  for (int i = 1; i < count; ++i) insert_vertex(g, before[order[i]], order[i], g->next[order[i]], 0, 0);
  int right = 1;
  for (int t = 0; t < count && right; ++t) right = is_right(g, t);
  return right;
}

// Rows whose triangles are not known yet hold the half-edges inside of their chords.
static inline void write_rows(const polygon* g, GLOBAL int* rows) {
  rows[0] = g->inside[g->last];
  for (int place = 0; place < g->last - 1; ++place) {
    GLOBAL int* const row = rows + 3 * place;
    const int h = row[0];
    const int i = g->corners[h], j = g->corners[previous_halfedge(h)], k = g->corners[next_halfedge(h)];
    row[0] = i;
    row[1] = j;
    row[2] = k;
    if (j - i > 1) row[3] = g->twins[previous_halfedge(h)];
    if (k - j > 1) row[3 * (j - i)] = g->twins[next_halfedge(h)];
  }
}

END_SHARED

#endif
