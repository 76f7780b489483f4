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
// of v, except for the first one and the last one, which are those of q, v and a neighbour of v on the boundary. So the
// walk needs no memory, whatever the number of neighbours. It takes three steps per triangle of the cavity.
//
// The piece of v is cut into triangles by diagonals from its first corner A, the centre of the circle through q, p and
// v, where p comes before v on the boundary. For an edge from v to u, with a triangle on either side, the distance of
// the circumcentres of both is |v u| / 2 times the sum of the cotangents of the angles opposite to the edge, and A is
// (|A - u|^2 - |A - v|^2) / (2 |v u|) away from the line through them. The second numerator is the in-circle
// determinant of q, p, v and u over twice the area of q, p and v. No square root is needed, and no term is negative.
//
// Each query is one work-item. Values take two passes:
// 1. interpolate_natural decides and computes in floating point, with bounds of all errors. If a test is not decided,
// or
//    the weights are not certain to NATURAL_ERROR, it leaves the query to the second pass.
// 2. interpolate_natural_exactly decides exactly. It multiplies and adds positive numbers with small relative errors
//    alone, which shared/determinants.h computes, so that its weights have small relative errors, whatever the points.
// docs/exactness.md has the bounds. Lists of neighbours with weights take count_neighbors and, after a scan of the
// counts, list_neighbors. Each does both for its query, one after the other.

#include "shared/coordinates.h"
#include "shared/determinants.h"
#include "shared/halfedges.h"
#include "shared/natural.h"
#include "shared/records.h"
#include "shared/search.h"

// A triangulation, as locators have it, and how much more the queries of its set are scaled.
typedef struct {
  global const double2* points;
  global const int* source;
  global const face* faces;
  double unit;
} natural_mesh;

// A vertex as the query sees it: also its difference from the query, and the square of its distance.
typedef struct {
  int vertex;
  double2 at, from;
  double lift;
} sight;

static inline sight see(natural_mesh mesh, double2 q, int vertex) {
  sight seen;
  seen.vertex = vertex;
  seen.at = mesh.unit * mesh.points[vertex];
  seen.from = seen.at - q;
  seen.lift = squared_length(seen.from);
  return seen;
}

// Whether q lies inside the circle through a, b, c, which turn left: as circle_sign, or UNDECIDED.
static inline int has_inside(sight a, sight b, sight c, double2 q, int exactly) {
  const double2 det = circle_determinant(a.from, b.from, c.from, a.lift, b.lift, c.lift);
  const int sign = filtered_sign(det.x, CIRCLE_BOUND * det.y, CIRCLE_BOUND);
  return sign == UNDECIDED && exactly ? circle_undecided(a.at, b.at, c.at, q, CIRCLE_BOUND) : sign;
}

// ---------------------------------------------------------------------------------------------------------------------
// What becomes of the weights

typedef struct {
  int count;                    // of the neighbours so far
  int columns;                  // TO_VALUES
  global const double* values;  // a row per point
  global double* row;
  global int* neighbors;  // TO_LIST
  global double* weights;
} receiver;

#define TO_NOTHING 0
#define TO_VALUES 1
#define TO_LIST 2

static inline void give(receiver* to, int what, int point, double weight) {
  if (what == TO_VALUES) {
    global const double* row = to->values + (size_t)point * to->columns;
    for (int c = 0; c < to->columns; ++c) to->row[c] += weight * row[c];
  } else if (what == TO_LIST) {
    to->neighbors[to->count] = point;
    to->weights[to->count] = weight;
  }
  ++to->count;
}

static inline void clear_row(receiver* to, double value) {
  for (int c = 0; c < to->columns; ++c) to->row[c] = value;
}

