// Natural-neighbour interpolation: Sibson's weights ("A brief description of natural neighbour interpolation", 1981),
// and Laplace's (Belikov et al., 1997; Hiyoshi and Sugihara, 1999).
//
// If the query q were a point, its Voronoi cell would take a piece from the cell of each of its neighbours. Sibson's
// weight of a neighbour is the area of that piece, Laplace's is the length of the edge between both cells over the
// distance of both points; both by their sum.
//
// The triangles whose circles have q strictly inside are the cavity of q. It contains no vertex, so that its triangles
// form a tree, and each of its boundary's vertices is a neighbour of q. A walk goes around the boundary. At each vertex
// v it rotates through the cavity's triangles that have v as a corner. Their circumcentres are the corners of the piece
// of v, except for the first and the last corner, which are circumcentres of q, v and a neighbour of v on the
// boundary. So the walk needs no memory for any number of neighbours. It takes three steps per triangle.
//
// The piece of v is cut into triangles by diagonals from its first corner A, the centre of the circle through q, p and
// v, where p comes before v on the boundary. For an edge from v to u, with a triangle on either side, the distance of
// the circumcentres of both is |v u| / 2 times the sum of the cotangents of the angles opposite to the edge, and A is
// (|A - u|^2 - |A - v|^2) / (2 |v u|) away from the line through them. The second numerator is the in-circle
// determinant of q, p, v and u over twice the area of q, p and v. No square root is needed, and no term is negative.
//
// Each query is one work-item. Values take two passes:
// 1. interpolate_natural decides and computes in floating point, with bounds of all errors. If a test is not decided,
//    or the weights are not certain to NATURAL_ERROR, it leaves the query to the second pass.
// 2. interpolate_natural_exactly decides exactly. It multiplies and adds positive numbers with small relative errors
//    alone, which interpolate/determinants.h computes, so that its weights have small relative errors, whatever the
//    points.
// docs/exactness.md has the bounds.

#include "arithmetic/coordinates.h"
#include "interpolate/arguments.h"
#include "interpolate/determinants.h"
#include "interpolate/weights.h"
#include "locate/arguments.h"
#include "locate/records.h"
#include "mesh/halfedges.h"
#include "mesh/records.h"
#include "operations/prefetch.h"
#include "operations/search.h"
#include "points/records.h"

// A triangulation, as locators have it, and how much more the queries of its set are scaled. source: the points that
// vertices are.
typedef struct {
  global const double2* points;
  global const int* source;
  global const face* faces;
  double unit;
} natural_mesh;

// ---------------------------------------------------------------------------------------------------------------------
// What becomes of the weights

typedef struct {
  int columns, is_by_vertex;
  global const double* values;  // a row per point, or per vertex
  global double* row;           // of values; without columns the weights themselves, as many as there is room for
  global int* neighbors;
  int room, count;
} receiver;

static inline void give(receiver* to, natural_mesh mesh, int vertex, double weight) {
  if (to->columns == 0) {
    if (to->count < to->room) {
      to->neighbors[to->count] = mesh.source[vertex];
      to->row[to->count] = weight;
    }
    ++to->count;
    return;
  }
  global const double* row = to->values + (size_t)(to->is_by_vertex ? vertex : mesh.source[vertex]) * to->columns;
  for (int c = 0; c < to->columns; ++c) to->row[c] += weight * row[c];
}

static inline void clear_row(receiver* to, double value) {
  to->count = 0;
  for (int c = 0; c < to->columns; ++c) to->row[c] = value;
}

// Divides the numbers that the receiver has got by the sum of the weights.
static inline void divide_by(receiver* to, double sum) {
  const int numbers = to->columns == 0 ? min(to->count, to->room) : to->columns;
  for (int c = 0; c < numbers; ++c) to->row[c] /= sum;
}

// ---------------------------------------------------------------------------------------------------------------------
// Weights that are known without a walk

// How attempts end: ASTRAY, if the mesh is no Delaunay triangulation.
#define WEIGHED 1
#define ASTRAY -1

