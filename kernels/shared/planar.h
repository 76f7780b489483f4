// Orientation and in-circle tests: floating point with a bound first; exact by integers where they suffice, as for most
// ties, else by expansions.
#ifndef FLAUNAY_PLANAR_H
#define FLAUNAY_PLANAR_H

#include "shared/bounds.h"
#include "shared/exact_arithmetic.h"
#include "shared/integer_arithmetic.h"
#include "shared/language.h"

BEGIN_SHARED

// The sign that floating point cannot tell. Every filter takes its bound, see shared/bounds.h.
#define UNDECIDED 2

// The sign of a computed determinant whose error is at most the given one. One comparison, which can be predicted, says
// whether it is decided, so that the sign itself need not be a branch.
static inline int filtered_sign(double det, double error, double bound) {
  if (fabs(det) > error) return det > 0.0 ? 1 : -1;
  return bound == 0.0 ? 0 : UNDECIDED;
}

// 1 if a, b, c turn left, -1 right, 0 straight, UNDECIDED.
static inline int orient_filtered(double2 a, double2 b, double2 c, double bound) {
  const double left = (a.x - c.x) * (b.y - c.y);
  const double right = (a.y - c.y) * (b.x - c.x);
  const double det = left - right;
  const double error = bound * (fabs(left) + fabs(right));
  // As a chain of comparisons, for walks, which branch by the sign.
  return det > error ? 1 : det < -error ? -1 : bound == 0.0 ? 0 : UNDECIDED;
}

// Of (bx, by) and (cx, cy), all differences of coordinates as two_sum gives them.
OUT_OF_LINE static inline int cross_by_expansions(double2 bx, double2 by, double2 cx, double2 cy) {
  expansion sum;
  sum.size = 0;
  for (int term = 0; term < 2; ++term) {
    const double2 f = term == 0 ? bx : -by;
    const double2 g = term == 0 ? cy : cx;
    for (int k = 0; k < 4; ++k) {
      const double2 p = two_product(k & 1 ? f.x : f.y, k & 2 ? g.x : g.y);
      if (p.y != 0.0) expansion_add(&sum, p.y);
      if (p.x != 0.0) expansion_add(&sum, p.x);
    }
  }
  return expansion_sign(&sum);
}

// The sign of the cross product of b - a and d - c.
static inline int cross_sign(double2 a, double2 b, double2 c, double2 d) {
  const double left = (b.x - a.x) * (d.y - c.y), right = (b.y - a.y) * (d.x - c.x);
  // With the bound of orient_filtered, which has the same terms.
  const int sign = filtered_sign(left - right, ORIENT_BOUND * (fabs(left) + fabs(right)), ORIENT_BOUND);
  if (sign != UNDECIDED) return sign;
  const double2 px = two_sum(b.x, -a.x), py = two_sum(b.y, -a.y), qx = two_sum(d.x, -c.x), qy = two_sum(d.y, -c.y);
  if ((px.y != 0.0) | (py.y != 0.0) | (qx.y != 0.0) | (qy.y != 0.0)) return cross_by_expansions(px, py, qx, qy);
  const double2 first = two_product(px.x, qy.x), second = two_product(py.x, qx.x);
  return first.x != second.x ? sign_of(first.x - second.x) : sign_of(first.y - second.y);
}

OUT_OF_LINE static inline int orient_exact(double2 a, double2 b, double2 c) {
  const double2 bx = two_sum(b.x, -a.x);
  const double2 by = two_sum(b.y, -a.y);
  const double2 cx = two_sum(c.x, -a.x);
  const double2 cy = two_sum(c.y, -a.y);
  const double largest = larger_magnitude(larger_magnitude(bx.x, by.x), larger_magnitude(cx.x, cy.x));
  if (largest == 0.0) return 0;
  const double factor = unit_factor(largest, WIDE_BITS);
  long bxi, byi, cxi, cyi;
  if (is_integer(bx, factor, &bxi) & is_integer(by, factor, &byi) & is_integer(cx, factor, &cxi) &
      is_integer(cy, factor, &cyi))
    return sign_of_128(difference_128(product_128(bxi, cyi), product_128(byi, cxi)));
  return cross_by_expansions(bx, by, cx, cy);
}

