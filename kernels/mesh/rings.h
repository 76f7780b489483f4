// Delaunay triangulations as rings of edges, and Guibas and Stolfi's merge of two of them (ACM Transactions on Graphics
// 4, 1985). RINGS_TIE breaks the ties of cocircular points. With RINGS_STOP, nothing is evaluated exactly: a merge or a
// leaf stops at a predicate that floating point cannot decide, and a program without RINGS_STOP continues it. With
// LOCAL_RINGS, rings are in local memory, and numbers of vertices and edges are short.
#ifndef FLAUNAY_RINGS_H
#define FLAUNAY_RINGS_H

#include "arithmetic/language.h"
#include "mesh/records.h"
#include "operations/counters.h"
#include "predicates/order.h"
#include "predicates/planar.h"
#include "predicates/records.h"

BEGIN_SHARED

#ifdef LOCAL_RINGS
#define RINGS_MEMORY local
typedef short ring_index;
typedef short_edge edge_in_rings;
#else
#define RINGS_MEMORY GLOBAL
typedef int ring_index;
typedef ring_edge edge_in_rings;
#endif
INTEGER_CONSTANT(NO_VERTEX, -1);
INTEGER_CONSTANT(NO_EDGE, -1);
// How far a merge is, unless it has stopped above a base, which is an edge.
INTEGER_CONSTANT(MERGE_IS_DONE, -1);
INTEGER_CONSTANT(MERGE_HAS_NO_BASE, -2);
INTEGER_CONSTANT(MERGE_IS_NEW, -3);
// Whether d counts as inside of the circle of a, b, c if it is on it. So merges make polygons of cocircular points
// canonical if they are small, as all are where coordinates are coarse. Fans of large ones would be made again by each
// merge, edge by edge, and are left to blocks/fans.cl.
#ifndef RINGS_TIE
#define RINGS_TIE(a, b, c, d, bounds) (canonical_tie(a, b, c, d, (bounds).circle) > 0)
#endif
static inline int has_coarse_points(filter_bounds bounds) {
#ifdef FIXED_POINT
  return bounds.coarse;
#else
  return bounds.circle == 0;
#endif
}

// The largest errors of orientations and angle_difference for points whose coordinates differ by at most
// `extent`: the bounds of their filters for the largest magnitudes that their terms can have, with a margin for
// the rounding of these numbers. They exceed the errors that the filters assume, but are computed once.
typedef struct {
  real side, angle;
} largest_errors;

static inline largest_errors errors_within(real extent, filter_bounds bounds) {
  const real magnitude = 2 * (extent * extent);
  const largest_errors errors = {REAL(1.0001) * error_within(bounds.orient, magnitude),
                                 REAL(1.0001) * error_within(angle_bound(bounds.circle), 2 * (magnitude * magnitude))};
  return errors;
}

// The data of one work-item: its own edges, all free at first.
typedef struct {
  RINGS_MEMORY edge_in_rings* edges;
  RINGS_MEMORY const coordinate2* points;  // by vertex
  // An edge out of each vertex, or NO_EDGE; out of a hull's strict corner, the counter-clockwise hull edge.
  RINGS_MEMORY ring_index* vertex_edge;
  filter_bounds bounds;
  largest_errors errors;      // of the triangulations that are being merged
  int free_first, free_last;  // of the list of free edges
  int unused;                 // the first that was never used
  uint undecided;             // predicates that floating point could not decide
  uint ties;                  // how many of these found cocircular points
  uint ties_left;             // how many of these left edges as they were
  // Polygons with this many consecutive ties are left; 0 for all polygons, otherwise at least 2.
  uint most_ties, ties_in_row;
  coordinate2 tied[4];  // the points of the last tie
  TALLY_MEMBER
} rings;

static inline hull_ends ends_of(int first_x, int last_x, int first_y, int last_y) {
  const hull_ends ends = {first_x, last_x, first_y, last_y};
  return ends;
}
static inline hull_ends no_ends(void) { return ends_of(NO_VERTEX, NO_VERTEX, NO_VERTEX, NO_VERTEX); }

