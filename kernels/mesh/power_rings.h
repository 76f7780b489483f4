// Regular triangulations of weighted points as rings of edges: Guibas and Stolfi's merge (mesh/rings.h) with power
// tests (predicates/power.h), and without the vertices that the merge hides.
//
// Three things are new. On a line, the tangent may pass over vertices that it hides. A candidate may come to lie under
// the next base, inside of the triangle that was just made: it is hidden there, and its edges into the triangle go.
// And vertices that a merge has hidden may remain as disconnected pieces. A vertex that has lost an edge to a
// vertex of the seam is hidden if and only if no edge that crosses the seam ends at it: all triangles that the
// merge makes cross the seam, and they cover all that it removes. All vertices attached to it are hidden, too.
#ifndef FLAUNAY_POWER_RINGS_H
#define FLAUNAY_POWER_RINGS_H

#include "arithmetic/language.h"
#include "mesh/limits.h"
#include "mesh/records.h"
#include "mesh/rings.h"
#include "predicates/power.h"

#ifndef FIXED_POINT

BEGIN_SHARED

INTEGER_CONSTANT(NOT_IN_DOUBT, -2);

typedef struct {
  rings all;
  GLOBAL const double* weights;  // by vertex
  GLOBAL int* links;             // by vertex: the next one in doubt, NO_VERTEX at the end, or NOT_IN_DOUBT
  int in_doubt;                  // the first one
  double weight_range;           // the largest difference of weights
  double error;                  // of power determinants in the merge
} power_rings;

static inline power_rings power_rings_on(GLOBAL ring_edge* edges, GLOBAL const double2* points, GLOBAL int* vertex_edge,
                                         filter_bounds bounds, GLOBAL const double* vertex_weights, GLOBAL int* links,
                                         double weight_range) {
  power_rings g;
  g.all = rings_on(edges, points, vertex_edge, bounds);
  g.weights = vertex_weights;
  g.links = links;
  g.in_doubt = NO_VERTEX;
  g.weight_range = weight_range;
  g.error = INFINITY;
  return g;
}

static inline weighted_point weighted_at(const power_rings* g, int vertex) {
  const weighted_point p = {g->all.points[vertex], g->weights[vertex]};
  return p;
}

static inline void doubt(power_rings* g, int vertex) {
  if (g->links[vertex] != NOT_IN_DOUBT) return;
  g->links[vertex] = g->in_doubt;
  g->in_doubt = vertex;
}

static inline void take_out_or_hide(power_rings* g, int e, int origin) {
  if (g->all.edges[e].next == e) {
    g->all.vertex_edge[origin] = HIDDEN_VERTEX;
  } else {
    take_out(&g->all, e, origin);
  }
}

// Removes an edge out of a vertex of the seam, or of one that is hidden.
static inline void remove_power_edge(power_rings* g, int e) {
  const int to = g->all.edges[e].to, from = g->all.edges[e ^ 1].to;
  doubt(g, to);
  take_out_or_hide(g, e, from);
  take_out_or_hide(g, e ^ 1, to);
  free_edge(&g->all, e & ~1);
}

// Takes the vertices away that a merge has hidden. The vertices of its low side are those before `middle`.
static inline void remove_hidden(power_rings* g, int middle) {
  GLOBAL const ring_edge* edges = g->all.edges;
  while (g->in_doubt != NO_VERTEX) {
    const int v = g->in_doubt;
    g->in_doubt = g->links[v];
    g->links[v] = NOT_IN_DOUBT;
    const int first = g->all.vertex_edge[v];
    if (first == HIDDEN_VERTEX) continue;
    int is_crossing = 0, e = first;
    do {
      is_crossing = (edges[e].to < middle) != (v < middle);
      e = edges[e].next;
    } while (!is_crossing && e != first);
    while (!is_crossing && g->all.vertex_edge[v] != HIDDEN_VERTEX) remove_power_edge(g, g->all.vertex_edge[v]);
  }
}

static inline int is_left_of(power_rings* g, double2 a, double2 b, double2 c) {
  TALLY(g->all, orientations, 1);
  const double2 ca = a - c, cb = b - c;
  const double det = ca.x * cb.y - ca.y * cb.x;
  return det > g->all.errors.side ? 1 : det < -g->all.errors.side ? -1 : side_filtered(&g->all, a, b, c);
}

// Whether point p of a line through a and b is between them.
static inline int is_between(double2 a, double2 b, double2 p) {
  return a.x != b.x ? (a.x < p.x) == (p.x < b.x) && p.x != b.x && p.x != a.x
                    : (a.y < p.y) == (p.y < b.y) && p.y != b.y && p.y != a.y;
}

// Whether the tangent goes on from a vertex to the next one of its hull. side: on which this lies of the line between
// the vertices of both hulls, positive if below.
static inline int goes_on(power_rings* g, int side, int next, int vertex, int other) {
  if (side != 0) return side > 0;
  const weighted_point a = weighted_at(g, next), b = weighted_at(g, vertex), c = weighted_at(g, other);
  return is_between(a.at, c.at, b.at) && is_hidden_between(a, b, c);
}