static inline double2 place_of(natural_mesh mesh, int vertex) { return mesh.unit * mesh.points[vertex]; }

// At a vertex, and on an edge of the hull, where both methods tend to the linear
// interpolation between its ends. Returns 0 if q lies on neither, UNDECIDED, or WEIGHED.
static inline int weigh_on_hull(natural_mesh mesh, double2 q, int start, int exactly, receiver* to) {
  const face f = mesh.faces[start];
  for (int k = 0; k < 3; ++k) {
    const double2 at = place_of(mesh, f.corner[k]);
    if (at.x == q.x && at.y == q.y) {
      give(to, mesh, f.corner[k], 1.0);
      return WEIGHED;
    }
  }
  for (int k = 0; k < 3; ++k) {
    if (f.neighbor[k] >= 0) continue;
    const int from = f.corner[next_corner(k)], to_vertex = f.corner[corner_before(k)];
    const double2 a = place_of(mesh, from), b = place_of(mesh, to_vertex);
    const int side = exactly ? orient_sign(a, b, q, ORIENT_BOUND) : orient_filtered(a, b, q, ORIENT_BOUND);
    if (side == UNDECIDED) return UNDECIDED;
    if (side != 0) continue;
    const int along_x = fabs(b.x - a.x) >= fabs(b.y - a.y);
    const double behind = fabs(along_x ? q.x - a.x : q.y - a.y), ahead = fabs(along_x ? b.x - q.x : b.y - q.y);
    give(to, mesh, from, ahead / (behind + ahead));
    give(to, mesh, to_vertex, behind / (behind + ahead));
    return WEIGHED;
  }
  return 0;
}

// ---------------------------------------------------------------------------------------------------------------------
// Weights in floating point

// A vertex as the query sees it: the square of its distance, and |x| + |y|.
typedef struct {
  double2 at;
  double lift, reach;
  int vertex;
} sight;

static inline sight see(natural_mesh mesh, double2 q, int vertex) {
  sight seen;
  seen.vertex = vertex;
  seen.at = place_of(mesh, vertex) - q;
  seen.lift = squared_length(seen.at);
  seen.reach = fabs(seen.at.x) + fabs(seen.at.y);
  return seen;
}

// The in-circle determinant of q and a triangle, twice the triangle's area, and the sums of their terms' magnitudes.
typedef struct {
  double det, det_magnitude, area, area_magnitude;
} seen_circle;

static inline seen_circle circle_through(sight a, sight b, sight c) {
  const double bc = b.at.x * c.at.y;
  const double cb = c.at.x * b.at.y;
  const double ca = c.at.x * a.at.y;
  const double ac = a.at.x * c.at.y;
  const double ab = a.at.x * b.at.y;
  const double ba = b.at.x * a.at.y;
  const double at_a = bc - cb, at_b = ca - ac, at_c = ab - ba;
  const double most_a = fabs(bc) + fabs(cb), most_b = fabs(ca) + fabs(ac), most_c = fabs(ab) + fabs(ba);
  const seen_circle seen = {a.lift * at_a + b.lift * at_b + c.lift * at_c,
                            most_a * a.lift + most_b * b.lift + most_c * c.lift, at_a + at_b + at_c,
                            most_a + most_b + most_c};
  return seen;
}

// The centre of a circle, as seen from the query: |x| + |y|, and a bound of the sum of both errors, in units of
// ROUNDOFF.
typedef struct {
  double2 at;
  double reach, error;
} centre;

// Centres farther away, and triangles that are more slender, are left to the exact pass. Within these bounds nothing
// overflows, underflows do not matter, and errors of the second order are small.
#define LARGEST_REACH 0x1p300
#define LEAST_WEIGHTS 0x1p-700
#define MOST_SLENDER 0x1p30

// A query's sums: of the weights, and of the bounds of their errors. steps: the number of terms. unit: a power
// of two that brings weights, but not errors, to about 1, so that products with values do not underflow.
typedef struct {
  double weights, errors, unit;
  int steps, is_sound;
} estimate;