static inline int first_along(hull_ends ends, int axis) { return axis ? ends.first_y : ends.first_x; }
static inline int last_along(hull_ends ends, int axis) { return axis ? ends.last_y : ends.last_x; }

static inline hull_ends joined_ends(const rings* g, hull_ends low, hull_ends high, int axis) {
  if (low.first_x == NO_VERTEX) return high;
  if (high.first_x == NO_VERTEX) return low;
  const int along = !axis;
  const int first = first_along(low, along), other_first = first_along(high, along);
  const int last = last_along(low, along), other_last = last_along(high, along);
  // Without branches, since they could not be predicted.
  const int least = first ^ ((first ^ other_first) & -precedes(g->points[other_first], g->points[first], along));
  const int most = last ^ ((last ^ other_last) & -precedes(g->points[last], g->points[other_last], along));
  return axis ? ends_of(least, most, low.first_y, high.last_y) : ends_of(low.first_x, high.last_x, least, most);
}

// Errors with which nothing is decided.
static inline largest_errors unknown_errors(void) {
  const largest_errors errors = {INFINITY, INFINITY};
  return errors;
}

// The errors between points within the ends of a hull.
static inline largest_errors errors_between(const rings* g, hull_ends ends) {
  const real width = difference(g->points[ends.last_x].x, g->points[ends.first_x].x);
  const real height = difference(g->points[ends.last_y].y, g->points[ends.first_y].y);
  return errors_within(fmax(width, height), g->bounds);
}

static inline rings rings_on(RINGS_MEMORY edge_in_rings* edges, RINGS_MEMORY const coordinate2* points,
                             RINGS_MEMORY ring_index* vertex_edge, filter_bounds bounds) {
  rings g;
  g.edges = edges;
  g.points = points;
  g.vertex_edge = vertex_edge;
  g.bounds = bounds;
  g.errors = unknown_errors();
  g.free_first = g.free_last = g.unused = NO_EDGE;
  g.undecided = g.ties = g.ties_left = 0;
  g.most_ties = g.ties_in_row = 0;
  g.tied[0] = g.tied[1] = g.tied[2] = g.tied[3] = VECTOR(coordinate2, 0, 0);
  CLEAR_TALLY(g);
  return g;
}

#ifdef RINGS_STOP
#define HAS_STOPPED(g) ((g)->undecided > 0)
#define EXACT_OR_STOPPED(sign) 0
#else
#define HAS_STOPPED(g) 0
#define EXACT_OR_STOPPED(sign) (sign)
#endif

// Orientations that filters could not decide; out of line, so that merges have more registers. In fixed point,
// exact orientations are a few products, for which no merge needs to stop.
OUT_OF_LINE static inline int side_undecided(rings* g, coordinate2 a, coordinate2 b, coordinate2 c) {
#if defined(FIXED_POINT) && defined(RINGS_STOP)
  return orient_exact(a, b, c);
#else
  ++g->undecided;
  return EXACT_OR_STOPPED(orient_exact(a, b, c));
#endif
}

static inline int side_filtered(rings* g, coordinate2 a, coordinate2 b, coordinate2 c) {
  const int sign = orient_filtered(a, b, c, g->bounds.orient);
  return sign != UNDECIDED ? sign : side_undecided(g, a, b, c);
}
static inline int side_of(rings* g, coordinate2 a, coordinate2 b, coordinate2 c) {
  TALLY(*g, orientations, 1);
  return side_filtered(g, a, b, c);
}

static inline int turns_left(rings* g, coordinate2 a, coordinate2 b, coordinate2 c) { return side_of(g, a, b, c) > 0; }

// Decisions of a merge compare with the largest errors between its points, and nearly always that is all. The others
// are made as elsewhere, out of line.
OUT_OF_LINE static inline int turns_left_filtered(rings* g, coordinate2 a, coordinate2 b, coordinate2 c) {
  return side_filtered(g, a, b, c) > 0;
}
static inline int turns_left_in_merge(rings* g, coordinate2 a, coordinate2 b, coordinate2 c) {
  TALLY(*g, orientations, 1);
  const real2 ca = difference2(a, c), cb = difference2(b, c);
  const real det = ca.x * cb.y - ca.y * cb.x;
  return det > g->errors.side ? 1 : det < -g->errors.side ? 0 : turns_left_filtered(g, a, b, c);
}