// The in-circle determinant of a, b, c and the point from which these are seen, and the sum of its terms' magnitudes;
// with the squares of their distances.
static inline double2 circle_determinant(double2 ad, double2 bd, double2 cd, double al, double bl, double cl) {
  const double bc = bd.x * cd.y;
  const double cb = cd.x * bd.y;
  const double ca = cd.x * ad.y;
  const double ac = ad.x * cd.y;
  const double ab = ad.x * bd.y;
  const double ba = bd.x * ad.y;
  const double det = al * (bc - cb) + bl * (ca - ac) + cl * (ab - ba);
  const double magnitude = (fabs(bc) + fabs(cb)) * al + (fabs(ca) + fabs(ac)) * bl + (fabs(ab) + fabs(ba)) * cl;
  return VECTOR(double2, det, magnitude);
}

static inline double squared_length(double2 p) { return p.x * p.x + p.y * p.y; }

// 1 if d lies inside the circle through a, b, c (counter-clockwise), -1 outside, 0 on it, UNDECIDED.
static inline int circle_filtered(double2 a, double2 b, double2 c, double2 d, double bound) {
  const double2 ad = a - d;
  const double2 bd = b - d;
  const double2 cd = c - d;
  const double2 det = circle_determinant(ad, bd, cd, squared_length(ad), squared_length(bd), squared_length(cd));
  return filtered_sign(det.x, bound * det.y, bound);
}

// The angle under which a point sees the edge from a to b: its cotangent is the dot product over the cross product, of
// which this is the pair. Magnitudes bound their errors.
typedef struct {
  double_pair products, magnitudes;
} angle;

static inline angle angle_of(double_pair p, double_pair a, double_pair b) {
  const double_pair pa = a - p;
  const double_pair pb = b - p;
  const double_pair along = pa * pb;
  const double_pair across = pa * swapped(pb);
  const double_pair first = lows(along, across);
  const double_pair second = highs(along, across);
  angle seen;
  seen.products = first + high_negated(second);
  seen.magnitudes = magnitudes(first) + magnitudes(second);
  return seen;
}
static inline angle angle_at(double2 p, double2 a, double2 b) { return angle_of(as_pair(p), as_pair(a), as_pair(b)); }

// As orient_filtered of a, b and the point: 1 if it lies left of the edge.
static inline int angle_side(angle seen, double bound) {
  return filtered_sign(high(seen.products), bound * high(seen.magnitudes), bound);
}

// 1 if a point left of the edge sees it under a wider angle than another, which is to lie inside the circle through the
// edge and that one; -1 if narrower, 0 if it lies on the circle, UNDECIDED. The error of a cross or dot product is
// below 4.02 e times its magnitude, that of the products below 9.1 e times theirs, that of the difference below 10.2 e
// of the sum, with e = 2^-53: see docs/exactness.md.
static inline int angle_compared(angle seen, angle other, double bound) {
  const double_pair products = other.products * swapped(seen.products);
  const double_pair terms = other.magnitudes * swapped(seen.magnitudes);
  return filtered_sign(low(products) - high(products), bound * (low(terms) + high(terms)), bound);
}

// The bound of angle_compared where the in-circle test has the given one.
static inline double angle_bound(double circle_bound) { return circle_bound == 0.0 ? 0.0 : ANGLE_BOUND; }

// The in-circle determinant of differences from the fourth point, which are integers below 2^SHORT_BITS, 2^MIDDLE_BITS
// or 2^WIDE_BITS, or what two_sum gives. The first compares angles over the edge from a to b, whose dot and cross
// products are below 2^63. The second is modulo 2^128, which suffices where a filter could not decide: then the
// determinant is below 2^125, see docs/exactness.md. Of the third, both factors of a term are below 2^125.
#define SHORT_BITS 30
static inline int circle_short(long ax, long ay, long bx, long by, long cx, long cy) {
  const long dot = ax * bx + ay * by, cross = ax * by - ay * bx;
  ax -= cx;
  ay -= cy;
  bx -= cx;
  by -= cy;
  const long other_dot = ax * bx + ay * by, other_cross = ax * by - ay * bx;
  return sign_of_128(difference_128(product_128(other_dot, cross), product_128(dot, other_cross)));
}

