// Tests of single triangles, and the order in which bad ones are mended.
#ifndef FLAUNAY_QUALITY_OF_ROWS_H
#define FLAUNAY_QUALITY_OF_ROWS_H

#include "arithmetic/language.h"
#include "predicates/quality.h"
#include "refinement/cavities.h"

#ifndef FIXED_POINT

BEGIN_SHARED

// Nominal distances from an apex that differ by no more than this part of themselves count as equal.
#define EQUAL_DISTANCES 0.001

// A triangle's corners from the lexicographically smallest one on, so that values computed from them do not
// depend on the order in which they are stored.
typedef struct {
  int corner[3];  // of the mesh
  double2 point[3];
} ordered_triangle;

static inline ordered_triangle ordered(const seen_mesh* mesh, int row) {
  GLOBAL const int* const corners = mesh->rows[row].corner;
  const double2 a = mesh->points[corners[0]], b = mesh->points[corners[1]], c = mesh->points[corners[2]];
  // Without branches, which could not be predicted.
  const int is_last = comes_before(c, a) & comes_before(c, b);
  int first = 2 * is_last + (comes_before(b, a) & !is_last);
  ordered_triangle triangle;
  for (int k = 0; k < 3; ++k) {
    triangle.corner[k] = 3 * row + first;
    triangle.point[k] = mesh->points[corners[first]];
    first = corner_after_any(first);
  }
  return triangle;
}

// The corner, by its place among the three, that is opposite to the shortest side.
static inline int opposite_to_shortest(const double2* p) {
  const double a = squared_distance(p[1], p[2]), b = squared_distance(p[2], p[0]), c = squared_distance(p[0], p[1]);
  const int is_first = (a <= b) & (a <= c), is_second = (b <= c) & !is_first;
  return 2 - is_second - 2 * is_first;
}

// The smaller of two largest areas, 0 for any.
static inline double smaller_area(double a, double b) { return b > 0.0 && !(a > 0.0 && a < b) ? b : a; }

static inline double area_wanted(const seen_mesh* mesh, int row, refinement_rules rules, GLOBAL const double* areas) {
  const double area = rules.area_kind == AREAS_NONE        ? 0.0
                      : rules.area_kind == AREAS_BY_PARENT ? areas[mesh->rows[row].parent]
                                                           : areas[row];
  return smaller_area(area, rules.area);
}

static inline int is_too_large(const seen_mesh* mesh, int row, const double2* p, refinement_rules rules,
                               GLOBAL const double* areas) {
  const double area = area_wanted(mesh, row, rules, areas);
  return area > 0.0 && area < INFINITY && is_area_above(p[0], p[1], p[2], area);
}

// The corner with the smallest angle, by its place among the three: the first one of equal ones.
static inline int corner_of_smallest_angle(const double2* p) {
  const int k = length_sign(p[2], p[0], p[1], p[2]) < 0;
  return length_sign(p[0], p[1], p[(k + 1) % 3], p[(k + 2) % 3]) < 0 ? 2 : k;
}

// Whether two edges that meet at a vertex do so at a sharp angle, with triangles all the way between them.
// wedges: for each end of an edge the next edge counter-clockwise around it, or -1 if there are no triangles between.
static inline int is_sharp_inside(GLOBAL const double2* points, GLOBAL const int* ends, GLOBAL const int* wedges,
                                  int vertex, int a, int b) {
  const int end_a = ends[2 * a] == vertex ? 2 * a : 2 * a + 1, end_b = ends[2 * b] == vertex ? 2 * b : 2 * b + 1;
  const double2 from = points[vertex], to_a = points[ends[end_a ^ 1]], to_b = points[ends[end_b ^ 1]];
  if (!is_sharp(from, to_a, to_b)) return 0;
  const int is_turned = orient_sign(from, to_a, to_b, ORIENT_BOUND) < 0, first = is_turned ? b : a,
            last = is_turned ? a : b;
  int edge = first;
  do {
    edge = wedges[ends[2 * edge] == vertex ? 2 * edge : 2 * edge + 1];
  } while (edge >= 0 && edge != first && edge != last);
  return edge == last;
}

// Whether the smallest angle of a triangle cannot be helped: it is one between two constraints that meet at a vertex of
// the input, or is across from one (Miller, Pav and Walkington, 2003): the shortest side, which is no constraint, joins
// two constraints, equally far from where they meet.
static inline int excuse_of(const seen_mesh* mesh, const ordered_triangle* triangle, GLOBAL const edge_place* places,
                            GLOBAL const int* ends, GLOBAL const int* wedges, int vertices) {
  const int corner = triangle->corner[corner_of_smallest_angle(triangle->point)], next = next_halfedge(corner),
            previous = previous_halfedge(corner);
  if (vertex_at(mesh, corner) < vertices && edge_at(mesh, next) >= 0 && edge_at(mesh, previous) >= 0)
    return EXCUSED_INPUT_ANGLE;
  const edge_place a = places[vertex_at(mesh, next)], b = places[vertex_at(mesh, previous)];
  return edge_at(mesh, corner) < 0 && a.apex >= 0 && a.apex == b.apex && a.edge != b.edge &&
                 fabs(a.distance - b.distance) <= EQUAL_DISTANCES * a.distance &&
                 is_sharp_inside(mesh->points, ends, wedges, a.apex, a.edge, b.edge)
             ? EXCUSED_NEAR_APEX
             : EXCUSED_NOT;
}