static inline int is_same(coordinate2 p, coordinate2 q) {
  return ((as_ulong(p.x) ^ as_ulong(q.x)) | (as_ulong(p.y) ^ as_ulong(q.y))) == 0;
}
static inline int is_tied(const rings* g, coordinate2 p) {
  return is_same(p, g->tied[0]) | is_same(p, g->tied[1]) | is_same(p, g->tied[2]) | is_same(p, g->tied[3]);
}

// Counts consecutive ties that are known to belong to one polygon. Each brings another point.
static inline void count_tie(rings* g, coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d) {
  int is_again = 0;
  if (is_tied(g, a) & is_tied(g, b)) {
    const int others = is_tied(g, c) + is_tied(g, d);
    is_again = others == 1;
    if (others == 0) {
      // Two of the last four points are a and b.
      int k = is_same(g->tied[0], a) | is_same(g->tied[0], b);
      if (k == 1 && (is_same(g->tied[1], a) | is_same(g->tied[1], b))) k = 2;
      is_again = circle_sign(a, b, c, g->tied[k], g->bounds.circle) == 0;
    }
  }
  g->ties_in_row = is_again ? g->ties_in_row + 1 : 1;
  g->tied[0] = a;
  g->tied[1] = b;
  g->tied[2] = c;
  g->tied[3] = d;
}

OUT_OF_LINE static inline int in_circle_exactly(rings* g, coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d,
                                                filter_bound bound) {
  ++g->undecided;
#ifdef RINGS_STOP
  return 0;
#else
  const int sign = circle_undecided(a, b, c, d, bound);
  if (sign != 0) return sign > 0;
  // Below a base, nothing is inside of a circle over it.
  if (!turns_left(g, a, b, d)) return 0;
  ++g->ties;
  if (g->most_ties > 0) count_tie(g, a, b, c, d);
  if (g->ties_in_row < g->most_ties) return RINGS_TIE(a, b, c, d, g->bounds);
  ++g->ties_left;
  return 0;
#endif
}

OUT_OF_LINE static inline int in_circle_undecided(rings* g, coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d,
                                                  filter_bound bound) {
  if (!has_coarse_points(g->bounds)) return in_circle_exactly(g, a, b, c, d, bound);
  const int sign = circle_coarse(a, b, c, d);
  return sign != 0 ? sign > 0 : RINGS_TIE(a, b, c, d, g->bounds);
}

// Is d inside of the circle through a, b, c (counter-clockwise)?
static inline int in_circle(rings* g, coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d) {
  TALLY(*g, circles, 1);
  const int sign = circle_filtered(a, b, c, d, g->bounds.circle);
  return sign == 1 || sign == -1 ? sign > 0 : in_circle_undecided(g, a, b, c, d, g->bounds.circle);
}

static inline void put_edge(rings* g, int e, int to, int next, int previous) {
  const edge_in_rings edge = {to, next, previous};
  g->edges[e] = edge;
}

static inline int make_edge(rings* g, int from, int to) {
  int e = g->free_first;
  if (e == NO_EDGE) {
    e = g->unused;
    g->unused += 2;
  } else {
    g->free_first = g->edges[e].next;
  }
  put_edge(g, e, to, e, e);
  put_edge(g, e ^ 1, from, e ^ 1, e ^ 1);
  return e;
}

static inline void free_edge(rings* g, int e) {
  g->edges[e].to = g->edges[e ^ 1].to = NO_VERTEX;
  g->edges[e].next = g->free_first;
  if (g->free_first == NO_EDGE) g->free_last = e;
  g->free_first = e;
}

static inline free_edges free_list(const rings* g) {
  const free_edges list = {g->free_first, g->free_last};
  return list;
}

// The free edges of two parts that are to be merged.
static inline void join_free_lists(rings* g, free_edges low, free_edges high) {
  g->free_first = low.first == NO_EDGE ? high.first : low.first;
  g->free_last = high.first == NO_EDGE ? low.last : high.last;
  if (low.first != NO_EDGE && high.first != NO_EDGE) g->edges[low.last].next = high.first;
}