// by: the centre times twice the area, in both coordinates; magnitude: the sum of all its terms' magnitudes.
static inline centre centre_by(double2 by, double magnitude, double area, double area_magnitude, estimate* all) {
  const double inverse = 0.5 / area;
  const double slenderness = 2.0 * inverse * area_magnitude;
  const double length = fabs(by.x) + fabs(by.y);
  centre result;
  result.at = inverse * by;
  result.reach = inverse * length;
  result.error = inverse * (10.0 * magnitude + (7.0 * slenderness + 10.0) * length);
  all->is_sound &= (result.reach < LARGEST_REACH) & (slenderness < MOST_SLENDER) & (area > 0.0);
  return result;
}

static inline centre centre_of_triangle(seen_circle seen, sight a, sight b, sight c, estimate* all) {
  const double2 by =
      VECTOR(double2, a.lift * (b.at.y - c.at.y) + b.lift * (c.at.y - a.at.y) + c.lift * (a.at.y - b.at.y),
             a.lift * (c.at.x - b.at.x) + b.lift * (a.at.x - c.at.x) + c.lift * (b.at.x - a.at.x));
  const double magnitude = a.lift * (b.reach + c.reach) + b.lift * (c.reach + a.reach) + c.lift * (a.reach + b.reach);
  return centre_by(by, magnitude, seen.area, seen.area_magnitude, all);
}

// The centre of the circle through the query and an edge's ends.
static inline centre centre_of_edge(sight a, sight b, estimate* all) {
  const double ab = a.at.x * b.at.y, ba = a.at.y * b.at.x;
  const double2 by = VECTOR(double2, a.lift * b.at.y - b.lift * a.at.y, b.lift * a.at.x - a.lift * b.at.x);
  return centre_by(by, a.lift * b.reach + b.lift * a.reach, ab - ba, fabs(ab) + fabs(ba), all);
}

// A piece of a cell, clockwise from corner to corner: twice its area so far, and its last corner.
typedef struct {
  double area;
  centre last;
} piece;

static inline void go_to(piece* around, centre next, estimate* all) {
  const centre last = around->last;
  around->area += next.at.x * last.at.y - next.at.y * last.at.x;
  around->last = next;
  all->errors += next.error * last.reach + next.reach * last.error;
  ++all->steps;
}

// The weight of v, from one corner of the query's cell to the next one.
static inline double laplace_weight(sight v, centre from, centre to, estimate* all) {
  const double2 along = to.at - from.at;
  const double inverse = 1.0 / v.lift;
  all->errors += (from.error + to.error) * v.reach * inverse;
  ++all->steps;
  return (v.at.x * along.y - v.at.y * along.x) * inverse;
}

static inline void give_estimate(receiver* to, natural_mesh mesh, sight v, double weight, estimate* all) {
  const double positive = max(weight, 0.0) * all->unit;
  all->weights += positive;
  give(to, mesh, v.vertex, positive);
}

// A triangle of the cavity that the walk has entered: its centre, and its last edge, which leads to a vertex and has
// another triangle beyond. is_open: whether that edge still is to be crossed.
typedef struct {
  centre middle;
  sight to;
  int triangle, beyond, is_open;
} entered;

// Field by field: copies of whole structs wait for parts of them to be stored.
static inline void enter(entered* top, centre middle, sight to, int triangle, int beyond) {
  top->middle.at.x = middle.at.x;
  top->middle.at.y = middle.at.y;
  top->middle.reach = middle.reach;
  top->middle.error = middle.error;
  top->to.at.x = to.at.x;
  top->to.at.y = to.at.y;
  top->to.lift = to.lift;
  top->to.reach = to.reach;
  top->to.vertex = to.vertex;
  top->triangle = triangle;
  top->beyond = beyond;
  top->is_open = 1;
}

// Cavities with longer paths are left to the exact pass.
#define MOST_ENTERED 24

