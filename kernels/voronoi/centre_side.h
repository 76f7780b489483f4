// On which side of a line the centre of a triangle's circumcircle lies, and where the bisector of two points crosses a
// segment. Floating point with a bound first; exact where it cannot decide.
#ifndef FLAUNAY_CENTRE_SIDE_H
#define FLAUNAY_CENTRE_SIDE_H

#include "arithmetic/language.h"
#include "predicates/nearness.h"
#include "predicates/planar.h"

BEGIN_SHARED

// With b and c relative to a, the centre is a + (|b|^2 (c_y, -c_x) - |c|^2 (b_y, -b_x)) / (2 b x c). It lies left of
// the line from v to w, of direction e = w - v, if
//
//   2 (b x c) (e x (a - v)) + |c|^2 (e . b) - |b|^2 (e . c) > 0.
//
// The rounded value is wrong by less than 11.2 e of the sum of the terms' magnitudes, with e = 2^-53 here
// (docs/exactness.md): CENTRE_SIDE_BOUND. It is of degree four, as the in-circle test.

// The terms of the test that depend on the triangle alone.
typedef struct {
  double2 a, b, c, b_from_a, c_from_a;
  double cross, cross_magnitude, b_square, c_square;
} centre_terms;

static inline centre_terms centre_terms_of(double2 a, double2 b, double2 c) {
  centre_terms of;
  of.a = a;
  of.b = b;
  of.c = c;
  of.b_from_a = b - a;
  of.c_from_a = c - a;
  const double left = of.b_from_a.x * of.c_from_a.y, right = of.b_from_a.y * of.c_from_a.x;
  of.cross = left - right;
  of.cross_magnitude = fabs(left) + fabs(right);
  of.b_square = of.b_from_a.x * of.b_from_a.x + of.b_from_a.y * of.b_from_a.y;
  of.c_square = of.c_from_a.x * of.c_from_a.x + of.c_from_a.y * of.c_from_a.y;
  return of;
}

// 1 if the centre lies left of the line from v to w, -1 right, 0 on it, UNDECIDED. The triangle is counter-clockwise.
static inline int centre_side_filtered(const centre_terms* of, double2 v, double2 w, filter_bound bound) {
  const double2 e = w - v, f = of->a - v;
  const double left = e.x * f.y, right = e.y * f.x;
  const double bx = e.x * of->b_from_a.x, by = e.y * of->b_from_a.y;
  const double cx = e.x * of->c_from_a.x, cy = e.y * of->c_from_a.y;
  const double side = 2.0 * of->cross * (left - right) + (of->c_square * (bx + by) - of->b_square * (cx + cy));
  const double magnitude = 2.0 * of->cross_magnitude * (fabs(left) + fabs(right)) +
                           (of->c_square * (fabs(bx) + fabs(by)) + of->b_square * (fabs(cx) + fabs(cy)));
  return filtered_sign(side, magnitude, bound);
}

static inline integer128 sum_of_squares(int64 x, int64 y) { return dot_product(x, y, x, y); }
static inline integer256 doubled(integer256 a) { return sum_256(a, a); }
static inline integer128 negated(integer128 a) { return difference_128(widened(0), a); }

// Differences as two_sum gives them: twelve products of four.
OUT_OF_LINE static inline int centre_side_by_expansions(const double2* b, const double2* c, const double2* e,
                                                        const double2* f) {
  expansion sum;
  sum.size = 0;
  for (int term = 0; term < 12; ++term) {
    const int first = term & 1, second = term >> 1 & 1;
    const int part = term >> 2;
    // Factors of the product of crosses, and of the products of squares and dots.
    const double2* const lifted = part == 1 ? c : b;
    const double2* const dotted = part == 1 ? b : c;
    const double2 f0 = part == 0 ? b[first] : lifted[first];
    const double2 factors[3] = {part == 0 ? c[1 - first] : lifted[first], e[second],
                                part == 0 ? f[1 - second] : dotted[second]};
    const double sign = part == 0 ? (first == second ? 2.0 : -2.0) : part == 1 ? 1.0 : -1.0;
    expansion_add_products(&sum, VECTOR(double2, sign * f0.x, sign * f0.y), factors, 3);
  }
  return expansion_sign(&sum);
}

