// Power tests of weighted points: the in-circle test of points that are lifted to x^2 + y^2 - w instead of the
// paraboloid (Aurenhammer, SIAM Journal on Computing 16, 1987). Filter first, exact where that cannot decide.
//
// Never a tie: a lift is lowered by an infinitesimal multiple of x^2 + y^2, so that a point which only lies on the
// plane of others around it is hidden by them, and is then perturbed as without weights. So with equal weights the
// tests are those without.
#ifndef FLAUNAY_POWER_H
#define FLAUNAY_POWER_H

#include "arithmetic/exact_arithmetic.h"
#include "arithmetic/integer_arithmetic.h"
#include "arithmetic/language.h"
#include "arithmetic/numbers.h"
#include "predicates/bounds.h"
#include "predicates/planar.h"
#include "predicates/records.h"

#ifndef FIXED_POINT

BEGIN_SHARED

typedef struct {
  double2 at;
  double weight;
} weighted_point;

// A point as another one sees it: where, and the height of its lift above that of the other one.
typedef struct {
  double x, y, lift;
} lifted_point;

static inline lifted_point lifted_from(weighted_point p, weighted_point origin) {
  const double x = p.at.x - origin.at.x, y = p.at.y - origin.at.y;
  const lifted_point lifted = {x, y, x * x + y * y - (p.weight - origin.weight)};
  return lifted;
}
// The magnitudes of the terms of its height.
static inline double lift_magnitude(weighted_point p, weighted_point origin) {
  const double x = p.at.x - origin.at.x, y = p.at.y - origin.at.y;
  return x * x + y * y + fabs(p.weight - origin.weight);
}

// With the origin, three points: positive if the last is below the plane through the others. They turn left.
static inline double power_determinant(lifted_point a, lifted_point b, lifted_point c) {
  return b.lift * (a.x * c.y - a.y * c.x) - a.lift * (b.x * c.y - b.y * c.x) - c.lift * (a.x * b.y - a.y * b.x);
}

static inline double cross_magnitude(lifted_point p, lifted_point q) { return fabs(p.x * q.y) + fabs(p.y * q.x); }

// Its sign, or UNDECIDED: whether d is below the plane through a, b and c.
static inline int power_filtered(weighted_point a, weighted_point b, weighted_point c, weighted_point d) {
  const lifted_point pb = lifted_from(b, a), pc = lifted_from(c, a), pd = lifted_from(d, a);
  const double magnitude = lift_magnitude(b, a) * cross_magnitude(pc, pd) +
                           lift_magnitude(c, a) * cross_magnitude(pb, pd) +
                           lift_magnitude(d, a) * cross_magnitude(pb, pc);
  const double det = power_determinant(pb, pc, pd);
  return fabs(det) > POWER_BOUND * magnitude ? sign_of(det) : UNDECIDED;
}

// The exact differences of weighted points from another one, as two_sum gives them.
typedef struct {
  double2 x, y, heavier;
} weighted_difference;

static inline weighted_difference weighted_difference_of(weighted_point p, weighted_point origin) {
  const weighted_difference d = {two_sum(p.at.x, -origin.at.x), two_sum(p.at.y, -origin.at.y),
                                 two_sum(p.weight, -origin.weight)};
  return d;
}

// sum += factor * other * lift of d, without `other` if that is null.
static inline void add_lifted(expansion* sum, double2 factor, const double2* other, weighted_difference d) {
  for (int term = 0; term < 3; ++term) {
    double2 factors[3];
    int count = 0;
    if (other != 0) factors[count++] = *other;
    factors[count++] = term == 0 ? d.x : term == 1 ? d.y : -d.heavier;
    if (term < 2) factors[count++] = factors[other != 0];
    expansion_add_products(sum, factor, factors, count);
  }
}