static inline integer128 sum_of_squares(long x, long y) { return sum_128(product_128(x, x), product_128(y, y)); }
static inline integer128 cross_product(long ax, long ay, long bx, long by) {
  return difference_128(product_128(ax, by), product_128(ay, bx));
}

static inline integer128 dot_product(long ax, long ay, long bx, long by) {
  return sum_128(product_128(ax, bx), product_128(ay, by));
}

static inline int circle_middle(long ax, long ay, long bx, long by, long cx, long cy) {
  const integer128 dot = dot_product(ax, ay, bx, by), cross = cross_product(ax, ay, bx, by);
  ax -= cx;
  ay -= cy;
  bx -= cx;
  by -= cy;
  const integer128 other_dot = dot_product(ax, ay, bx, by), other_cross = cross_product(ax, ay, bx, by);
  return sign_of_128(difference_128(low_product(other_dot, cross), low_product(dot, other_cross)));
}

static inline integer256 circle_term(long ax, long ay, long bx, long by, long cx, long cy) {
  return product_256(sum_of_squares(ax, ay), cross_product(bx, by, cx, cy));
}

static inline integer256 circle_wide(long ax, long ay, long bx, long by, long cx, long cy) {
  return sum_256(sum_256(circle_term(ax, ay, bx, by, cx, cy), circle_term(bx, by, cx, cy, ax, ay)),
                 circle_term(cx, cy, ax, ay, bx, by));
}

// The determinant, compressed.
static inline void circle_by_expansions(const double2* dx, const double2* dy, expansion* sum) {
  sum->size = 0;
  // lift(k) times the cross product of the other two: six products of four differences for each coordinate's
  // square, twelve in all.
  for (int term = 0; term < 12; ++term) {
    const int k = term / 4;
    const int i = (k + 1) % 3;
    const int j = (k + 2) % 3;
    const int crossed = term & 1;
    const double2 lift = term & 2 ? dy[k] : dx[k];
    const double2 f = crossed ? -dx[j] : dx[i];
    const double2 g = crossed ? dy[i] : dy[j];
    expansion product;
    product.size = 0;
    expansion_add(&product, f.y);
    expansion_add(&product, f.x);
    for (int s = 0; s < 3; ++s) {
      const double2 by = s == 0 ? g : lift;
      const double factor[2] = {by.x, by.y};
      expansion_multiply(&product, factor, 2);
    }
    for (int s = 0; s < product.size; ++s) expansion_add(sum, product.part[s]);
    expansion_compress(sum);
  }
}

OUT_OF_LINE static inline int circle_sign_by_expansions(const double2* dx, const double2* dy) {
  expansion sum;
  circle_by_expansions(dx, dy, &sum);
  return expansion_sign(&sum);
}

// What in-circle tests are made of: differences of three points from the fourth, and the largest magnitude among them.
typedef struct {
  double2 x[3], y[3];
  double largest;
} circle_differences;

static inline circle_differences differences_from(double2 d, double2 a, double2 b, double2 c) {
  circle_differences from;
  from.x[0] = two_sum(a.x, -d.x);
  from.y[0] = two_sum(a.y, -d.y);
  from.x[1] = two_sum(b.x, -d.x);
  from.y[1] = two_sum(b.y, -d.y);
  from.x[2] = two_sum(c.x, -d.x);
  from.y[2] = two_sum(c.y, -d.y);
  from.largest = 0.0;
  for (int k = 0; k < 3; ++k) {
    from.largest = larger_magnitude(from.largest, larger_magnitude(from.x[k].x, from.y[k].x));
  }
  return from;
}

