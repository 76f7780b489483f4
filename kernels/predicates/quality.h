// The decisions of mesh refinement, which computes in doubles everywhere: floating point with a bound first, exact
// where that cannot decide. Points are as predicates/bounds.h limits them.
#ifndef FLAUNAY_QUALITY_H
#define FLAUNAY_QUALITY_H

#include "arithmetic/exact_arithmetic.h"
#include "arithmetic/language.h"
#include "predicates/area.h"
#include "predicates/planar.h"

#ifndef FIXED_POINT

BEGIN_SHARED

// Squared sines and cosines that angles are held against, `square` below: from 0 to 1, multiples of 2^-56. With
// products of four differences, which are multiples of 2^-1020 below 2^1006, they make multiples of 2^-1076; multiplied
// by SQUARE_SCALE, multiples of 2^-1060 below 2^1022, which doubles can be.
#define SQUARE_SCALE 0x1p16
#define SQUARE_SCALE_ROOT 0x1p8

// With e = DOUBLE_ROUNDOFF and u, v the lengths of two vectors: their dot or cross product has an error below
// 4.01 e u v, its square one of 8.03 e u^2 v^2 and one more e for rounding; `square` times u^2 v^2, which has nine
// factors of 1 + e, one of 11.02 e u^2 v^2. The sum is 20.06; underflow in the last product adds a quarter.
#define SQUARE_BOUND (24 * DOUBLE_ROUNDOFF)

// With c a cosine, given as the dot product and the product of both vectors' squared lengths: the sign of c |c| -
// square, or UNDECIDED.
static inline int cosine_filtered(double dot, double lengths, double square) {
  const double signed_square = dot * fabs(dot);
  if (signed_square > (square + SQUARE_BOUND) * lengths) return 1;
  return signed_square < (square - SQUARE_BOUND) * lengths ? -1 : UNDECIDED;
}

// The same of the vectors from a to b and from c to d, exactly; 0 if one has no length.
OUT_OF_LINE static inline int cosine_exact(double2 a, double2 b, double2 c, double2 d, double square) {
  const double2 ux = two_sum(b.x, -a.x), uy = two_sum(b.y, -a.y);
  const double2 v[2] = {two_sum(d.x, -c.x), two_sum(d.y, -c.y)};
  expansion product, sum;
  product.size = 0;
  expansion_add_product(&product, ux, v[0]);
  expansion_add_product(&product, uy, v[1]);
  const int sign = expansion_sign(&product);
  if ((sign < 0) | (square == 0.0)) return sign;
  expansion_compress(&product);
  for (int i = 0; i < product.size; ++i) product.part[i] = product.part[i] * SQUARE_SCALE_ROOT;
  sum = product;
  expansion_multiply(&sum, product.part, product.size);
  const double factor = square * SQUARE_SCALE;
  for (int k = 0; k < 2; ++k) {
    const double lengths[2] = {v[k].x, v[k].y};
    product.size = 0;
    expansion_add_product(&product, ux, ux);
    expansion_add_product(&product, uy, uy);
    expansion_multiply(&product, &factor, 1);
    expansion_multiply(&product, lengths, 2);
    expansion_multiply(&product, lengths, 2);
    for (int i = 0; i < product.size; ++i) expansion_add(&sum, -product.part[i]);
    expansion_compress(&sum);
  }
  return expansion_sign(&sum);
}

static inline int cosine_sign(double2 a, double2 b, double2 c, double2 d, double square) {
  const double2 u = b - a, v = d - c;
  const int sign = cosine_filtered(u.x * v.x + u.y * v.y, squared_length(u) * squared_length(v), square);
  return sign != UNDECIDED ? sign : cosine_exact(a, b, c, d, square);
}

// A sine is the cosine to the other vector turned by a right angle.
static inline double2 turned_right(double2 p) { return VECTOR(double2, p.y, -p.x); }

