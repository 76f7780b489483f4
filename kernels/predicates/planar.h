// Orientation and in-circle tests: floating point with a bound first, exact where that cannot decide.
#ifndef FLAUNAY_PLANAR_H
#define FLAUNAY_PLANAR_H

#include "arithmetic/language.h"
#include "arithmetic/numbers.h"
#include "predicates/bounds.h"
#include "predicates/exact_doubles.h"
#include "predicates/exact_integers.h"

BEGIN_SHARED

// The sign that floating point cannot tell. Every filter takes its bound, see predicates/bounds.h.
#define UNDECIDED 2

// The sign of a computed determinant, with the sum of its terms' magnitudes. One comparison, which can be predicted,
// says whether it is decided, so that the sign itself need not be a branch.
static inline int filtered_sign(real det, real magnitude, filter_bound bound) {
  if (fabs(det) > error_within(bound, magnitude)) return det > 0 ? 1 : -1;
  return bound == 0 ? 0 : UNDECIDED;
}

// 1 if a, b, c turn left, -1 right, 0 straight, UNDECIDED.
static inline int orient_filtered(coordinate2 a, coordinate2 b, coordinate2 c, filter_bound bound) {
  const real2 ca = difference2(a, c), cb = difference2(b, c);
  const real left = ca.x * cb.y, right = ca.y * cb.x;
  const real det = left - right, error = bound * (fabs(left) + fabs(right));
  // As a chain of comparisons, for walks, which branch by the sign.
  return det > error ? 1 : det < -error ? -1 : bound == 0 ? 0 : UNDECIDED;
}

// The sign of the cross product of b - a and d - c.
static inline int cross_sign(coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d) {
  const real left = difference(b.x, a.x) * difference(d.y, c.y), right = difference(b.y, a.y) * difference(d.x, c.x);
  // With the bound of orient_filtered, which has the same terms.
  const int sign = filtered_sign(left - right, fabs(left) + fabs(right), ORIENT_BOUND);
  return sign != UNDECIDED ? sign : cross_exact(a, b, c, d);
}

// The in-circle determinant of a, b, c and the point from which these are seen, and the sum of its terms' magnitudes;
// with the squares of their distances.
static inline real2 circle_determinant(real2 ad, real2 bd, real2 cd, real al, real bl, real cl) {
  const real bc = bd.x * cd.y;
  const real cb = cd.x * bd.y;
  const real ca = cd.x * ad.y;
  const real ac = ad.x * cd.y;
  const real ab = ad.x * bd.y;
  const real ba = bd.x * ad.y;
  const real det = al * (bc - cb) + bl * (ca - ac) + cl * (ab - ba);
  const real magnitude = (fabs(bc) + fabs(cb)) * al + (fabs(ca) + fabs(ac)) * bl + (fabs(ab) + fabs(ba)) * cl;
  return VECTOR(real2, det, magnitude);
}

static inline real squared_length(real2 p) { return p.x * p.x + p.y * p.y; }

// 1 if d lies inside the circle through a, b, c (counter-clockwise), -1 outside, 0 on it, UNDECIDED.
static inline int circle_filtered(coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d, filter_bound bound) {
  const real2 ad = difference2(a, d);
  const real2 bd = difference2(b, d);
  const real2 cd = difference2(c, d);
  const real2 det = circle_determinant(ad, bd, cd, squared_length(ad), squared_length(bd), squared_length(cd));
  return filtered_sign(det.x, det.y, bound);
}

// The angle under which a point sees the edge from a to b. Its cotangent is the dot product over the cross
// product; `products` is the pair of both. Magnitudes bound their errors.
typedef struct {
  real_pair products, magnitudes;
} angle;

// The terms of both products.
typedef struct {
  real_pair first, second;
} angle_terms;