// Adds the edges from the first unused one to end - 1 to the free list.
static inline void free_unused(rings* g, int end) {
  for (int e = g->unused; e < end; e += 2) {
    put_edge(g, e, NO_VERTEX, e, e);
    put_edge(g, e + 1, NO_VERTEX, e, e);
    free_edge(g, e);
  }
}

// Puts edge e into a ring, between two neighbours.
static inline void join(rings* g, int previous, int e, int next) {
  g->edges[e].previous = previous;
  g->edges[e].next = next;
  g->edges[previous].next = e;
  g->edges[next].previous = e;
}
static inline void insert_after(rings* g, int e, int f) { join(g, f, e, g->edges[f].next); }
static inline void insert_before(rings* g, int e, int f) { join(g, g->edges[f].previous, e, f); }

// Takes edge e, which is not its origin's vertex_edge, out of the ring, in which there are others.
static inline void unlink(rings* g, int e) {
  const int next = g->edges[e].next, previous = g->edges[e].previous;
  g->edges[previous].next = next;
  g->edges[next].previous = previous;
}

static inline void take_out(rings* g, int e, int origin) {
  // Without a branch, since it could not be predicted.
  const int present = g->vertex_edge[origin], next = g->edges[e].next;
  g->vertex_edge[origin] = present == e ? next : present;
  unlink(g, e);
}

static inline void remove_edge(rings* g, int e) {
  const int to = g->edges[e].to, from = g->edges[e ^ 1].to;
  take_out(g, e, from);
  take_out(g, e ^ 1, to);
  free_edge(g, e & ~1);
}

// Vertices v and v + 1.
static inline void make_pair(rings* g, int v) {
  const int e = make_edge(g, v, v + 1);
  g->vertex_edge[v] = e;
  g->vertex_edge[v + 1] = e ^ 1;
}

// Vertices v to v + 2, in the order of axis 0.
static inline void make_three(rings* g, int v) {
  const coordinate2 a = g->points[v], b = g->points[v + 1], c = g->points[v + 2];
  const int side = side_of(g, a, b, c);
  const int e = g->unused;
  const int third = side != 0;
  g->unused += 4 + 2 * third;
  put_edge(g, e, v + 1, third ? e + 5 : e, third ? e + 5 : e);
  put_edge(g, e + 1, v, e + 2, e + 2);
  put_edge(g, e + 2, v + 2, e + 1, e + 1);
  put_edge(g, e + 3, v + 1, third ? e + 4 : e + 3, third ? e + 4 : e + 3);
  if (third) {
    put_edge(g, e + 4, v, e + 3, e + 3);
    put_edge(g, e + 5, v + 2, e, e);
  }
  g->vertex_edge[v] = side < 0 ? e + 5 : e;
  g->vertex_edge[v + 1] = side < 0 ? e + 1 : e + 2;
  g->vertex_edge[v + 2] = side > 0 ? e + 4 : e + 3;
}

// A convex quadrilateral, counter-clockwise, with the diagonal from q.x to q.z.
static inline void make_quadrilateral(rings* g, int4 q) {
  const int e = g->unused;
  g->unused += 10;
  put_edge(g, e, q.y, e + 8, e + 7);
  put_edge(g, e + 1, q.x, e + 2, e + 2);
  put_edge(g, e + 2, q.z, e + 1, e + 1);
  put_edge(g, e + 3, q.y, e + 4, e + 9);
  put_edge(g, e + 4, q.w, e + 9, e + 3);
  put_edge(g, e + 5, q.z, e + 6, e + 6);
  put_edge(g, e + 6, q.x, e + 5, e + 5);
  put_edge(g, e + 7, q.w, e, e + 8);
  put_edge(g, e + 8, q.z, e + 7, e);
  put_edge(g, e + 9, q.x, e + 3, e + 4);
  g->vertex_edge[q.x] = e;
  g->vertex_edge[q.y] = e + 2;
  g->vertex_edge[q.z] = e + 4;
  g->vertex_edge[q.w] = e + 6;
}

