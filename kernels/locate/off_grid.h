// Queries that are not on the grid of points in fixed point, because they are finer or farther away: exact predicates
// on integers of 256 bits.
//
// Such a query is a multiple of 2^-FINER_PLACES of the grid, below 2^FARTHER_PLACES. So it has 190 bits, and a product
// with a difference of points 253; predicates are sums of two.
#ifndef FLAUNAY_OFF_GRID_H
#define FLAUNAY_OFF_GRID_H

#include "arithmetic/integer_arithmetic.h"
#include "arithmetic/language.h"
#include "arithmetic/numbers.h"
#include "locate/query_frames.h"
#include "predicates/planar.h"

BEGIN_SHARED

INTEGER_CONSTANT(FINER_PLACES, 64);
INTEGER_CONSTANT(FARTHER_PLACES, 125);

#ifdef FIXED_POINT

// An integer in two's complement, with the lowest part first.
#define WIDE_PARTS 4
typedef struct {
  uint64 part[WIDE_PARTS];
} wide;
typedef struct {
  wide x, y;
} wide2;

static inline wide wide_sum(wide a, wide b) {
  wide sum;
  uint64 carry = 0;
  for (int k = 0; k < WIDE_PARTS; ++k) {
    const uint64 with_carry = a.part[k] + carry;
    sum.part[k] = with_carry + b.part[k];
    carry = (with_carry < carry) | (sum.part[k] < with_carry);
  }
  return sum;
}

static inline wide wide_negative(wide a) {
  uint64 carry = 1;
  for (int k = 0; k < WIDE_PARTS; ++k) {
    a.part[k] = ~a.part[k] + carry;
    carry &= a.part[k] == 0;
  }
  return a;
}

static inline wide wide_difference(wide a, wide b) { return wide_sum(a, wide_negative(b)); }

static inline wide wide_product(int64 a, wide b) {
  const uint64 factor = as_ulong(a < 0 ? -a : a);
  wide product;
  uint64 carry = 0;
  for (int k = 0; k < WIDE_PARTS; ++k) {
    const uint64 low = factor * b.part[k];
    product.part[k] = low + carry;
    carry = high_product(factor, b.part[k]) + (product.part[k] < low);
  }
  return a < 0 ? wide_negative(product) : product;
}

static inline int wide_sign(wide a) {
  uint64 any = 0;
  for (int k = 0; k < WIDE_PARTS; ++k) any |= a.part[k];
  return as_long(a.part[WIDE_PARTS - 1]) < 0 ? -1 : any != 0;
}

// A point of the grid, as queries are.
static inline wide wide_place(coordinate x) {
  const uint64 sign = x < 0 ? ~(uint64)0 : (uint64)0;
  const wide place = {{0, as_ulong(x), sign, sign}};
  return place;
}
static inline wide2 wide_point(coordinate2 p) {
  const wide2 point = {wide_place(p.x), wide_place(p.y)};
  return point;
}

// A coordinate of the caller's, by the bits of the double, times 2^(shift + FINER_PLACES).
static inline wide wide_coordinate(uint64 bits, int shift) {
  const uint64 magnitude = bits & MAGNITUDE_BITS, mantissa = mantissa_of(magnitude);
  const int up = unit_of(magnitude) + shift + FINER_PLACES;
  wide x = {{0, 0, 0, 0}};
  if (mantissa == 0) return x;
  if (up <= 0) {
    x.part[0] = mantissa >> -up;
  } else {
    for (int k = 0; k < WIDE_PARTS; ++k) {
      const int at = up - 64 * k;  // of the lowest bit, in this part
      if (at >= 0 && at < 64) x.part[k] = mantissa << at;
      if (at < 0 && at > -64) x.part[k] = mantissa >> -at;
    }
  }
  return bits >> 63 ? wide_negative(x) : x;
}
static inline wide2 wide_query(int i, GLOBAL const coordinate* queries, int shift) {
  const coordinate2 bits = vload2(i, queries);
  const wide2 q = {wide_coordinate(as_ulong(bits.x), shift), wide_coordinate(as_ulong(bits.y), shift)};
  return q;
}

static inline int is_same_wide(wide a, wide b) {
  uint64 differ = 0;
  for (int k = 0; k < WIDE_PARTS; ++k) differ |= a.part[k] ^ b.part[k];
  return differ == 0;
}
// Whether the query is the place that kernels for queries on the grid take it for.
static inline int is_on_grid(wide2 q, coordinate2 place) {
  return is_same_wide(q.x, wide_place(place.x)) & is_same_wide(q.y, wide_place(place.y));
}
static inline int is_beyond_grid(coordinate2 place) {
  return max(max(place.x, -place.x), max(place.y, -place.y)) == LAST_PLACE;
}

// 1 if a, b, q turn left, -1 right, 0 straight.
static inline int orient_wide(coordinate2 a, coordinate2 b, wide2 q) {
  const wide2 from = wide_point(a);
  return wide_sign(wide_difference(wide_product(b.x - a.x, wide_difference(q.y, from.y)),
                                   wide_product(b.y - a.y, wide_difference(q.x, from.x))));
}

static inline wide wide_sum_from(wide a, wide b, wide q) {
  return wide_sum(wide_difference(a, q), wide_difference(b, q));
}

// 1 if b is nearer to q than a is, -1 if a is, 0 if neither: the sign of (a - b) ((a - q) + (b - q)).
static inline int nearness_wide(coordinate2 a, coordinate2 b, wide2 q) {
  const wide2 from_a = wide_point(a), from_b = wide_point(b);
  return wide_sign(wide_sum(wide_product(a.x - b.x, wide_sum_from(from_a.x, from_b.x, q.x)),
                            wide_product(a.y - b.y, wide_sum_from(from_a.y, from_b.y, q.y))));
}

#endif

END_SHARED

#endif