// What the receiver has got by the sum of the weights.
static inline void divide_by(receiver* to, int what, double sum) {
  if (what == TO_VALUES) {
    for (int c = 0; c < to->columns; ++c) to->row[c] /= sum;
  } else if (what == TO_LIST) {
    for (int k = 0; k < to->count; ++k) to->weights[k] /= sum;
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Weights in floating point

// Numbers beyond these, and triangles that are more slender, are left to the exact pass. Within them nothing overflows,
// underflows do not matter, and errors of the second order are small.
#define LARGEST_LIFT 0x1p200
#define SMALLEST_AREA 0x1p-200
#define MOST_SLENDER 0x1p30

// A query's sums: of the weights, and of what bounds their errors. square and fourth bring areas, and squares of them,
// to about 1.
typedef struct {
  double weights, errors, square, fourth;
  int is_sound;
} estimate;

// Twice an area, and the sum of its terms' magnitudes.
static inline double2 cross_of(double2 a, double2 b) {
  const double left = a.x * b.y;
  const double right = a.y * b.x;
  return VECTOR(double2, left - right, fabs(left) + fabs(right));
}

static inline double2 dot_of(double2 a, double2 b) {
  const double first = a.x * b.x;
  const double second = a.y * b.y;
  return VECTOR(double2, first + second, fabs(first) + fabs(second));
}

static inline int is_sound_area(double2 area, double square) {
  return (area.x * square > SMALLEST_AREA) & (area.y <= MOST_SLENDER * area.x);
}

// The plane through the lifted q, p and v: its height below a lifted vertex is an in-circle determinant.
typedef struct {
  double x, y, z, mx, my, mz;
} lifted_plane;

static inline lifted_plane plane_through(sight p, sight v, double2 area) {
  const double x0 = p.from.y * v.lift, x1 = p.lift * v.from.y;
  const double y0 = p.lift * v.from.x, y1 = p.from.x * v.lift;
  const lifted_plane plane = {x0 - x1, y0 - y1, area.x, fabs(x0) + fabs(x1), fabs(y0) + fabs(y1), area.y};
  return plane;
}

static inline double2 height_above(lifted_plane plane, sight u, double fourth) {
  const double height = plane.x * u.from.x + plane.y * u.from.y + plane.z * u.lift;
  const double magnitude = plane.mx * fabs(u.from.x) + plane.my * fabs(u.from.y) + plane.mz * u.lift;
  return VECTOR(double2, fourth * height, fourth * magnitude);
}

// A piece of a cell: its area so far, and what bounds its error.
typedef struct {
  double area, error;
} piece;

static inline void add_term(piece* sum, double sign, double2 cotangent, double2 height) {
  sum->area += sign * cotangent.x * height.x;
  sum->error += cotangent.y * fabs(height.x) + fabs(cotangent.x) * height.y;
}

// The cotangent of an angle by its dot product, one over its area and the area's slenderness; and what bounds its
// error.
static inline double2 cotangent_of(double2 dot, double inverse, double slenderness) {
  return VECTOR(double2, dot.x * inverse, dot.y * inverse * slenderness);
}

// The cavity's triangle v, c, a: its angles are opposite to the edges from v. heights: of a and c.
static inline void add_triangle(piece* sum, estimate* all, sight v, sight c, sight a, double2 height_a,
                                double2 height_c) {
  const double2 va = a.at - v.at, vc = c.at - v.at, ac = c.at - a.at;
  const double2 area = cross_of(vc, va);
  const double inverse = 1.0 / area.x, slenderness = area.y * inverse;
  all->is_sound &= is_sound_area(area, all->square) & (c.lift * all->square < LARGEST_LIFT);
  add_term(sum, -1.0, cotangent_of(dot_of(va, ac), inverse, slenderness), height_c);
  add_term(sum, 1.0, cotangent_of(dot_of(vc, ac), inverse, slenderness), height_a);
}

static inline double estimated(estimate* all, piece sum, double2 area) {
  const double inverse = 1.0 / (area.x * all->square);
  const double weight = max(sum.area, 0.0) * inverse;
  all->is_sound &= is_sound_area(area, all->square);
  all->errors += (sum.error + fabs(sum.area) * (area.y / area.x)) * inverse;
  all->weights += weight;
  return weight;
}

// Laplace's weight of v between p and c.
static inline double laplace_weight(estimate* all, sight p, sight v, sight c) {
  const double2 before = cross_of(p.from, v.from), after = cross_of(v.from, c.from);
  const double2 first = dot_of(p.from, p.at - v.at), second = dot_of(c.from, c.at - v.at);
  const double inverse_before = 1.0 / before.x, inverse_after = 1.0 / after.x;
  const double2 at_p = cotangent_of(first, inverse_before, before.y * inverse_before);
  const double2 at_c = cotangent_of(second, inverse_after, after.y * inverse_after);
  const double weight = max(at_p.x + at_c.x, 0.0);
  all->is_sound &=
      is_sound_area(before, all->square) & is_sound_area(after, all->square) & (v.lift * all->square < LARGEST_LIFT);
  all->errors += at_p.y + at_c.y;
  all->weights += weight;
  return weight;
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
  const ulong bits = as_ulong(fabs(x));
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
// are d, which is q at the last edge, and an area.
static inline wide wide_term(double2 q, sight p, sight v, sight c, sight a, double2 d, wide behind, wide before) {
  const wide across = wide_circle(v.at, c.at, a.at, d), height = wide_circle(p.at, v.at, c.at, q);
  return wide_quotient(wide_product(across, height), wide_product(behind, before));
}

static inline wide wide_laplace(double2 q, sight p, sight v, sight c) {
  return wide_quotient(wide_circle(q, p.at, v.at, c.at),
                       wide_product(wide_area(q, p.at, v.at), wide_area(q, v.at, c.at)));
}

// ---------------------------------------------------------------------------------------------------------------------
// The walk around the cavity

// If the mesh is no Delaunay triangulation, walks may end without an answer.
#define ASTRAY -1
#define WEIGHED 1

// Gives the neighbours of q, which lies in triangle `start`, but not on the hull nor at a vertex, to a receiver.
// Without `exactly`, weights and their sum are estimates; otherwise weights are by the sum, if that is not 0, and else
// these weights are added to it. Returns WEIGHED, or UNDECIDED, or ASTRAY. steps: how many are left.
static inline int weigh(natural_mesh mesh, double2 q, int start, int method, int exactly, int what, int* steps,
                        estimate* all, wide* sum, receiver* to) {
  // Triangle t with its corners v, c, a; v is its corner k.
  int t = start, k = 0;
  face f = mesh.faces[t];
  sight v = see(mesh, q, f.corner[0]), c = see(mesh, q, f.corner[1]), a = see(mesh, q, f.corner[2]);
  const ulong largest = as_ulong(max(v.lift, max(c.lift, a.lift))) >> 52;
  all->square = power_of_two(1023 - (int)largest);
  all->fourth = all->square * all->square;
  const wide whole = *sum;
  // Backwards around v, to an edge of the boundary.
  for (;;) {
    const int u = f.neighbor[next_corner(k)];
    if (u < 0) break;
    const face g = mesh.faces[u];
    const int j = corner_opposite(g, t);
    const sight d = see(mesh, q, g.corner[j]);
    const int inside = has_inside(v, a, d, q, exactly);
    if (inside == UNDECIDED) return UNDECIDED;
    if (inside <= 0) break;
    if (--*steps < 0) return ASTRAY;
    c = a;
    a = d;
    f = g;
    t = u;
    k = next_corner(j);
  }
  const int first = v.vertex, first_triangle = t;
  do {
    // From the edge p v of the boundary around v to the next one, v c.
    const sight p = a;
    const double2 area = cross_of(p.from, v.from);
    const lifted_plane plane = plane_through(p, v, area);
    double2 height_a = VECTOR(double2, 0.0, 0.0);
    piece part = {0.0, 0.0};
    wide wide_part = {0.0, NO_EXPONENT}, behind = {0.0, NO_EXPONENT};
    const int is_sibson = method == SIBSON;
    if (exactly && is_sibson) behind = wide_area(v.at, c.at, a.at);
    for (;;) {
      if (--*steps < 0) return ASTRAY;
      if (!exactly && is_sibson) {
        const double2 height_c = height_above(plane, c, all->fourth);
        add_triangle(&part, all, v, c, a, height_a, height_c);
        height_a = height_c;
      }
      const int u = f.neighbor[corner_before(k)];
      if (u < 0) break;
      const face g = mesh.faces[u];
      const int j = corner_opposite(g, t);
      const sight d = see(mesh, q, g.corner[j]);
      const int inside = has_inside(c, v, d, q, exactly);
      if (inside == UNDECIDED) return UNDECIDED;
      if (inside <= 0) break;
      if (exactly && is_sibson) {
        const wide before = wide_area(v.at, d.at, c.at);
        wide_part = wide_sum(wide_part, wide_term(q, p, v, c, a, d.at, behind, before));
        behind = before;
      }
      a = c;
      c = d;
      f = g;
      t = u;
      k = corner_before(j);
    }
    double weight = 0.0;
    if (exactly) {
      if (is_sibson) {
        wide_part = wide_sum(wide_part, wide_term(q, p, v, c, a, q, behind, wide_area(q, v.at, c.at)));
        wide_part = wide_quotient(wide_part, wide_area(q, p.at, v.at));
      } else if (method == LAPLACE) {
        wide_part = wide_laplace(q, p, v, c);
      }
      if (whole.mantissa == 0.0) {
        *sum = wide_sum(*sum, wide_part);
      } else {
        weight = narrow_quotient(wide_part, whole);
      }
    } else if (is_sibson) {
      const double2 next = cross_of(v.from, c.from);
      const double inverse = 1.0 / next.x;
      all->is_sound &= is_sound_area(next, all->square);
      add_term(&part, -1.0, cotangent_of(dot_of(v.from, c.from), inverse, next.y * inverse), height_a);
      weight = estimated(all, part, area);
    } else {
      weight = laplace_weight(all, p, v, c);
    }
    give(to, what, mesh.source[v.vertex], weight);
    const sight apex = a;
    a = v;
    v = c;
    c = apex;
    k = next_corner(k);
  } while (v.vertex != first || t != first_triangle);
  return WEIGHED;
}

// Weights that are known without a walk: at a vertex, and on an edge of the hull, where both methods tend to the linear
// interpolation between its ends. Returns 0 if q lies on neither, UNDECIDED, or WEIGHED.
static inline int weigh_on_hull(natural_mesh mesh, double2 q, int start, int exactly, int what, receiver* to) {
  const face f = mesh.faces[start];
  for (int k = 0; k < 3; ++k) {
    const double2 at = mesh.unit * mesh.points[f.corner[k]];
    if (at.x == q.x && at.y == q.y) {
      give(to, what, mesh.source[f.corner[k]], 1.0);
      return WEIGHED;
    }
  }
  for (int k = 0; k < 3; ++k) {
    if (f.neighbor[k] >= 0) continue;
    const int from = f.corner[next_corner(k)], to_vertex = f.corner[corner_before(k)];
    const double2 a = mesh.unit * mesh.points[from], b = mesh.unit * mesh.points[to_vertex];
    const int side = exactly ? orient_sign(a, b, q, ORIENT_BOUND) : orient_filtered(a, b, q, ORIENT_BOUND);
    if (side == UNDECIDED) return UNDECIDED;
    if (side != 0) continue;
    const int along_x = fabs(b.x - a.x) >= fabs(b.y - a.y);
    const double behind = fabs(along_x ? q.x - a.x : q.y - a.y), ahead = fabs(along_x ? b.x - q.x : b.y - q.y);
    give(to, what, mesh.source[from], ahead / (behind + ahead));
    give(to, what, mesh.source[to_vertex], behind / (behind + ahead));
    return WEIGHED;
  }
  return 0;
}

// The walk's steps are three per triangle, and once more around the first vertex.
static inline int most_steps(int triangles) { return (int)min((long)INT_MAX, 4L * triangles); }

// In floating point; triangles: of the query's set. Returns WEIGHED, or UNDECIDED if the weights are not certain, which
// includes walks that went astray.
static inline int weigh_by_estimate(natural_mesh mesh, double2 q, int start, int triangles, int method, int what,
                                    receiver* to) {
  const int on_hull = weigh_on_hull(mesh, q, start, 0, what, to);
  if (on_hull != 0) return on_hull;
  const int most = most_steps(triangles);
  int steps = most;
  estimate all = {0.0, 0.0, 0.0, 0.0, 1};
  wide none = {0.0, NO_EXPONENT};
  const int outcome = weigh(mesh, q, start, method, 0, what, &steps, &all, &none, to);
  const double certain = NATURAL_ERROR / (2.0 * ROUNDOFF);
  if (outcome != WEIGHED || !all.is_sound || !(all.errors * (16.0 + (most - steps)) <= certain * all.weights)) {
    return UNDECIDED;
  }
  divide_by(to, what, all.weights);
  return WEIGHED;
}

// With small relative errors: one walk for the sum of the weights, and one for the weights. Returns WEIGHED or ASTRAY.
static inline int weigh_exactly(natural_mesh mesh, double2 q, int start, int triangles, int method, int what,
                                receiver* to) {
  to->count = 0;
  if (weigh_on_hull(mesh, q, start, 1, what, to) == WEIGHED) return WEIGHED;
  estimate unused = {0.0, 0.0, 0.0, 0.0, 1};
  wide sum = {0.0, NO_EXPONENT};
  for (int pass = 0; pass < 2; ++pass) {
    int steps = most_steps(triangles);
    to->count = 0;
    if (weigh(mesh, q, start, method, 1, pass == 0 ? TO_NOTHING : what, &steps, &unused, &sum, to) != WEIGHED) {
      return ASTRAY;
    }
    if (sum.mantissa == 0.0) return ASTRAY;
  }
  return WEIGHED;
}

// ---------------------------------------------------------------------------------------------------------------------
// Values

static inline int set_of_query(int place, int sets, global const int* query_offsets) {
  return sets > 1 ? segment_of(place, sets, query_offsets) : 0;
}

// n queries in order of places; found: their triangles, less than 0 outside of the hull. Values and results are rows of
// so many columns, by point and by query. left: whether a query, by place, is left to interpolate_natural_exactly.
kernel void interpolate_natural(int n, int sets, int columns, int method, double outside,
                                global const int* restrict query_offsets, global const mesh_set* restrict records,
                                global const query_frame* restrict frames, global const int* restrict order,
                                global const double2* restrict placed, global const double2* restrict points,
                                global const int* restrict source, global const face* restrict faces,
                                global const int* restrict found, global const double* restrict values,
                                global double* restrict results, global uchar* restrict left) {
  const int i = get_global_id(0);
  if (i < n) {
    const int s = set_of_query(i, sets, query_offsets);
    const natural_mesh mesh = {points, source, faces, frames[s].unit};
    receiver to = {0, columns, values, results + (size_t)order[i] * columns, 0, 0};
    int outcome = WEIGHED;
    if (found[i] >= 0) {
      clear_row(&to, 0.0);
      outcome = weigh_by_estimate(mesh, placed[i], found[i], records[s].triangles, method, TO_VALUES, &to);
    } else {
      clear_row(&to, outside);
    }
    left[i] = outcome != WEIGHED;
  }
}

kernel void interpolate_natural_exactly(int n, int sets, int columns, int method, double outside,
                                        global const int* restrict query_offsets,
                                        global const mesh_set* restrict records,
                                        global const query_frame* restrict frames, global const int* restrict order,
                                        global const double2* restrict placed, global const double2* restrict points,
                                        global const int* restrict source, global const face* restrict faces,
                                        global const int* restrict found, global const double* restrict values,
                                        global const uchar* restrict left, global double* restrict results) {
  const int i = get_global_id(0);
  if (i < n && left[i]) {
    const int s = set_of_query(i, sets, query_offsets);
    const natural_mesh mesh = {points, source, faces, frames[s].unit};
    receiver to = {0, columns, values, results + (size_t)order[i] * columns, 0, 0};
    clear_row(&to, 0.0);
    if (weigh_exactly(mesh, placed[i], found[i], records[s].triangles, method, TO_VALUES, &to) != WEIGHED) {
      clear_row(&to, outside);
    }
  }
}

// ---------------------------------------------------------------------------------------------------------------------
// Lists of neighbours

// counts, by query: the neighbours; none outside of the hull.
kernel void count_neighbors(int n, int sets, global const int* restrict query_offsets,
                            global const mesh_set* restrict records, global const query_frame* restrict frames,
                            global const int* restrict order, global const double2* restrict placed,
                            global const double2* restrict points, global const int* restrict source,
                            global const face* restrict faces, global const int* restrict found,
                            global uint* restrict counts) {
  const int i = get_global_id(0);
  if (i < n) {
    const int s = set_of_query(i, sets, query_offsets);
    const natural_mesh mesh = {points, source, faces, frames[s].unit};
    receiver to = {0, 0, 0, 0, 0, 0};
    if (found[i] >= 0 && weigh_on_hull(mesh, placed[i], found[i], 1, TO_NOTHING, &to) != WEIGHED) {
      estimate unused = {0.0, 0.0, 0.0, 0.0, 1};
      wide sum = {0.0, NO_EXPONENT};
      int steps = most_steps(records[s].triangles);
      if (weigh(mesh, placed[i], found[i], NO_WEIGHTS, 1, TO_NOTHING, &steps, &unused, &sum, &to) != WEIGHED) {
        to.count = 0;
      }
    }
    counts[order[i]] = (uint)to.count;
  }
}

// offsets, by query: where its neighbours begin.
kernel void list_neighbors(int n, int sets, int method, global const int* restrict query_offsets,
                           global const mesh_set* restrict records, global const query_frame* restrict frames,
                           global const int* restrict order, global const double2* restrict placed,
                           global const double2* restrict points, global const int* restrict source,
                           global const face* restrict faces, global const int* restrict found,
                           global const uint* restrict offsets, global int* restrict neighbors,
                           global double* restrict weights) {
  const int i = get_global_id(0);
  if (i < n) {
    const uint first = offsets[order[i]];
    if (offsets[order[i] + 1] != first) {
      const int s = set_of_query(i, sets, query_offsets);
      const natural_mesh mesh = {points, source, faces, frames[s].unit};
      receiver to = {0, 0, 0, 0, neighbors + first, weights + first};
      const int triangles = records[s].triangles;
      if (weigh_by_estimate(mesh, placed[i], found[i], triangles, method, TO_LIST, &to) != WEIGHED) {
        weigh_exactly(mesh, placed[i], found[i], triangles, method, TO_LIST, &to);
      }
    }
  }
}
