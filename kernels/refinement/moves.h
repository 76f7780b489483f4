// Where vertices may move, and which moves are good.
#ifndef FLAUNAY_MOVES_H
#define FLAUNAY_MOVES_H

#include "arithmetic/language.h"
#include "refinement/quality_of_rows.h"

#ifndef FIXED_POINT

BEGIN_SHARED

// A bad move is tried with this many lengths, each half of the one before.
INTEGER_CONSTANT(MOST_HALVINGS, 4);

// The corner of the same vertex in the next triangle counter-clockwise. There must be one.
static inline int next_in_star(const seen_mesh* mesh, int corner) {
  const int beyond = neighbor_at(mesh, next_halfedge(corner));
  return 3 * beyond + next_corner(number_facing(&mesh->rows[beyond], row_of(corner)));
}

// The corner of a star after which the lexicographically smallest neighbour comes.
static inline int first_of_star(const seen_mesh* mesh, int corner) {
  int first = corner;
  for (int c = next_in_star(mesh, corner); c != corner; c = next_in_star(mesh, c)) {
    if (comes_before(point_at(mesh, next_halfedge(c)), point_at(mesh, next_halfedge(first)))) first = c;
  }
  return first;
}

// From a vertex to the mean of the circumcentres of its triangles, and how far away its farthest neighbour is, squared:
// the step of an optimal Delaunay triangulation (Chen and Xu, 2004). Weights are areas times densities; with densities
// of area^-3/2, small triangles stay small. first: see above; so the order of sums depends on coordinates alone.
typedef struct {
  double2 step;
  double reach;
} optimal_move;

static inline optimal_move optimal_move_of(const seen_mesh* mesh, int first) {
  const double2 v = point_at(mesh, first);
  double2 u = point_at(mesh, next_halfedge(first)) - v;
  double x = 0.0, y = 0.0, weights = 0.0, reach = 0.0;
  int corner = first;
  do {
    const double2 w = point_at(mesh, previous_halfedge(corner)) - v;
    const double uu = squared_length(u), ww = squared_length(w), area = u.x * w.y - u.y * w.x;
    const double weight = 1.0 / sqrt(area), scale = weight / area;
    x = x + (w.y * uu - u.y * ww) * scale;
    y = y + (u.x * ww - w.x * uu) * scale;
    weights = weights + weight;
    reach = fmax(reach, uu);
    u = w;
    corner = next_in_star(mesh, corner);
  } while (corner != first);
  const optimal_move move = {VECTOR(double2, 0.5 * x / weights, 0.5 * y / weights), reach};
  return move;
}

static inline double2 moved_by(double2 p, double2 step, refinement_rules rules) {
  return VECTOR(double2, rounded_to(p.x + step.x, rules.coarse), rounded_to(p.y + step.y, rules.coarse));
}

// Corners from the lexicographically smallest one on.
static inline void order_corners(double2* p) {
  while (comes_before(p[1], p[0]) || comes_before(p[2], p[0])) {
    const double2 first = p[0];
    p[0] = p[1];
    p[1] = p[2];
    p[2] = first;
  }
}

static inline double doubled_area(const double2* p) {
  const double2 u = p[1] - p[0], v = p[2] - p[0];
  return u.x * v.y - u.y * v.x;
}

// The squared sine of the smallest angle.
static inline double squared_sine_of(const double2* p) {
  const double a = squared_distance(p[1], p[2]), b = squared_distance(p[2], p[0]), c = squared_distance(p[0], p[1]);
  const double area = doubled_area(p), longest = fmax(a, fmax(b, c));
  const double middle = fmax(fmin(a, b), fmin(fmax(a, b), c));
  return area * area / (longest * middle);
}

// Whether a triangle that changes its shape is not turned over, and not worse than it should be, or than it was.
static inline int is_change_good(const seen_mesh* mesh, int row, double2* before, double2* after,
                                 refinement_rules rules, GLOBAL const double* areas) {
  if (orient_sign(after[0], after[1], after[2], ORIENT_BOUND) <= 0) return 0;
  const int has_small_angle = is_angle_below(after[0], after[1], after[2], rules.squared_sine),
            is_large = is_too_large(mesh, row, after, rules, areas);
  double shortest = INFINITY;
  for (int k = 0; k < 3; ++k) shortest = fmin(shortest, squared_distance(after[k], after[(k + 1) % 3]));
  if (!has_small_angle && !is_large && shortest >= rules.min_edge) return 1;
  if (!(shortest >= rules.min_edge)) return 0;
  order_corners(before);
  order_corners(after);
  return !(has_small_angle && squared_sine_of(after) < squared_sine_of(before)) &&
         !(is_large && doubled_area(after) > doubled_area(before));
}

// Whether all triangles around a vertex are good if it alone moves to p.
static inline int is_star_good(const seen_mesh* mesh, int first, double2 p, refinement_rules rules,
                               GLOBAL const double* areas) {
  int corner = first;
  do {
    const double2 from = point_at(mesh, next_halfedge(corner)), to = point_at(mesh, previous_halfedge(corner));
    double2 before[3] = {point_at(mesh, first), from, to}, after[3] = {p, from, to};
    if (!is_change_good(mesh, row_of(corner), before, after, rules, areas)) return 0;
    corner = next_in_star(mesh, corner);
  } while (corner != first);
  return 1;
}

END_SHARED

#endif

#endif