// Whether all differences are integers below 2^WIDE_BITS units, which are put into x and y.
static inline int are_integers(const circle_differences* from, double factor, long* x, long* y) {
  int integers = 1;
  for (int k = 0; k < 3; ++k) {
    integers &= is_integer(from->x[k], factor, &x[k]) & is_integer(from->y[k], factor, &y[k]);
  }
  return integers;
}

// Of any four points.
OUT_OF_LINE static inline int circle_exact(double2 a, double2 b, double2 c, double2 d) {
  const circle_differences from = differences_from(d, a, b, c);
  if (from.largest == 0.0) return 0;
  long x[3], y[3];
  return are_integers(&from, unit_factor(from.largest, WIDE_BITS), x, y)
             ? sign_of_256(circle_wide(x[0], y[0], x[1], y[1], x[2], y[2]))
             : circle_sign_by_expansions(from.x, from.y);
}

// The same, sooner, of points for which circle_filtered or angle_compared could not decide with this bound. A bound
// that is larger than theirs says nothing about the determinant.
OUT_OF_LINE static inline int circle_undecided(double2 a, double2 b, double2 c, double2 d, double bound) {
  if (bound > ANGLE_BOUND) return circle_exact(a, b, c, d);
  const circle_differences from = differences_from(d, a, b, c);
  if (from.largest == 0.0) return 0;
  const double factor = unit_factor(from.largest, MIDDLE_BITS);
  long x[3], y[3], all = 0;
  int integers = 1;
  for (int k = 0; k < 3; ++k) {
    integers &= is_short_integer(from.x[k], factor, &x[k]) & is_short_integer(from.y[k], factor, &y[k]);
    all |= x[k] | y[k];
  }
  if (!integers) return circle_exact(a, b, c, d);
  const int spare = MIDDLE_BITS - SHORT_BITS;
  if ((all & ((1L << spare) - 1)) != 0) return circle_middle(x[0], y[0], x[1], y[1], x[2], y[2]);
  return circle_short(x[0] >> spare, y[0] >> spare, x[1] >> spare, y[1] >> spare, x[2] >> spare, y[2] >> spare);
}

// The filter first, the exact test where it cannot decide.
static inline int orient_sign(double2 a, double2 b, double2 c, double bound) {
  const int sign = orient_filtered(a, b, c, bound);
  return sign != UNDECIDED ? sign : orient_exact(a, b, c);
}

static inline int circle_sign(double2 a, double2 b, double2 c, double2 d, double bound) {
  const int sign = circle_filtered(a, b, c, d, bound);
  return sign != UNDECIDED ? sign : circle_undecided(a, b, c, d, bound);
}

// The order of the canonical form: by x, then by y.
static inline int comes_before(double2 p, double2 q) { return (p.x < q.x) | ((p.x == q.x) & (p.y < q.y)); }

// For four different points on one circle, a, b, c counter-clockwise: what the in-circle test says if the first of the
// four (comes_before) is lowered a little below the paraboloid that all are lifted to. Never 0. The Delaunay
// triangulation so defined is unique, and makes of each polygon of cocircular points a fan from its first vertex: the
// canonical form.
//
// With a the first of the triangle's vertices: if d comes before it, d is what is lowered, and lies below the plane
// through the others: inside. Else a is, and at d the plane sinks by a's barycentric coordinate there: d is now above
// it, unless b and c separate it from a (it cannot lie on their line). See docs/exactness.md.
static inline int canonical_tie(double2 a, double2 b, double2 c, double2 d, double bound) {
  while (comes_before(b, a) || comes_before(c, a)) {
    const double2 first = a;
    a = b;
    b = c;
    c = first;
  }
  if (comes_before(d, a)) return 1;
  return orient_sign(b, c, d, bound == 0.0 ? 0.0 : ORIENT_BOUND) < 0 ? 1 : -1;
}

// circle_sign that is never 0.
static inline int circle_canonical(double2 a, double2 b, double2 c, double2 d, double bound) {
  const int sign = circle_sign(a, b, c, d, bound);
  return sign != 0 ? sign : canonical_tie(a, b, c, d, bound);
}

END_SHARED

#endif