// A triangle, counter-clockwise, joined to a vertex inside, q.w.
static inline void make_star(rings* g, int4 q) {
  const int e = g->unused;
  g->unused += 12;
  put_edge(g, e, q.y, e + 6, e + 5);
  put_edge(g, e + 1, q.x, e + 2, e + 8);
  put_edge(g, e + 2, q.z, e + 8, e + 1);
  put_edge(g, e + 3, q.y, e + 4, e + 10);
  put_edge(g, e + 4, q.x, e + 10, e + 3);
  put_edge(g, e + 5, q.z, e, e + 6);
  put_edge(g, e + 6, q.w, e + 5, e);
  put_edge(g, e + 7, q.x, e + 9, e + 11);
  put_edge(g, e + 8, q.w, e + 1, e + 2);
  put_edge(g, e + 9, q.y, e + 11, e + 7);
  put_edge(g, e + 10, q.w, e + 3, e + 4);
  put_edge(g, e + 11, q.z, e + 7, e + 9);
  g->vertex_edge[q.x] = e;
  g->vertex_edge[q.y] = e + 2;
  g->vertex_edge[q.z] = e + 4;
  g->vertex_edge[q.w] = e + 7;
}

// An edge from the right triangulation to the left one that has both above it. Changes nothing before it is found.
static inline int lower_tangent(rings* g, int left, int right) {
  RINGS_MEMORY const edge_in_rings* edges = g->edges;
  int left_edge = g->vertex_edge[left], right_edge = g->vertex_edge[right];
  // The clockwise hull edge out of the left vertex; a vertex alone has none.
  if (left_edge != NO_EDGE) left_edge = edges[left_edge].previous;
  for (int moves = 1; moves;) {
    TALLY(*g, steps, 1);
    const coordinate2 l = g->points[left], r = g->points[right];
    if (left_edge != NO_EDGE && turns_left_in_merge(g, r, l, g->points[edges[left_edge].to])) {
      left = edges[left_edge].to;
      left_edge = edges[left_edge ^ 1].previous;
    } else if (right_edge != NO_EDGE && turns_left_in_merge(g, l, g->points[edges[right_edge].to], r)) {
      right = edges[right_edge].to;
      right_edge = edges[right_edge ^ 1].next;
    } else {
      moves = 0;
    }
    if (HAS_STOPPED(g)) return MERGE_HAS_NO_BASE;
  }
  const int base = make_edge(g, right, left);
  if (right_edge != NO_EDGE) insert_before(g, base, right_edge);
  if (left_edge != NO_EDGE) insert_after(g, base ^ 1, left_edge);
  g->vertex_edge[left] = base ^ 1;
  return base;
}

// Whether an apex that sees the base so lies above it.
static inline int is_above(rings* g, coordinate_pair left, coordinate_pair right, coordinate_pair apex,
                           real_pair seen) {
  TALLY(*g, orientations, 1);
  const real across = high(seen);
  return across > g->errors.side    ? 1
         : across < -g->errors.side ? 0
                                    : turns_left_filtered(g, as_point(left), as_point(right), as_point(apex));
}

// Whether a point that sees the base so is inside of the circle through the base and an apex above it.
OUT_OF_LINE static inline int rules_out_filtered(rings* g, coordinate_pair left, coordinate_pair right,
                                                 coordinate_pair apex, coordinate_pair point) {
  const filter_bound bound = angle_bound(g->bounds.circle);
  const int sign = angle_compared(angle_of(point, left, right), angle_of(apex, left, right), bound);
  return sign == 1 || sign == -1
             ? sign > 0
             : in_circle_undecided(g, as_point(left), as_point(right), as_point(apex), as_point(point), bound);
}
static inline int rules_out(rings* g, coordinate_pair left, coordinate_pair right, coordinate_pair apex,
                            real_pair apex_seen, coordinate_pair point, real_pair seen) {
  TALLY(*g, circles, 1);
  const real wider = angle_difference(seen, apex_seen);
  return wider > g->errors.angle ? 1 : wider < -g->errors.angle ? 0 : rules_out_filtered(g, left, right, apex, point);
}

static inline coordinate_pair point_at(const rings* g, int vertex) { return load_pair(&g->points[vertex]); }