// Spreads the bits of a hash, by the constants of SplitMix64 (Steele, Lea and Flood, 2014).
static inline uint64 mixed(uint64 hash) {
  hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9UL;
  hash = (hash ^ hash >> 27) * 0x94d049bb133111ebUL;
  return hash ^ hash >> 31;
}
static inline uint64 hash_with(uint64 hash, double2 p) {
  hash = mixed(hash + 0x9e3779b97f4a7c15UL + as_ulong(p.x));
  return mixed(hash + 0x9e3779b97f4a7c15UL + as_ulong(p.y));
}

// A key for an order of triangles that does not depend on how they are stored: the leading digits of the
// squared length of the shortest side, and a hash.
static inline uint64 key_of(const ordered_triangle* triangle) {
  const double2* const p = triangle->point;
  const int k = opposite_to_shortest(p);
  uint64 hash = 0;
  for (int j = 0; j < 3; ++j) hash = hash_with(hash, p[j]);
  return (as_ulong(squared_distance(p[(k + 1) % 3], p[(k + 2) % 3])) >> 31 << 32) | hash >> 32;
}
// That squared length, less some digits.
static inline double square_in_key(uint64 key) { return as_double(key >> 32 << 31); }
// Whether one triangle comes before another: 1, or -1; 0 if they are the same. For equal keys.
static inline int order_by_corners(const ordered_triangle* a, const ordered_triangle* b) {
  for (int k = 0; k < 3; ++k) {
    if (comes_before(a->point[k], b->point[k])) return 1;
    if (comes_before(b->point[k], a->point[k])) return -1;
  }
  return 0;
}

static inline split_place place_of_constraint(const seen_mesh* mesh, int corner, GLOBAL const edge_place* places,
                                              GLOBAL const int* ends, refinement_rules rules) {
  return place_of_split(vertex_at(mesh, next_halfedge(corner)), vertex_at(mesh, previous_halfedge(corner)),
                        edge_at(mesh, corner) & EDGE_NUMBER, mesh->points, places, ends, rules.vertices, rules.coarse);
}

// Whether the point that splits the constraint opposite to a corner would be nearer to a vertex than the smallest edge.
OUT_OF_LINE static inline int is_split_crowded(const seen_mesh* mesh, int corner, GLOBAL const edge_place* places,
                                               GLOBAL const int* ends, refinement_rules rules) {
  const double2 p = place_of_constraint(mesh, corner, places, ends, rules).point;
  const int beyond = neighbor_at(mesh, corner);
  for (int side = 0; side < (beyond < 0 ? 1 : 2); ++side) {
    const int from = side ? corner_facing(mesh, beyond, row_of(corner)) : corner;
    // Otherwise it will not be split.
    if (is_in_circle(mesh, row_of(from), p) && is_near_vertex(mesh, next_halfedge(from), from, p, rules.min_edge))
      return 1;
  }
  return 0;
}

// How far a corner is from the line opposite to it, squared, times that line's squared length.
static inline double scaled_height(const seen_mesh* mesh, int corner) {
  const double2 from = point_at(mesh, next_halfedge(corner));
  const double2 u = point_at(mesh, previous_halfedge(corner)) - from, v = point_at(mesh, corner) - from;
  const double cross = u.x * v.y - u.y * v.x;
  return cross * cross;
}

// A corner opposite to a constraint is far from it above this multiple of the smallest edge, squared. If the
// constraint is longer than six smallest edges, the circles beside it then reach so far around the point that
// splits it, between a third and two thirds of its length, that no vertex is nearer to it than 1.03 of these.
#define FAR_CORNER 1.5

// Why the constraint, or part of one, opposite to a corner may not be split, as far as the triangles beside it
// tell; EXCUSED_NOT if it may. *is_far: whether no vertex can be too near to the point that splits it. If a
// corner is nearer to it than points may be to each other, the triangle is between constraints that are
// straight but for rounding, and splits would make more such triangles.
static inline int why_not_split_here(const seen_mesh* mesh, int corner, refinement_rules rules, int* is_far) {
  const int edge = edge_at(mesh, corner);
  *is_far = 0;
  if (edge & EDGE_KEPT) return EXCUSED_KEPT;
  if (edge & EDGE_FROZEN) return EXCUSED_FROZEN;
  const double length =
      squared_distance(point_at(mesh, next_halfedge(corner)), point_at(mesh, previous_halfedge(corner)));
  if (length < 4.0 * rules.min_edge) return EXCUSED_MIN_EDGE;
  const int beyond = neighbor_at(mesh, corner);
  double height = scaled_height(mesh, corner);
  if (beyond >= 0) height = fmin(height, scaled_height(mesh, corner_facing(mesh, beyond, row_of(corner))));
  if (height < rules.min_edge * length) return EXCUSED_FROZEN;
  *is_far = length >= rules.long_edge && height >= FAR_CORNER * rules.min_edge * length;
  return EXCUSED_NOT;
}

static inline int why_not_split(const seen_mesh* mesh, int corner, GLOBAL const edge_place* places,
                                GLOBAL const int* ends, refinement_rules rules) {
  int is_far;
  const int reason = why_not_split_here(mesh, corner, rules, &is_far);
  if (reason != EXCUSED_NOT || is_far) return reason;
  return is_split_crowded(mesh, corner, places, ends, rules) ? EXCUSED_MIN_EDGE : EXCUSED_NOT;
}

// Whether a point encroaches a constraint between two vertices. With a cosine of 0, a right angle does not
// encroach: triangles are Delaunay beyond the constraint, too.
static inline int encroaches(double2 from, double2 to, double2 p, double squared_cosine) {
  return squared_cosine > 0.0 ? is_encroached(from, to, p, squared_cosine) : cosine_sign(from, p, p, to, 0.0) > 0;
}

END_SHARED

#endif

#endif