// Whether the squared sine of a triangle's smallest angle is below this one, or UNDECIDED. The triangle is
// counter-clockwise, its sides have the squared lengths u, v and w, and two of them this cross product. All
// sines have the same numerator, the cross product; the smallest has the largest denominator, the product of
// the two longest sides. The bound includes the rounding of the difference.
static inline int sine_of_sides_filtered(double cross, double u, double v, double w, double squared_sine) {
  const double longer = u > v ? u : v, shorter = u < v ? u : v, lengths = longer * (shorter > w ? shorter : w);
  const double excess = cross * fabs(cross) - squared_sine * lengths;
  return fabs(excess) > SQUARE_BOUND * lengths ? excess < 0.0 : UNDECIDED;
}
static inline int sine_filtered(double2 a, double2 b, double2 c, double squared_sine) {
  const double2 u = b - a, v = c - b;
  return sine_of_sides_filtered(u.x * v.y - u.y * v.x, squared_length(u), squared_length(v), squared_length(a - c),
                                squared_sine);
}

OUT_OF_LINE static inline int is_angle_below_exact(double2 a, double2 b, double2 c, double squared_sine) {
  for (int corner = 0; corner < 3; ++corner) {
    if (cosine_sign(a, b, turned_right(a), turned_right(c), squared_sine) < 0) return 1;
    const double2 first = a;
    a = b;
    b = c;
    c = first;
  }
  return 0;
}

// Whether an angle of a counter-clockwise triangle is smaller than the acute one of this squared sine, below 3/4. (If
// an obtuse angle has a smaller sine, the other two angles are smaller than that.)
static inline int is_angle_below(double2 a, double2 b, double2 c, double squared_sine) {
  const int is_below = sine_filtered(a, b, c, squared_sine);
  return is_below != UNDECIDED ? is_below : is_angle_below_exact(a, b, c, squared_sine);
}

OUT_OF_LINE static inline int is_area_above_exact(double2 a, double2 b, double2 c, double area) {
  const double2 ax = two_sum(a.x, -c.x), ay = two_sum(a.y, -c.y);
  const double2 bx = two_sum(b.x, -c.x), by = two_sum(b.y, -c.y);
  expansion sum;
  expansion_cross(ax, ay, bx, by, &sum);
  expansion_add(&sum, -2 * area);
  return expansion_sign(&sum) > 0;
}

// Whether a counter-clockwise triangle is larger than that. The error of twice its area is below 4.01 e of the
// magnitude; a difference that is rounded exceeds 5 e of it only if the difference itself exceeds that error.
static inline int is_area_above(double2 a, double2 b, double2 c, double area) {
  const double2 twice = area_filtered(a, b, c);
  const double excess = twice.x - 2 * area;
  if (fabs(excess) > 5 * DOUBLE_ROUNDOFF * twice.y) return excess > 0.0;
  return is_area_above_exact(a, b, c, area);
}

// Whether p sees the segment from a to b under an angle whose cosine is at most -sqrt(squared_cosine); with 0, whether
// it is inside the circle over the segment, or on it. An end of the segment does.
static inline int is_encroached(double2 a, double2 b, double2 p, double squared_cosine) {
  return cosine_sign(a, p, p, b, squared_cosine) >= 0;
}

// The sign of the length from a to b less that from c to d. Squared lengths have an error below 4.01 e of themselves.
OUT_OF_LINE static inline int length_sign_exact(double2 a, double2 b, double2 c, double2 d) {
  const double2 ux = two_sum(b.x, -a.x), uy = two_sum(b.y, -a.y), vx = two_sum(d.x, -c.x), vy = two_sum(d.y, -c.y);
  expansion sum;
  sum.size = 0;
  expansion_add_product(&sum, ux, ux);
  expansion_add_product(&sum, uy, uy);
  expansion_add_product(&sum, vx, -vx);
  expansion_add_product(&sum, vy, -vy);
  return expansion_sign(&sum);
}
static inline int length_sign(double2 a, double2 b, double2 c, double2 d) {
  const double u = squared_length(b - a), v = squared_length(d - c);
  if (fabs(u - v) > 6 * DOUBLE_ROUNDOFF * (u + v)) return u > v ? 1 : -1;
  return length_sign_exact(a, b, c, d);
}

// Angles below this one are sharp. It is 6e-8 below 60 degrees, so that a corner of 60 degrees is never sharp because
// points are rounded.
#define SHARP_SQUARED_COSINE (0.25 + 0x1p-30)

// Whether the angle at v between a and b is sharp.
static inline int is_sharp(double2 v, double2 a, double2 b) {
  return cosine_sign(v, a, v, b, SHARP_SQUARED_COSINE) > 0;
}

END_SHARED

#endif

#endif