// Merges above a base. Returns MERGE_IS_DONE, or the base at which it stopped, where a call can go on.
//
// It mostly waits: for memory, for predicates, and after wrong predictions of these. So the in-circle tests
// over a base compare angles, which are computed once and also tell which apexes rise above it. The side whose
// vertex stays keeps its candidate in registers.
static inline int merge_above(rings* g, int base) {
  RINGS_MEMORY const edge_in_rings* edges = g->edges;
  int left = edges[base].to, right = edges[base ^ 1].to;
  coordinate_pair left_point = point_at(g, left), right_point = point_at(g, right);
  int left_edge = edges[base ^ 1].next, right_edge = edges[base].previous;
  int left_to = edges[left_edge].to, right_to = edges[right_edge].to;
  coordinate_pair left_apex = point_at(g, left_to), right_apex = point_at(g, right_to);
  for (;;) {
    TALLY(*g, steps, 1);
    // Each side's candidate: the next edge that rises above the base, after removal of those that its circle rules out.
    real_pair left_seen = angle_products(left_apex, left_point, right_point);
    real_pair right_seen = angle_products(right_apex, left_point, right_point);
    const int left_rises = is_above(g, left_point, right_point, left_apex, left_seen);
    const int right_rises = is_above(g, left_point, right_point, right_apex, right_seen);
    if (HAS_STOPPED(g)) return base;
    if (!left_rises && !right_rises) break;
    if (left_rises) {
      for (int then = edges[left_edge].next; then != (base ^ 1); then = edges[left_edge].next) {
        const int beyond_to = edges[then].to;
        const coordinate_pair beyond = point_at(g, beyond_to);
        const real_pair seen = angle_products(beyond, left_point, right_point);
        if (!rules_out(g, left_point, right_point, left_apex, left_seen, beyond, seen)) break;
        TALLY(*g, steps, 1);
        remove_edge(g, left_edge);
        left_edge = then;
        left_to = beyond_to;
        left_apex = beyond;
        left_seen = seen;
      }
    }
    if (right_rises) {
      for (int then = edges[right_edge].previous; then != base; then = edges[right_edge].previous) {
        const int beyond_to = edges[then].to;
        const coordinate_pair beyond = point_at(g, beyond_to);
        const real_pair seen = angle_products(beyond, left_point, right_point);
        if (!rules_out(g, left_point, right_point, right_apex, right_seen, beyond, seen)) break;
        TALLY(*g, steps, 1);
        remove_edge(g, right_edge);
        right_edge = then;
        right_to = beyond_to;
        right_apex = beyond;
        right_seen = seen;
      }
    }
    const int takes_right = !left_rises || (right_rises && rules_out(g, left_point, right_point, left_apex, left_seen,
                                                                     right_apex, right_seen));
    if (HAS_STOPPED(g)) return base;
    if (takes_right) {
      const int from_apex = right_edge ^ 1, above_right = edges[from_apex].previous;
      right = right_to;
      right_point = right_apex;
      const int crossing = make_edge(g, right, left);
      join(g, above_right, crossing, from_apex);
      join(g, base ^ 1, crossing ^ 1, left_edge);
      right_edge = above_right;
      right_to = edges[right_edge].to;
      right_apex = point_at(g, right_to);
      base = crossing;
    } else {
      const int from_apex = left_edge ^ 1, above_left = edges[from_apex].next;
      left = left_to;
      left_point = left_apex;
      const int crossing = make_edge(g, right, left);
      join(g, right_edge, crossing, base);
      join(g, from_apex, crossing ^ 1, above_left);
      left_edge = above_left;
      left_to = edges[left_edge].to;
      left_apex = point_at(g, left_to);
      base = crossing;
    }
  }
  g->vertex_edge[right] = base;
  return MERGE_IS_DONE;
}

