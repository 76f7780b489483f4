// Which of two points is nearer to a third: floating point with a bound first, exact where it cannot decide.
#ifndef FLAUNAY_NEARNESS_H
#define FLAUNAY_NEARNESS_H

#include "arithmetic/language.h"
#include "predicates/planar.h"

BEGIN_SHARED

// |a - q|^2 - |b - q|^2 is the dot product of a - b and (a - q) + (b - q). Its rounded value is wrong by less than
// 5.1 e of the magnitude below, which is rounded too, with e = ROUNDOFF (docs/exactness.md): NEARNESS_BOUND. In fixed
// point nothing underflows: differences are multiples of UNIT as real numbers, and their products of its square.

// 1 if b is nearer to q than a is, -1 if a is, 0 if neither, UNDECIDED.
static inline int nearness_filtered(coordinate2 a, coordinate2 b, coordinate2 q, filter_bound bound) {
  const real2 ab = difference2(a, b);
  const real2 qa = difference2(a, q);
  const real2 qb = difference2(b, q);
  const real dot = ab.x * (qa.x + qb.x) + ab.y * (qa.y + qb.y);
  const real magnitude = fabs(ab.x) * (fabs(qa.x) + fabs(qb.x)) + fabs(ab.y) * (fabs(qa.y) + fabs(qb.y));
  const real error = bound * magnitude;
  return dot > error ? 1 : dot < -error ? -1 : bound == 0 ? 0 : UNDECIDED;
}

#ifdef FIXED_POINT

// Below 2^127, as its terms are.
static inline integer128 squared_integer(coordinate2 a, coordinate2 q) {
  return sum_128(product_128(a.x - q.x, a.x - q.x), product_128(a.y - q.y, a.y - q.y));
}

OUT_OF_LINE static inline int nearness_exact(coordinate2 a, coordinate2 b, coordinate2 q) {
  return sign_of_128(difference_128(squared_integer(a, q), squared_integer(b, q)));
}

#else

// The dot product, of differences as two_sum gives them.
static inline void nearness_expansion(double2 abx, double2 aby, double2 qax, double2 qay, double2 qbx, double2 qby,
                                      expansion* sum) {
  sum->size = 0;
  expansion_add_product(sum, abx, qax);
  expansion_add_product(sum, abx, qbx);
  expansion_add_product(sum, aby, qay);
  expansion_add_product(sum, aby, qby);
}

OUT_OF_LINE static inline int nearness_exact(double2 a, double2 b, double2 q) {
  const double2 abx = two_sum(a.x, -b.x), aby = two_sum(a.y, -b.y);
  const double2 qax = two_sum(a.x, -q.x), qay = two_sum(a.y, -q.y);
  const double2 qbx = two_sum(b.x, -q.x), qby = two_sum(b.y, -q.y);
  const double largest = larger_magnitude(
      larger_magnitude(abx.x, aby.x), larger_magnitude(larger_magnitude(qax.x, qay.x), larger_magnitude(qbx.x, qby.x)));
  if (largest == 0.0) return 0;
  const double factor = unit_factor(largest, WIDE_BITS);
  int64 abxi, abyi, qaxi, qayi, qbxi, qbyi;
  if (is_integer(abx, factor, &abxi) & is_integer(aby, factor, &abyi) & is_integer(qax, factor, &qaxi) &
      is_integer(qay, factor, &qayi) & is_integer(qbx, factor, &qbxi) & is_integer(qby, factor, &qbyi))
    return sign_of_128(sum_128(product_128(abxi, qaxi + qbxi), product_128(abyi, qayi + qbyi)));
  expansion sum;
  nearness_expansion(abx, aby, qax, qay, qbx, qby, &sum);
  return expansion_sign(&sum);
}

#endif

static inline int nearness_sign(coordinate2 a, coordinate2 b, coordinate2 q, filter_bound bound) {
  const int sign = nearness_filtered(a, b, q, bound);
  return sign != UNDECIDED ? sign : nearness_exact(a, b, q);
}

END_SHARED

#endif