// Goes around the cavity of q, which lies in triangle `start`, but not on the hull nor at a vertex. Triangles that the
// walk is in, from `start` on, are kept, so that each is tested once. A piece takes the centres of the triangles that
// the walk is in while it is at a vertex. Gives weights; *all has their sum. Returns WEIGHED or UNDECIDED.
static inline int estimate_weights(natural_mesh mesh, double2 q, int start, int method, estimate* all, receiver* to) {
  entered path[MOST_ENTERED];
  const face f = mesh.faces[start];
  // The edge from x to y, which has triangle t on its left and u beyond.
  sight x = see(mesh, q, f.corner[0]), y = see(mesh, q, f.corner[1]);
  const sight first = x, third = see(mesh, q, f.corner[2]);
  const int is_sibson = method == SIBSON;
  if (is_sibson) {
    const double largest = max(x.lift, max(y.lift, third.lift));
    all->unit = power_of_two(1023 - (int)(as_ulong(largest) >> 52));
  }
  int t = start, u = f.neighbor[2], depth = 1;
  const centre middle = centre_of_triangle(circle_through(x, y, third), x, y, third, all);
  enter(&path[0], middle, first, start, f.neighbor[1]);
  enter(&path[1], middle, third, start, f.neighbor[0]);
  // The piece of the first vertex is in two parts, as the walk begins inside of it.
  piece around = {0.0, middle};
  centre before = around.last, first_after = before;
  double first_area = 0.0;
  int is_first = 1;
  while (depth >= 0) {
    if (u >= 0) {
      const face g = mesh.faces[u];
      const int j = corner_opposite(g, t);
      const sight d = see(mesh, q, g.corner[j]);
      const seen_circle seen = circle_through(y, x, d);
      if (!(fabs(seen.det) > CIRCLE_BOUND * seen.det_magnitude)) return UNDECIDED;
      if (seen.det > 0.0) {
        if (++depth == MOST_ENTERED) return UNDECIDED;
        centre inside = middle;
        if (is_sibson) {
          inside = centre_of_triangle(seen, y, x, d, all);
          go_to(&around, inside, all);
        }
        enter(&path[depth], inside, y, u, g.neighbor[corner_before(j)]);
        y = d;
        t = u;
        u = g.neighbor[next_corner(j)];
        continue;
      }
    }
    // On the boundary: x is done, but for the first time.
    const centre after = centre_of_edge(x, y, all);
    if (is_sibson) go_to(&around, after, all);
    if (is_first) {
      first_after = after;
      first_area = around.area;
      is_first = 0;
    } else if (is_sibson) {
      go_to(&around, before, all);
      give_estimate(to, mesh, x, around.area, all);
    } else {
      give_estimate(to, mesh, x, laplace_weight(x, before, after, all), all);
    }
    before = after;
    around.area = 0.0;
    around.last = after;
    x = y;
    if (is_sibson) go_to(&around, path[depth].middle, all);
    while (depth >= 0 && !path[depth].is_open) {
      if (--depth >= 0 && is_sibson) go_to(&around, path[depth].middle, all);
    }
    if (depth >= 0) {
      path[depth].is_open = 0;
      y = path[depth].to;
      u = path[depth].beyond;
      t = path[depth].triangle;
    }
  }
  if (is_sibson) {
    around.last = first_after;
    go_to(&around, before, all);
    give_estimate(to, mesh, first, around.area + first_area, all);
  } else {
    give_estimate(to, mesh, first, laplace_weight(first, before, first_after, all), all);
  }
  return WEIGHED;
}

// Returns WEIGHED, or UNDECIDED if the weights are not certain.
static inline int weigh_by_estimate(natural_mesh mesh, double2 q, int start, int method, receiver* to) {
  const int on_hull = weigh_on_hull(mesh, q, start, 0, to);
  if (on_hull != 0) return on_hull;
  estimate all = {0.0, 0.0, 1.0, 0, 1};
  const int outcome = estimate_weights(mesh, q, start, method, &all, to);
  const double errors = all.errors * (1.0 + 0.125 * all.steps) * all.unit;
  if (outcome != WEIGHED || !all.is_sound || !(all.weights > LEAST_WEIGHTS * all.unit) ||
      !(errors <= NATURAL_ERROR / (2.0 * ROUNDOFF) * all.weights)) {
    return UNDECIDED;
  }
  divide_by(to, all.weights);
  return WEIGHED;
}

