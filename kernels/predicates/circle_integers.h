// The in-circle determinant of integers: differences of three points from the fourth.
#ifndef FLAUNAY_CIRCLE_INTEGERS_H
#define FLAUNAY_CIRCLE_INTEGERS_H

#include "arithmetic/integer_arithmetic.h"
#include "arithmetic/language.h"

BEGIN_SHARED

static inline integer128 cross_product(int64 ax, int64 ay, int64 bx, int64 by) {
  return difference_128(product_128(ax, by), product_128(ay, bx));
}

static inline integer128 dot_product(int64 ax, int64 ay, int64 bx, int64 by) {
  return sum_128(product_128(ax, bx), product_128(ay, by));
}

// The terms of in-circle tests: the angles under which the fourth point and c see the edge from a to b, as in
// predicates/planar.h.
typedef struct {
  integer128 dot, cross, other_dot, other_cross;
} integer_angles;

static inline integer_angles angles_of(int64 ax, int64 ay, int64 bx, int64 by, int64 cx, int64 cy) {
  integer_angles angles;
  angles.dot = dot_product(ax, ay, bx, by);
  angles.cross = cross_product(ax, ay, bx, by);
  ax -= cx;
  ay -= cy;
  bx -= cx;
  by -= cy;
  angles.other_dot = dot_product(ax, ay, bx, by);
  angles.other_cross = cross_product(ax, ay, bx, by);
  return angles;
}

// The in-circle test of differences below 2^SHORT_BITS, whose dot and cross products are below 2^63.
#define SHORT_BITS 30
static inline int circle_short(int64 ax, int64 ay, int64 bx, int64 by, int64 cx, int64 cy) {
  const int64 dot = ax * bx + ay * by, cross = ax * by - ay * bx;
  ax -= cx;
  ay -= cy;
  bx -= cx;
  by -= cy;
  const int64 other_dot = ax * bx + ay * by, other_cross = ax * by - ay * bx;
  return sign_of_128(difference_128(product_128(other_dot, cross), product_128(dot, other_cross)));
}

// Modulo 2^128, of a determinant that is known to be below 2^127.
static inline int circle_middle(int64 ax, int64 ay, int64 bx, int64 by, int64 cx, int64 cy) {
  const integer_angles of = angles_of(ax, ay, bx, by, cx, cy);
  return sign_of_128(difference_128(low_product(of.other_dot, of.cross), low_product(of.dot, of.other_cross)));
}

// The determinant, of differences that are below 2^63, as are those between any two of them: dot and cross products are
// below 2^127.
static inline integer256 circle_wide(int64 ax, int64 ay, int64 bx, int64 by, int64 cx, int64 cy) {
  const integer_angles of = angles_of(ax, ay, bx, by, cx, cy);
  return difference_256(product_256(of.other_dot, of.cross), product_256(of.dot, of.other_cross));
}

END_SHARED

#endif