// As lower_tangent; if the hulls have a common line, the edge that hides the hidden vertices on it.
static inline int lower_power_tangent(power_rings* g, int left, int right) {
  GLOBAL const ring_edge* edges = g->all.edges;
  GLOBAL const double2* points = g->all.points;
  int left_edge = g->all.vertex_edge[left], right_edge = g->all.vertex_edge[right];
  if (left_edge != NO_EDGE) left_edge = edges[left_edge].previous;
  for (int moves = 1; moves;) {
    TALLY(g->all, steps, 1);
    const int left_next = left_edge == NO_EDGE ? left : edges[left_edge].to;
    const int right_next = right_edge == NO_EDGE ? right : edges[right_edge].to;
    if (left_edge != NO_EDGE &&
        goes_on(g, is_left_of(g, points[right], points[left], points[left_next]), left_next, left, right)) {
      left = left_next;
      left_edge = edges[left_edge ^ 1].previous;
    } else if (right_edge != NO_EDGE &&
               goes_on(g, is_left_of(g, points[left], points[right_next], points[right]), right_next, right, left)) {
      right = right_next;
      right_edge = edges[right_edge ^ 1].next;
    } else {
      moves = 0;
    }
  }
  const int base = make_edge(&g->all, right, left);
  if (right_edge != NO_EDGE) insert_before(&g->all, base, right_edge);
  if (left_edge != NO_EDGE) insert_after(&g->all, base ^ 1, left_edge);
  g->all.vertex_edge[left] = base ^ 1;
  return base;
}

// A base, and the third vertex of the triangle below it; is_first if it is the first base.
typedef struct {
  int edge, is_first;
  weighted_point left, right;
  lifted_point seen;  // the right vertex from the left one
  int below_vertex;
  double2 below;
} power_base;

// A side's next edge, where it leads, and how the left vertex of the base sees that.
typedef struct {
  int edge, to;
  weighted_point apex;
  lifted_point seen;
} power_candidate;

static inline power_candidate power_candidate_at(const power_rings* g, const power_base* base, int edge) {
  power_candidate c;
  c.edge = edge;
  c.to = g->all.edges[edge].to;
  c.apex = weighted_at(g, c.to);
  c.seen = lifted_from(c.apex, base->left);
  return c;
}

static inline int power_side(power_rings* g, const power_base* base, const power_candidate* c) {
  TALLY(g->all, orientations, 1);
  const double det = base->seen.x * c->seen.y - base->seen.y * c->seen.x;
  return det > g->all.errors.side    ? 1
         : det < -g->all.errors.side ? -1
                                     : side_filtered(&g->all, base->left.at, base->right.at, c->apex.at);
}

// Whether the last of four points is below the plane through the others, which turn left.
OUT_OF_LINE static inline int is_below_plane(power_rings* g, weighted_point a, weighted_point b, weighted_point c,
                                             weighted_point d) {
  const int sign = power_filtered(a, b, c, d);
  if (sign != UNDECIDED) return sign > 0;
  ++g->all.undecided;
  return power_undecided(a, b, c, d, g->all.bounds) > 0;
}

// Whether a point rules out an apex above the base.
static inline int power_rules_out(power_rings* g, const power_base* base, const power_candidate* apex,
                                  const power_candidate* point) {
  TALLY(g->all, circles, 1);
  const double det = power_determinant(base->seen, apex->seen, point->seen);
  return det > g->error ? 1 : det < -g->error ? 0 : is_below_plane(g, base->left, base->right, apex->apex, point->apex);
}

// Whether a candidate that does not rise above the base is hidden below it: inside of the triangle there, or on the
// base. side: as power_side has it.
static inline int is_below_base(power_rings* g, const power_base* base, int is_right, int side,
                                const power_candidate* c) {
  if (side == 0) return is_between(base->left.at, base->right.at, c->apex.at);
  if (base->is_first || c->to == base->below_vertex) return 0;
  const double2 own = is_right ? base->right.at : base->left.at;
  const int turn = is_left_of(g, own, base->below, c->apex.at);
  return is_right ? turn < 0 : turn > 0;
}

static inline int beyond_edge(const power_rings* g, int e, int is_right) {
  return is_right ? g->all.edges[e].previous : g->all.edges[e].next;
}

// Finds a side's candidate; removes the edges before it. Returns 0 if the side has no candidate.
static inline int find_power_candidate(power_rings* g, const power_base* base, int is_right, power_candidate* found) {
  const int own = is_right ? base->edge : base->edge ^ 1;
  for (;;) {
    const int e = beyond_edge(g, own, is_right);
    if (e == own) return 0;
    *found = power_candidate_at(g, base, e);
    const int side = power_side(g, base, found);
    if (side > 0) break;
    if (!is_below_base(g, base, is_right, side, found)) return 0;
    remove_power_edge(g, e);
  }
  for (int then = beyond_edge(g, found->edge, is_right); then != own; then = beyond_edge(g, found->edge, is_right)) {
    const power_candidate beyond = power_candidate_at(g, base, then);
    if (!power_rules_out(g, base, found, &beyond)) break;
    TALLY(g->all, steps, 1);
    remove_power_edge(g, found->edge);
    *found = beyond;
  }
  return 1;
}