// ---------------------------------------------------------------------------------------------------------------------
// Weights with small relative errors

// A number that may be no double: mantissa * 2^exponent; 0 has the smallest exponent.
typedef struct {
  double mantissa;
  int exponent;
} wide;

#define NO_EXPONENT -100000

static inline wide widened_double(double x) {
  const uint64 bits = as_ulong(fabs(x));
  wide number = {0.0, NO_EXPONENT};
  if (bits != 0) {
    number.exponent = (int)(bits >> 52) - 1023;
    number.mantissa = as_double((bits & 0xfffffffffffffUL) | 0x3ff0000000000000UL);
  }
  return number;
}

static inline wide wide_product(wide a, wide b) {
  const wide product = {a.mantissa * b.mantissa, a.exponent + b.exponent};
  return product;
}

static inline wide wide_quotient(wide a, wide b) {
  const wide quotient = {a.mantissa / b.mantissa, a.exponent - b.exponent};
  return quotient;
}

// a / b as a double, 0 if it is tiny.
static inline double narrow_quotient(wide a, wide b) {
  const int exponent = a.exponent - b.exponent;
  return exponent < -1000 ? 0.0 : a.mantissa / b.mantissa * power_of_two(min(exponent, 1000));
}

static inline wide wide_sum(wide a, wide b) {
  const int is_larger = a.exponent >= b.exponent;
  const int exponent = is_larger ? a.exponent : b.exponent;
  const int below = is_larger ? b.exponent - exponent : a.exponent - exponent;
  const double small = below < -1000 ? 0.0 : (is_larger ? b.mantissa : a.mantissa) * power_of_two(below);
  const wide sum = {(is_larger ? a.mantissa : b.mantissa) + small, exponent};
  return sum;
}

static inline wide wide_area(double2 a, double2 b, double2 c) { return widened_double(orient_value(a, b, c)); }
static inline wide wide_circle(double2 a, double2 b, double2 c, double2 d) {
  return widened_double(circle_value(a, b, c, d));
}

// The triangle of a piece between the centres on both sides of the edge from v to c: behind are a and an area, before
// are d, which is q at the last edge, and an area. p comes before v on the boundary.
static inline wide wide_term(double2 q, double2 p, double2 v, double2 c, double2 a, double2 d, wide behind,
                             wide before) {
  const wide across = wide_circle(v, c, a, d), height = wide_circle(p, v, c, q);
  return wide_quotient(wide_product(across, height), wide_product(behind, before));
}

// ---------------------------------------------------------------------------------------------------------------------
// The walk that needs no memory

// A vertex with its place.
typedef struct {
  int vertex;
  double2 at;
} corner_point;

static inline corner_point point_at(natural_mesh mesh, int vertex) {
  const corner_point point = {vertex, place_of(mesh, vertex)};
  return point;
}

static inline int is_inside(corner_point a, corner_point b, corner_point c, double2 q) {
  return circle_sign(a.at, b.at, c.at, q, CIRCLE_BOUND) > 0;
}

// Where the walk is: at corner k of triangle t, v; counter-clockwise the others are c and a.
typedef struct {
  int t, k;
  face f;
  corner_point v, c, a;
} stand;

// Goes backwards around v, to an edge of the cavity's boundary. Returns whether there is one.
static inline int find_boundary(natural_mesh mesh, double2 q, stand* at, int* steps) {
  for (;;) {
    const int u = at->f.neighbor[next_corner(at->k)];
    if (u < 0) return 1;
    const face g = mesh.faces[u];
    const int j = corner_opposite(g, at->t);
    const corner_point d = point_at(mesh, g.corner[j]);
    if (!is_inside(at->v, at->a, d, q)) return 1;
    if (--*steps < 0) return 0;
    at->c = at->a;
    at->a = d;
    at->f = g;
    at->t = u;
    at->k = next_corner(j);
  }
}