static inline angle_terms angle_terms_of(coordinate_pair p, coordinate_pair a, coordinate_pair b) {
  const real_pair pa = pair_difference(a, p);
  const real_pair pb = pair_difference(b, p);
  const real_pair along = pa * pb;
  const real_pair across = pa * swapped(pb);
  const angle_terms terms = {lows(along, across), highs(along, across)};
  return terms;
}
static inline real_pair angle_products(coordinate_pair p, coordinate_pair a, coordinate_pair b) {
  const angle_terms terms = angle_terms_of(p, a, b);
  return terms.first + high_negated(terms.second);
}
static inline angle angle_of(coordinate_pair p, coordinate_pair a, coordinate_pair b) {
  const angle_terms terms = angle_terms_of(p, a, b);
  const angle seen = {terms.first + high_negated(terms.second), magnitudes(terms.first) + magnitudes(terms.second)};
  return seen;
}
static inline angle angle_at(coordinate2 p, coordinate2 a, coordinate2 b) {
  return angle_of(as_pair(p), as_pair(a), as_pair(b));
}

// As orient_filtered of a, b and the point: 1 if it lies left of the edge.
static inline int angle_side(angle seen, filter_bound bound) {
  return filtered_sign(high(seen.products), high(seen.magnitudes), bound);
}

// 1 if a point left of the edge sees it under a wider angle than another, which is to lie inside the circle through the
// edge and that one; -1 if narrower, 0 if it lies on the circle, UNDECIDED. The error of a cross or dot product is
// below 4.02 e times its magnitude, that of the products below 9.1 e times theirs, that of the difference below 10.2 e
// of the sum, with e = ROUNDOFF: see docs/exactness.md.
static inline real angle_difference(real_pair seen, real_pair other) {
  const real_pair products = other * swapped(seen);
  return low(products) - high(products);
}
static inline int angle_compared(angle seen, angle other, filter_bound bound) {
  const real_pair terms = other.magnitudes * swapped(seen.magnitudes);
  return filtered_sign(angle_difference(seen.products, other.products), low(terms) + high(terms), bound);
}

// The bound of angle_compared where the in-circle test has the given one.
static inline filter_bound angle_bound(filter_bound circle_bound) { return circle_bound == 0 ? 0 : ANGLE_BOUND; }

// The filter first, the exact test where it cannot decide.
static inline int orient_sign(coordinate2 a, coordinate2 b, coordinate2 c, filter_bound bound) {
  const int sign = orient_filtered(a, b, c, bound);
  return sign != UNDECIDED ? sign : orient_exact(a, b, c);
}

static inline int circle_sign(coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d, filter_bound bound) {
  const int sign = circle_filtered(a, b, c, d, bound);
  return sign != UNDECIDED ? sign : circle_undecided(a, b, c, d, bound);
}

// The order of the canonical form: by x, then by y.
static inline int comes_before(coordinate2 p, coordinate2 q) { return (p.x < q.x) | ((p.x == q.x) & (p.y < q.y)); }

// For four different points on one circle, a, b, c counter-clockwise: the result of the in-circle test if the
// first of the four (comes_before) is lowered a little below the paraboloid that all are lifted to. Never 0.
// The Delaunay triangulation so defined is unique, and makes of each polygon of cocircular points a fan from
// its first vertex: the canonical form.
//
// With a the first of the triangle's vertices: if d comes before it, d is lowered, and lies below the plane
// through the others: inside. Else a is, and at d the plane sinks by a's barycentric coordinate there: d is now
// above it, unless b and c separate it from a (it cannot lie on their line). See docs/exactness.md.
static inline int canonical_tie(coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d, filter_bound bound) {
  while (comes_before(b, a) || comes_before(c, a)) {
    const coordinate2 first = a;
    a = b;
    b = c;
    c = first;
  }
  if (comes_before(d, a)) return 1;
  return orient_sign(b, c, d, bound == 0 ? 0 : ORIENT_BOUND) < 0 ? 1 : -1;
}

// circle_sign that is never 0.
static inline int circle_canonical(coordinate2 a, coordinate2 b, coordinate2 c, coordinate2 d, filter_bound bound) {
  const int sign = circle_sign(a, b, c, d, bound);
  return sign != 0 ? sign : canonical_tie(a, b, c, d, bound);
}

END_SHARED

#endif