// Whether a point's differences are integers below 2^SHORT_BITS units, and its lift is one below 2^61, in squared
// units.
static inline int is_short_lift(weighted_difference d, double factor, int64* x, int64* y, int64* lift) {
  const double heavier = d.heavier.x * factor * factor;
  if (!is_short_integer(d.x, factor, x) || !is_short_integer(d.y, factor, y)) return 0;
  if (d.heavier.y != 0.0 || !(fabs(heavier) < 0x1p60) || heavier != rint(heavier)) return 0;
  *lift = *x * *x + *y * *y - convert_long(heavier);
  return 1;
}

static inline double larger_of(weighted_difference d, double least) {
  return larger_magnitude(least, larger_magnitude(d.x.x, d.y.x));
}

// power_determinant's sign. Points that are equally heavy are tested without weights.
OUT_OF_LINE static inline int power_exact(weighted_point a, weighted_point b, weighted_point c, weighted_point d) {
  const weighted_difference from[3] = {weighted_difference_of(a, d), weighted_difference_of(b, d),
                                       weighted_difference_of(c, d)};
  if ((from[0].heavier.x == 0.0) & (from[1].heavier.x == 0.0) & (from[2].heavier.x == 0.0)) {
    return circle_undecided(a.at, b.at, c.at, d.at, INFINITY);
  }
  const double factor = unit_factor(larger_of(from[0], larger_of(from[1], larger_of(from[2], 0.0))), SHORT_BITS);
  int64 x[3], y[3], lift[3];
  if (is_short_lift(from[0], factor, &x[0], &y[0], &lift[0]) &&
      is_short_lift(from[1], factor, &x[1], &y[1], &lift[1]) &&
      is_short_lift(from[2], factor, &x[2], &y[2], &lift[2])) {
    integer128 sum = widened(0);
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      sum = sum_128(sum, product_128(lift[k], x[i] * y[j] - x[j] * y[i]));
    }
    return sign_of_128(sum);
  }
  expansion sum;
  sum.size = 0;
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    add_lifted(&sum, from[i].x, &from[j].y, from[k]);
    add_lifted(&sum, -from[j].x, &from[i].y, from[k]);
  }
  return expansion_sign(&sum);
}

// Power tests that filters cannot decide: exactly, then by the first perturbation, then as without weights.
OUT_OF_LINE static inline int power_undecided(weighted_point a, weighted_point b, weighted_point c, weighted_point d,
                                              filter_bounds bounds) {
  const int sign = power_exact(a, b, c, d);
  if (sign != 0) return sign;
  const int circle = circle_sign(a.at, b.at, c.at, d.at, bounds.circle);
  return circle != 0 ? -circle : canonical_tie(a.at, b.at, c.at, d.at, bounds.circle);
}

// For points on a line, b between a and c: whether it is hidden by them, which it is if its lift is on or above theirs.
// t: along the axis in which they differ.
OUT_OF_LINE static inline int is_hidden_between(weighted_point a, weighted_point b, weighted_point c) {
  const int by_y = a.at.x == c.at.x;
  const double ta = by_y ? a.at.y - b.at.y : a.at.x - b.at.x, tc = by_y ? c.at.y - b.at.y : c.at.x - b.at.x;
  const lifted_point la = lifted_from(a, b), lc = lifted_from(c, b);
  const double first = la.lift * tc, second = lc.lift * ta;
  const double difference = tc > 0 ? first - second : second - first;
  const double magnitude = lift_magnitude(a, b) * fabs(tc) + lift_magnitude(c, b) * fabs(ta);
  if (fabs(difference) > POWER_BOUND * magnitude) return difference < 0;
  const weighted_difference da = weighted_difference_of(a, b), dc = weighted_difference_of(c, b);
  expansion sum;
  sum.size = 0;
  add_lifted(&sum, by_y ? dc.y : dc.x, 0, da);
  add_lifted(&sum, by_y ? -da.y : -da.x, 0, dc);
  const int sign = expansion_sign(&sum);
  return tc > 0 ? sign <= 0 : sign >= 0;
}

END_SHARED

#endif

#endif