// From the edge of the boundary that leads to v on to the one that leaves it, over the triangles between. Returns
// whether there is one. part: gets the weight of v.
static inline int weigh_exactly_at(natural_mesh mesh, double2 q, int method, stand* at, int* steps, wide* part) {
  const double2 p = at->a.at, v = at->v.at;
  wide behind = {0.0, NO_EXPONENT};
  *part = behind;
  if (method == SIBSON) behind = wide_area(v, at->c.at, at->a.at);
  for (;;) {
    if (--*steps < 0) return 0;
    const int u = at->f.neighbor[corner_before(at->k)];
    if (u < 0) break;
    const face g = mesh.faces[u];
    const int j = corner_opposite(g, at->t);
    const corner_point d = point_at(mesh, g.corner[j]);
    if (!is_inside(at->c, at->v, d, q)) break;
    if (method == SIBSON) {
      const wide before = wide_area(v, d.at, at->c.at);
      *part = wide_sum(*part, wide_term(q, p, v, at->c.at, at->a.at, d.at, behind, before));
      behind = before;
    }
    at->a = at->c;
    at->c = d;
    at->f = g;
    at->t = u;
    at->k = corner_before(j);
  }
  const double2 c = at->c.at;
  if (method == SIBSON) {
    *part = wide_sum(*part, wide_term(q, p, v, c, at->a.at, q, behind, wide_area(q, v, c)));
    *part = wide_quotient(*part, wide_area(q, p, v));
  } else {
    *part = wide_quotient(wide_circle(q, p, v, c), wide_product(wide_area(q, p, v), wide_area(q, v, c)));
  }
  return 1;
}

// Goes around the cavity of q, which lies in triangle `start`, but not on the hull nor at a vertex. gives: whether
// weights are given; `whole` is then their sum; sum: set to that sum. Returns WEIGHED, or ASTRAY after `steps`
// steps, which happens only if the mesh is no Delaunay triangulation.
static inline int walk_exactly(natural_mesh mesh, double2 q, int start, int steps, int method, int gives, wide whole,
                               wide* sum, receiver* to) {
  stand at;
  at.t = start;
  at.k = 0;
  at.f = mesh.faces[start];
  at.v = point_at(mesh, at.f.corner[0]);
  at.c = point_at(mesh, at.f.corner[1]);
  at.a = point_at(mesh, at.f.corner[2]);
  if (!find_boundary(mesh, q, &at, &steps)) return ASTRAY;
  const int first = at.v.vertex, first_triangle = at.t;
  do {
    const int vertex = at.v.vertex;
    wide part;
    if (!weigh_exactly_at(mesh, q, method, &at, &steps, &part)) return ASTRAY;
    *sum = wide_sum(*sum, part);
    if (gives) give(to, mesh, vertex, narrow_quotient(part, whole));
    const corner_point apex = at.a;
    at.a = at.v;
    at.v = at.c;
    at.c = apex;
    at.k = next_corner(at.k);
  } while (at.v.vertex != first || at.t != first_triangle);
  return WEIGHED;
}

// The walk takes three steps per triangle, and once more those around the first vertex.
static inline int most_steps(int triangles) { return (int)min((int64)INT_MAX, (int64)4 * triangles); }

// One walk for the sum of the weights, and one for the weights. triangles: of the query's set. Returns WEIGHED or
// ASTRAY.
static inline int weigh_exactly(natural_mesh mesh, double2 q, int start, int triangles, int method, receiver* to) {
  if (weigh_on_hull(mesh, q, start, 1, to) == WEIGHED) return WEIGHED;
  const int steps = most_steps(triangles);
  const wide none = {0.0, NO_EXPONENT};
  wide whole = none, again = none;
  if (walk_exactly(mesh, q, start, steps, method, 0, none, &whole, to) != WEIGHED) return ASTRAY;
  return walk_exactly(mesh, q, start, steps, method, 1, whole, &again, to);
}

// ---------------------------------------------------------------------------------------------------------------------
// Values

static inline int set_of_query(int place, int sets, global const int* query_offsets) {
  return sets > 1 ? segment_of(place, sets, query_offsets) : 0;
}

// How many queries ahead of its use a triangle is fetched; its corners and neighbours half as far ahead.
#define QUERIES_AHEAD 16

