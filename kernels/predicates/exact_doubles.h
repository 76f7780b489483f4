// Exact orientation and in-circle tests of points whose coordinates are doubles: by integers where they suffice, as for
// most ties, else by expansions; in-circle tests with twice the precision of doubles before they take long integers.
#ifndef FLAUNAY_EXACT_DOUBLES_H
#define FLAUNAY_EXACT_DOUBLES_H

#include "arithmetic/exact_arithmetic.h"
#include "arithmetic/integer_arithmetic.h"
#include "arithmetic/language.h"
#include "arithmetic/numbers.h"
#include "predicates/bounds.h"
#include "predicates/circle_integers.h"

#ifndef FIXED_POINT

BEGIN_SHARED

// The largest differences of circle_middle where a filter could not decide: then the determinant is below 2^125, see
// docs/exactness.md.
#define MIDDLE_BITS 42
// A unit for differences: with `largest` the greatest magnitude of all (rounded; not 0), it makes them integers below
// 2^bits. As a factor, a power of two.
#define NARROW_BITS 31
#define WIDE_BITS 62
static inline double unit_factor(double largest, int bits) {
  const int exponent = (int)(as_ulong(largest) >> 52);  // 1023 for [1, 2)
  return as_double((uint64)(1023 + 1023 + bits - 1 - exponent) << 52);
}

// Whether a difference as two_sum gives it, below 2^bits units, is an integer; it is then put into *integer.
static inline int is_integer(double2 difference, double factor, int64* integer) {
  const double high = difference.x * factor;
  const double low = difference.y * factor;
  const int64 whole_high = convert_long(high);
  const int64 whole_low = convert_long(low);
  *integer = whole_high + whole_low;
  return (int)(convert_double(whole_high) == high) & (int)(convert_double(whole_low) == low);
}

// Whether a difference is an integer of at most 53 bits, which a double has: then it has no rounding error.
static inline int is_short_integer(double2 difference, double factor, int64* integer) {
  const double high = difference.x * factor;
  *integer = convert_long(high);
  return (convert_double(*integer) == high) & (difference.y == 0.0);
}

static inline double larger_magnitude(double a, double b) { return fabs(a) > fabs(b) ? fabs(a) : fabs(b); }

// The sign of the cross product of (bx, by) and (cx, cy), all differences of coordinates as two_sum gives them.
OUT_OF_LINE static inline int cross_by_expansions(double2 bx, double2 by, double2 cx, double2 cy) {
  expansion sum;
  expansion_cross(bx, by, cx, cy, &sum);
  return expansion_sign(&sum);
}

OUT_OF_LINE static inline int cross_exact(double2 a, double2 b, double2 c, double2 d) {
  const double2 px = two_sum(b.x, -a.x), py = two_sum(b.y, -a.y), qx = two_sum(d.x, -c.x), qy = two_sum(d.y, -c.y);
  if ((px.y == 0.0) & (py.y == 0.0) & (qx.y == 0.0) & (qy.y == 0.0)) {
    const double2 first = two_product(px.x, qy.x), second = two_product(py.x, qx.x);
    return first.x != second.x ? sign_of(first.x - second.x) : sign_of(first.y - second.y);
  }
  const double largest = larger_magnitude(larger_magnitude(px.x, py.x), larger_magnitude(qx.x, qy.x));
  const double factor = unit_factor(largest, WIDE_BITS);
  int64 pxi, pyi, qxi, qyi;
  if (is_integer(px, factor, &pxi) & is_integer(py, factor, &pyi) & is_integer(qx, factor, &qxi) &
      is_integer(qy, factor, &qyi))
    return sign_of_128(difference_128(product_128(pxi, qyi), product_128(pyi, qxi)));
  return cross_by_expansions(px, py, qx, qy);
}

static inline int orient_exact(double2 a, double2 b, double2 c) { return cross_exact(a, b, a, c); }

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
    const double2 factors[3] = {crossed ? dy[i] : dy[j], lift, lift};
    expansion_add_products(sum, f, factors, 3);
  }
}

OUT_OF_LINE static inline int circle_sign_by_expansions(const double2* dx, const double2* dy) {
  expansion sum;
  circle_by_expansions(dx, dy, &sum);
  return expansion_sign(&sum);
}

// The input of in-circle tests: differences of three points from the fourth, and their largest magnitude.
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
static inline int are_integers(const circle_differences* from, double factor, int64* x, int64* y) {
  int integers = 1;
  for (int k = 0; k < 3; ++k) {
    integers &= is_integer(from->x[k], factor, &x[k]) & is_integer(from->y[k], factor, &y[k]);
  }
  return integers;
}