// Merges two triangulations that a cut across the axis separates. state: how far the merge is, which is also the
// result. both: the ends of the two.
static inline int continue_merge(rings* g, int state, hull_ends low, hull_ends high, hull_ends both, int axis) {
  g->errors = errors_between(g, both);
  const int base = state < 0 ? lower_tangent(g, last_along(low, axis), first_along(high, axis)) : state;
  return HAS_STOPPED(g) ? base : merge_above(g, base);
}
static inline hull_ends merge_triangulations(rings* g, hull_ends low, hull_ends high, int axis) {
  const hull_ends both = joined_ends(g, low, high, axis);
  continue_merge(g, MERGE_IS_NEW, low, high, both, axis);
  return both;
}
// The same of vertices in the order of axis 0 that meet between left and left + 1, whose ends are not known.
static inline void merge_in_order(rings* g, int left) {
  g->errors = unknown_errors();
  const int base = lower_tangent(g, left, left + 1);
  if (!HAS_STOPPED(g)) merge_above(g, base);
}

// How four vertices lie: three of them on a line, one inside of the triangle of the others, or none of that.
INTEGER_CONSTANT(FOUR_ARE_STRAIGHT, 0);
INTEGER_CONSTANT(FOUR_ARE_STAR, 1);
INTEGER_CONSTANT(FOUR_ARE_CONVEX, 2);

// How four vertices from v on lie, in the order of axis 0. q: for make_star or make_quadrilateral.
static inline int lie_of_four(rings* g, int v, int4* q) {
  const coordinate2 a = g->points[v], b = g->points[v + 1], c = g->points[v + 2], d = g->points[v + 3];
  // Sides of the line from a to d, on which b and c are: 1 is below.
  const int b_below = side_of(g, a, b, d), c_below = side_of(g, a, c, d);
  if (!b_below || !c_below) return FOUR_ARE_STRAIGHT;
  if (b_below != c_below) {
    *q = b_below < 0 ? VECTOR4(int4, v, v + 2, v + 3, v + 1) : VECTOR4(int4, v, v + 1, v + 3, v + 2);
    return FOUR_ARE_CONVEX;
  }
  const int at_b = side_of(g, a, b, c), at_c = side_of(g, b, c, d);
  if (!at_b || !at_c) return FOUR_ARE_STRAIGHT;
  if (at_b == b_below && at_c == b_below) {
    *q = b_below > 0 ? VECTOR4(int4, v, v + 1, v + 2, v + 3) : VECTOR4(int4, v, v + 3, v + 2, v + 1);
    return FOUR_ARE_CONVEX;
  }
  const int inside = at_b != b_below ? v + 1 : v + 2;
  const int corner = at_b != b_below ? v + 2 : v + 1;
  *q = b_below > 0 ? VECTOR4(int4, v, corner, v + 3, inside) : VECTOR4(int4, v, v + 3, corner, inside);
  return FOUR_ARE_STAR;
}

// Four vertices from v on, in the order of axis 0.
static inline void make_four(rings* g, int v) {
  int4 q = VECTOR4(int4, v, v + 1, v + 3, v + 2);
  const int lie = lie_of_four(g, v, &q);
  if (lie == FOUR_ARE_STRAIGHT) {
    make_pair(g, v);
    make_pair(g, v + 2);
    merge_in_order(g, v + 1);
  } else if (lie == FOUR_ARE_STAR) {
    make_star(g, q);
  } else {
    if (in_circle(g, g->points[q.x], g->points[q.y], g->points[q.z], g->points[q.w]))
      q = VECTOR4(int4, q.y, q.z, q.w, q.x);
    make_quadrilateral(g, q);
  }
}

// The ends of a leaf's hull.
static inline hull_ends ends_of_leaf(const rings* g, int v, int size) {
  int first = v, last = v;
  for (int w = v + 1; w < v + size; ++w) {
    if (precedes(g->points[w], g->points[first], 1)) first = w;
    if (precedes(g->points[last], g->points[w], 1)) last = w;
  }
  return ends_of(v, v + size - 1, first, last);
}

// One to four vertices from v on, in the order of axis 0.
static inline hull_ends make_leaf(rings* g, int v, int size) {
  if (size == 1) g->vertex_edge[v] = NO_EDGE;
  if (size == 2) make_pair(g, v);
  if (size == 3) make_three(g, v);
  if (size == 4) make_four(g, v);
  return ends_of_leaf(g, v, size);
}

END_SHARED

#endif