static inline void fetch_query(int i, int n, global const int* found, global const face* faces,
                               global const double2* points) {
#if FETCH_AHEAD
  fetch(&faces[max(0, found[min(i + QUERIES_AHEAD, n - 1)])]);
  const face f = faces[max(0, found[min(i + QUERIES_AHEAD / 2, n - 1)])];
  for (int k = 0; k < 3; ++k) {
    fetch(&points[f.corner[k]]);
    fetch(&faces[max(0, f.neighbor[k])]);
  }
#endif
}

// Sorts rows of values from the order of points to the order of vertices, which keeps neighbours close in
// memory.
kernel void place_values(int n, int sets, int columns, global const int* restrict first_vertices,
                         global const int* restrict source, global const double* restrict values,
                         global double* restrict placed) {
  const int v = get_global_id(0);
  if (v < n && v < first_vertices[sets]) {
    for (int c = 0; c < columns; ++c) placed[(size_t)v * columns + c] = values[(size_t)source[v] * columns + c];
  }
}

// n queries in order of places; found: their triangles, less than 0 outside of the hull. Values are rows of
// `columns` numbers by point or by vertex, results by query. left: whether a query, by place, is left to
// interpolate_natural_exactly.
kernel void interpolate_natural(int n, PLACED_QUERIES(), int columns, int is_by_vertex, int method, double outside,
                                FACES(), global const int* restrict found, global const double* restrict values,
                                global double* restrict results, global uchar* restrict left) {
  const int i = get_global_id(0);
  if (i < n) {
    fetch_query(i, n, found, faces, points);
    const int s = set_of_query(i, sets, query_offsets);
    const natural_mesh mesh = {points, source, faces, frames[s].unit};
    receiver to = {columns, is_by_vertex, values, results + (size_t)order[i] * columns, 0, 0, 0};
    int outcome = WEIGHED;
    if (found[i] >= 0) {
      clear_row(&to, 0.0);
      outcome = weigh_by_estimate(mesh, placed[i], found[i], method, &to);
    } else {
      clear_row(&to, outside);
    }
    left[i] = outcome != WEIGHED;
  }
}

kernel void interpolate_natural_exactly(int n, PLACED_QUERIES(), int columns, int is_by_vertex, int method,
                                        double outside, global const mesh_set* restrict records, FACES(),
                                        global const int* restrict found, global const double* restrict values,
                                        global const uchar* restrict left, global double* restrict results) {
  const int i = get_global_id(0);
  if (i < n && left[i]) {
    const int s = set_of_query(i, sets, query_offsets);
    const natural_mesh mesh = {points, source, faces, frames[s].unit};
    receiver to = {columns, is_by_vertex, values, results + (size_t)order[i] * columns, 0, 0, 0};
    clear_row(&to, 0.0);
    if (weigh_exactly(mesh, placed[i], found[i], records[s].triangles, method, &to) != WEIGHED) {
      clear_row(&to, outside);
    }
  }
}

// Writes the neighbours of each query and their weights from firsts[query] on, as many as there is room for before that
// of the next query, and how many there are to counts.
kernel void list_natural(int n, PLACED_QUERIES(), int method, global const mesh_set* restrict records, FACES(),
                         global const int* restrict found, global const int* restrict firsts,
                         global int* restrict counts, global int* restrict neighbors, global double* restrict weights) {
  const int i = get_global_id(0);
  if (i < n) {
    fetch_query(i, n, found, faces, points);
    const int s = set_of_query(i, sets, query_offsets), q = order[i];
    const natural_mesh mesh = {points, source, faces, frames[s].unit};
    receiver to = {0, 0, 0, weights + firsts[q], neighbors + firsts[q], firsts[q + 1] - firsts[q], 0};
    if (found[i] >= 0 && weigh_by_estimate(mesh, placed[i], found[i], method, &to) != WEIGHED) {
      clear_row(&to, 0.0);
      if (weigh_exactly(mesh, placed[i], found[i], records[s].triangles, method, &to) != WEIGHED) clear_row(&to, 0.0);
    }
    counts[q] = to.count;
  }
}