// The in-circle test of coarse points (COARSE_CIRCLE_BITS) after a filter, exact for them, found a tie.
#define circle_coarse(a, b, c, d) 0

// Products and sums of pairs as two_sum gives them, with about twice the precision of doubles.
static inline double2 close_product(double2 f, double2 g) {
  const double2 leading = two_product(f.x, g.x);
  return VECTOR(double2, leading.x, leading.y + (f.x * g.y + f.y * g.x));
}
static inline double2 close_sum(double2 f, double2 g) {
  const double2 leading = two_sum(f.x, g.x);
  return VECTOR(double2, leading.x, leading.y + (f.y + g.y));
}

// An angle as in predicates/planar.h: dot and cross product, with the sums of their terms' magnitudes.
typedef struct {
  double2 dot, cross;
  double dot_magnitude, cross_magnitude;
} close_angle;
static inline close_angle angle_closely(double2 ax, double2 ay, double2 bx, double2 by) {
  const double2 xx = close_product(ax, bx), yy = close_product(ay, by);
  const double2 xy = close_product(ax, by), yx = close_product(ay, bx);
  const close_angle angle = {close_sum(xx, yy), close_sum(xy, -yx), fabs(xx.x) + fabs(yy.x), fabs(xy.x) + fabs(yx.x)};
  return angle;
}

// The in-circle test by angles over the edge from a to b, with an error below 90 e^2 of the magnitudes, e = 2^-53; see
// docs/exactness.md. 0 if it cannot decide: then the points are cocircular or very nearly so.
#define CLOSE_BOUND 0x1p-99
static inline int circle_closely(const circle_differences* from, double2 a, double2 b, double2 c) {
  const close_angle seen = angle_closely(from->x[0], from->y[0], from->x[1], from->y[1]);
  const close_angle other =
      angle_closely(two_sum(a.x, -c.x), two_sum(a.y, -c.y), two_sum(b.x, -c.x), two_sum(b.y, -c.y));
  const double2 wider = close_sum(close_product(other.dot, seen.cross), -close_product(seen.dot, other.cross));
  const double det = wider.x + wider.y;
  const double magnitude = other.dot_magnitude * seen.cross_magnitude + seen.dot_magnitude * other.cross_magnitude;
  return fabs(det) > CLOSE_BOUND * magnitude ? sign_of(det) : 0;
}

// The in-circle test of any four points, by their differences from d, not all 0.
static inline int circle_of_differences(const circle_differences* from, double2 a, double2 b, double2 c) {
  const int sign = circle_closely(from, a, b, c);
  if (sign != 0) return sign;
  int64 x[3], y[3];
  return are_integers(from, unit_factor(from->largest, WIDE_BITS), x, y)
             ? sign_of_256(circle_wide(x[0], y[0], x[1], y[1], x[2], y[2]))
             : circle_sign_by_expansions(from->x, from->y);
}

OUT_OF_LINE static inline int circle_exact(double2 a, double2 b, double2 c, double2 d) {
  const circle_differences from = differences_from(d, a, b, c);
  return from.largest == 0.0 ? 0 : circle_of_differences(&from, a, b, c);
}

// Whether all differences are integers of at most 53 bits, as most are or none.
static inline int are_short_integers(const circle_differences* from, double factor, int64* x, int64* y) {
  for (int k = 0; k < 3; ++k) {
    if (!(is_short_integer(from->x[k], factor, &x[k]) & is_short_integer(from->y[k], factor, &y[k]))) return 0;
  }
  return 1;
}

// circle_exact, faster, of points for which circle_filtered or angle_compared could not decide with this bound. A bound
// that is larger than theirs says nothing about the determinant.
OUT_OF_LINE static inline int circle_undecided(double2 a, double2 b, double2 c, double2 d, filter_bound bound) {
  if (bound > ANGLE_BOUND) return circle_exact(a, b, c, d);
  const circle_differences from = differences_from(d, a, b, c);
  if (from.largest == 0.0) return 0;
  int64 x[3], y[3];
  if (are_short_integers(&from, unit_factor(from.largest, MIDDLE_BITS), x, y)) {
    const int spare = MIDDLE_BITS - SHORT_BITS;
    const int64 all = x[0] | y[0] | x[1] | y[1] | x[2] | y[2];
    if ((all & (((int64)1 << spare) - 1)) != 0) return circle_middle(x[0], y[0], x[1], y[1], x[2], y[2]);
    return circle_short(x[0] >> spare, y[0] >> spare, x[1] >> spare, y[1] >> spare, x[2] >> spare, y[2] >> spare);
  }
  return circle_of_differences(&from, a, b, c);
}

END_SHARED

#endif

#endif