static inline void merge_power_above(power_rings* g, int edge) {
  GLOBAL const ring_edge* edges = g->all.edges;
  int left = edges[edge].to, right = edges[edge ^ 1].to;
  power_base base;
  base.is_first = 1;
  base.left = weighted_at(g, left);
  base.right = weighted_at(g, right);
  base.below = base.left.at;
  base.below_vertex = NO_VERTEX;
  base.edge = edge;
  for (;;) {
    TALLY(g->all, steps, 1);
    base.seen = lifted_from(base.right, base.left);
    power_candidate from_left, from_right;
    const int has_left = find_power_candidate(g, &base, 0, &from_left);
    const int has_right = find_power_candidate(g, &base, 1, &from_right);
    if (!has_left && !has_right) break;
    base.is_first = 0;
    if (!has_left || (has_right && power_rules_out(g, &base, &from_left, &from_right))) {
      const int from_apex = from_right.edge ^ 1, above_right = edges[from_apex].previous;
      const int above_left = edges[base.edge ^ 1].next;
      const int crossing = make_edge(&g->all, from_right.to, left);
      join(&g->all, above_right, crossing, from_apex);
      join(&g->all, base.edge ^ 1, crossing ^ 1, above_left);
      base.below = base.right.at;
      base.below_vertex = right;
      right = from_right.to;
      base.right = from_right.apex;
      base.edge = crossing;
    } else {
      const int from_apex = from_left.edge ^ 1, above_left = edges[from_apex].next;
      const int above_right = edges[base.edge].previous;
      const int crossing = make_edge(&g->all, right, from_left.to);
      join(&g->all, above_right, crossing, base.edge);
      join(&g->all, from_apex, crossing ^ 1, above_left);
      base.below = base.left.at;
      base.below_vertex = left;
      left = from_left.to;
      base.left = from_left.apex;
      base.edge = crossing;
    }
  }
  g->all.vertex_edge[right] = base.edge;
}

// Merges two triangulations that a cut across the axis separates, with vertices before `middle` and from there on.
static inline hull_ends merge_power_triangulations(power_rings* g, hull_ends low, hull_ends high, int axis,
                                                   int middle) {
  const hull_ends both = joined_ends(&g->all, low, high, axis);
  g->all.errors = errors_between(&g->all, both);
  const double width = g->all.points[both.last_x].x - g->all.points[both.first_x].x;
  const double height = g->all.points[both.last_y].y - g->all.points[both.first_y].y;
  const double squared = fmax(width, height) * fmax(width, height);
  // Three products of a cross product and a lift, and a little more for the rounding of these numbers.
  g->error = 1.0001 * POWER_BOUND * (3 * (2 * squared) * (2 * squared + g->weight_range));
  merge_power_above(g, lower_power_tangent(g, last_along(low, axis), first_along(high, axis)));
  remove_hidden(g, middle);
  return both;
}

// Makes a leaf of three or four vertices if that needs no merge: if none is hidden, and none on a line with others.
static inline int make_without_merge(power_rings* g, int v, int size) {
  if (size == 3) {
    const int turns = side_of(&g->all, g->all.points[v], g->all.points[v + 1], g->all.points[v + 2]) != 0;
    if (turns) make_three(&g->all, v);
    return turns;
  }
  int4 q = VECTOR4(int4, v, v, v, v);
  const int lie = lie_of_four(&g->all, v, &q);
  if (lie == FOUR_ARE_STRAIGHT) return 0;
  TALLY(g->all, circles, 1);
  const int is_below =
      is_below_plane(g, weighted_at(g, q.x), weighted_at(g, q.y), weighted_at(g, q.z), weighted_at(g, q.w));
  if (lie == FOUR_ARE_STAR) {
    if (is_below) make_star(&g->all, q);
    return is_below;
  }
  make_quadrilateral(&g->all, is_below ? VECTOR4(int4, q.y, q.z, q.w, q.x) : q);
  return 1;
}

// One or two vertices from v on, in the order of axis 0.
static inline hull_ends make_power_pair(power_rings* g, int v, int size) {
  if (size == 1) g->all.vertex_edge[v] = NO_EDGE;
  if (size == 2) make_pair(&g->all, v);
  return ends_of_leaf(&g->all, v, size);
}

// One to four vertices from v on, in the order of axis 0.
static inline hull_ends make_power_leaf(power_rings* g, int v, int size) {
  for (int w = v; w < v + size; ++w) g->links[w] = NOT_IN_DOUBT;
  if (size <= 2) return make_power_pair(g, v, size);
  if (make_without_merge(g, v, size)) return ends_of_leaf(&g->all, v, size);
  const int middle = v + size / 2;
  const hull_ends low = make_power_pair(g, v, middle - v), high = make_power_pair(g, middle, v + size - middle);
  return merge_power_triangulations(g, low, high, 0, middle);
}

END_SHARED

#endif

#endif