OUT_OF_LINE static inline int centre_side_exact(const centre_terms* of, double2 v, double2 w) {
  const double2 b[2] = {two_sum(of->b.x, -of->a.x), two_sum(of->b.y, -of->a.y)};
  const double2 c[2] = {two_sum(of->c.x, -of->a.x), two_sum(of->c.y, -of->a.y)};
  const double2 e[2] = {two_sum(w.x, -v.x), two_sum(w.y, -v.y)};
  const double2 f[2] = {two_sum(of->a.x, -v.x), two_sum(of->a.y, -v.y)};
  double largest = 0.0;
  for (int k = 0; k < 2; ++k) {
    largest =
        larger_magnitude(largest, larger_magnitude(larger_magnitude(b[k].x, c[k].x), larger_magnitude(e[k].x, f[k].x)));
  }
  if (largest == 0.0) return 0;
  const double factor = unit_factor(largest, WIDE_BITS);
  int64 bi[2], ci[2], ei[2], fi[2];
  int integers = 1;
  for (int k = 0; k < 2; ++k) {
    integers &= is_integer(b[k], factor, &bi[k]) & is_integer(c[k], factor, &ci[k]) & is_integer(e[k], factor, &ei[k]) &
                is_integer(f[k], factor, &fi[k]);
  }
  if (!integers) return centre_side_by_expansions(b, c, e, f);
  const integer128 cross = cross_product(bi[0], bi[1], ci[0], ci[1]);
  const integer128 across = cross_product(ei[0], ei[1], fi[0], fi[1]);
  const integer256 lifted_b = product_256(sum_of_squares(ci[0], ci[1]), dot_product(ei[0], ei[1], bi[0], bi[1]));
  const integer256 lifted_c =
      product_256(sum_of_squares(bi[0], bi[1]), negated(dot_product(ei[0], ei[1], ci[0], ci[1])));
  return sign_of_256(sum_256(doubled(product_256(cross, across)), sum_256(lifted_b, lifted_c)));
}

static inline int centre_side(const centre_terms* of, double2 v, double2 w, filter_bound bound) {
  const int sign = centre_side_filtered(of, v, w, bound);
  return sign != UNDECIDED ? sign : centre_side_exact(of, v, w);
}

// A rounded centre, as circumcentres of voronoi/voronoi.cl computes it, is wrong by less than 2^-36 of its distances in
// x and y from one vertex, together, and by the rounding of the sum with that. Seen from any vertex of the triangle,
// this is an upper bound for both coordinates' errors together. NaN if the centre is NaN.
static inline double centre_slack(double2 centre, double2 vertex) {
  return 0x1p-34 * (fabs(centre.x - vertex.x) + fabs(centre.y - vertex.y)) +
         0x1p-50 * (fabs(vertex.x) + fabs(vertex.y));
}

// As centre_side by the rounded centre alone; 0 if that cannot tell.
static inline int centre_side_rounded(double2 centre, double slack, double2 v, double2 w) {
  const double2 e = w - v, f = centre - v;
  const double left = e.x * f.y, right = e.y * f.x;
  const double side = left - right;
  const double error = (fabs(e.x) + fabs(e.y)) * slack + 0x1p-50 * (fabs(left) + fabs(right));
  return side > error ? 1 : side < -error ? -1 : 0;
}

// |p - w|^2 - |q - w|^2, exact until it is rounded.
OUT_OF_LINE static inline double nearness_rounded(double2 p, double2 q, double2 w) {
  expansion sum;
  nearness_expansion(two_sum(p.x, -q.x), two_sum(p.y, -q.y), two_sum(p.x, -w.x), two_sum(p.y, -w.y), two_sum(q.x, -w.x),
                     two_sum(q.y, -w.y), &sum);
  return expansion_value(&sum);
}

// |p - w|^2 - |q - w|^2 from rounded differences, and in y the sum of the magnitudes of its terms.
static inline double2 nearness_with_magnitude(double2 p, double2 q, double2 w) {
  const double2 pq = p - q, wp = p - w, wq = q - w;
  return VECTOR(double2, pq.x * (wp.x + wq.x) + pq.y * (wp.y + wq.y),
                fabs(pq.x) * (fabs(wp.x) + fabs(wq.x)) + fabs(pq.y) * (fabs(wp.y) + fabs(wq.y)));
}

// Where differences of squares are smaller than their terms by more than this factor, they are computed exactly: so a
// crossing is wrong by less than 2^-45 of the segment's length, beside its last rounding.
#define CROSSING_CANCELLED 16.0

// The point at which the bisector of p and q crosses the segment from v to w, whose ends are on different sides of it
// or one on it. The same to the last bit for q and p.
static inline double2 bisector_crossing(double2 p, double2 q, double2 v, double2 w) {
  const double2 at_v = nearness_with_magnitude(p, q, v), at_w = nearness_with_magnitude(p, q, w);
  double before = fabs(at_v.x), behind = fabs(at_w.x);
  if (at_v.y + at_w.y > CROSSING_CANCELLED * (before + behind)) {
    before = fabs(nearness_rounded(p, q, v));
    behind = fabs(nearness_rounded(p, q, w));
  }
  const double whole = before + behind;
  const int is_near_v = before < behind;
  const double share = whole > 0.0 ? (is_near_v ? before : behind) / whole : 0.0;
  const double2 from = is_near_v ? v : w, to = is_near_v ? w : v;
  return VECTOR(double2, from.x + share * (to.x - from.x), from.y + share * (to.y - from.y));
}

END_SHARED

#endif
