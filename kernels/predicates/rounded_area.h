// Areas of triangles as the doubles next to them, from the bits of coordinates: on every device the same, also without
// double precision.
#ifndef FLAUNAY_ROUNDED_AREA_H
#define FLAUNAY_ROUNDED_AREA_H

#include "arithmetic/bit_account.h"
#include "arithmetic/exact_arithmetic.h"
#include "arithmetic/integer_arithmetic.h"
#include "arithmetic/language.h"
#include "arithmetic/numbers.h"

BEGIN_SHARED

// Twice the area is a sum of six products of coordinates. As multiples of the lowest bit that any of them can have,
// they have at most 2 * 2046 + 106 bits, and their sum three more.
#define AREA_WORDS 66
#define LOWEST_UNIT (-1074)
#define BITS_OF_DOUBLE 53

// Adds the product of two coordinates to the sum, in two's complement, or subtracts it.
static inline void add_product(uint64 a, uint64 b, int is_subtracted, int lowest, int words, uint64* sum) {
  const uint64 p = a & MAGNITUDE_BITS, q = b & MAGNITUDE_BITS;
  if (p == 0 || q == 0) return;
  const integer128 product = unsigned_product(mantissa_of(p), mantissa_of(q));
  const int shift = unit_of(p) + unit_of(q) - lowest, bits = shift & 63;
  const uint64 parts[3] = {product.low << bits, product.high << bits | (bits == 0 ? 0 : product.low >> (64 - bits)),
                           bits == 0 ? 0 : product.high >> (64 - bits)};
  const int is_negative = (int)(a >> 63) ^ (int)(b >> 63) ^ is_subtracted;
  uint64 carry = 0;
  for (int k = 0, w = shift >> 6; w < words && (k < 3 || carry != 0); ++k, ++w) {
    const uint64 part = k < 3 ? parts[k] : 0, before = sum[w];
    if (is_negative) {
      sum[w] = before - part - carry;
      carry = before < part || (before == part && carry != 0);
    } else {
      sum[w] = before + part + carry;
      carry = sum[w] < before || (sum[w] == before && carry != 0);
    }
  }
}

// The lowest and the highest unit of a product that is not 0.
static inline void note_product(uint64 a, uint64 b, int* lowest, int* highest) {
  const uint64 p = a & MAGNITUDE_BITS, q = b & MAGNITUDE_BITS;
  if (p == 0 || q == 0) return;
  *lowest = min(*lowest, unit_of(p) + unit_of(q));
  *highest = max(*highest, unit_of(p) + unit_of(q));
}

// 64 bits from this one on.
static inline uint64 bits_from(const uint64* sum, int words, int first) {
  const int w = first >> 6, bits = first & 63;
  const uint64 low = w < words ? sum[w] : 0, high = w + 1 < words ? sum[w + 1] : 0;
  return bits == 0 ? low : low >> bits | high << (64 - bits);
}

// The bits of half a sum in multiples of 2^lowest, rounded to the nearest double, ties to even. Negates the sum if it
// is negative.
static inline uint64 half_rounded(uint64* sum, int words, int lowest) {
  const uint64 sign = sum[words - 1] & ~MAGNITUDE_BITS;
  uint64 carry = sign != 0;
  int top = -1;
  for (int w = 0; w < words; ++w) {
    if (sign != 0) {
      sum[w] = ~sum[w] + carry;
      carry &= sum[w] == 0;
    }
    if (sum[w] != 0) top = 64 * w + 63 - (int)clz(sum[w]);
  }
  if (top < 0) return 0;
  // The last bit that the double has room for, and its place in the sum.
  const int unit = max(lowest + top - BITS_OF_DOUBLE, LOWEST_UNIT), place = unit + 1 - lowest;
  if (unit > 1023 - BITS_OF_DOUBLE + 1) return sign | INFINITE_BITS;
  uint64 mantissa = 0;
  if (place <= 0) {
    mantissa = sum[0] << -place;
  } else if (place <= top + 1) {
    mantissa = place <= top ? bits_from(sum, words, place) : 0;
    const int below = place - 1;
    int is_more = (sum[below >> 6] & (((uint64)1 << (below & 63)) - 1)) != 0;
    for (int w = 0; w < below >> 6; ++w) is_more |= sum[w] != 0;
    if ((sum[below >> 6] >> (below & 63) & 1) != 0 && (is_more || (mantissa & 1) != 0)) ++mantissa;
  }
  // With its highest bit, a mantissa increments the exponent; so it does if it was rounded up to a power of two.
  const uint64 bits = ((uint64)(unit - LOWEST_UNIT) << 52) + mantissa;
  return sign | (bits < INFINITE_BITS ? bits : INFINITE_BITS);
}

// Computes the area with integers alone.
OUT_OF_LINE static inline uint64 area_by_integers(const uint64* x, const uint64* y) {
  int lowest = 2 * LOWEST_UNIT + 4096, highest = 2 * LOWEST_UNIT;
  for (int k = 0; k < 3; ++k) {
    const int next = k == 2 ? 0 : k + 1;
    note_product(x[k], y[next], &lowest, &highest);
    note_product(y[k], x[next], &lowest, &highest);
  }
  if (highest < lowest) return 0;
  const int words = (highest - lowest + 2 * BITS_OF_DOUBLE + 3) / 64 + 1;
  uint64 sum[AREA_WORDS];
  for (int w = 0; w < words; ++w) sum[w] = 0;
  for (int k = 0; k < 3; ++k) {
    const int next = k == 2 ? 0 : k + 1;
    add_product(x[k], y[next], 0, lowest, words, sum);
    add_product(y[k], x[next], 1, lowest, words, sum);
  }
  return half_rounded(sum, words, lowest);
}

#ifndef FIXED_POINT

// Whether twice the precision of doubles decides how the area is rounded; it is then put into *area.
static inline int area_by_doubles(double2 a, double2 b, double2 c, double* area) {
  const double2 bx = two_sum(b.x, -a.x), by = two_sum(b.y, -a.y), cx = two_sum(c.x, -a.x), cy = two_sum(c.y, -a.y);
  const double2 left = two_product(bx.x, cy.x), right = two_product(by.x, cx.x), high = two_sum(left.x, -right.x);
  const double p = bx.x * cy.y, q = bx.y * cy.x, r = by.x * cx.y, s = by.y * cx.x;
  const double low = high.y + ((left.y - right.y) + ((p + q) - (r + s)));
  // Rounding loses less than 2^-49 of the terms of `low`, and underflow less than 2^-1060.
  const double terms = fabs(high.y) + fabs(left.y) + fabs(right.y) + fabs(p) + fabs(q) + fabs(r) + fabs(s);
  const double error = 0x1p-48 * terms + 0x1p-1060;
  const double most = high.x + (low + error);
  *area = 0.5 * most;
  return (high.x + (low - error) == most) & (fabs(most) < INFINITY);
}

#endif

// The bits of the area of a triangle with these corners, positive if they are counter-clockwise. input: the bits of the
// coordinates, which are finite.
static inline uint64 rounded_area(GLOBAL const double_bits* input, int a, int b, int c) {
  const uint64 x[3] = {input[2 * (int64)a], input[2 * (int64)b], input[2 * (int64)c]};
  const uint64 y[3] = {input[2 * (int64)a + 1], input[2 * (int64)b + 1], input[2 * (int64)c + 1]};
#ifndef FIXED_POINT
  double area;
  if (area_by_doubles(VECTOR(double2, as_double(x[0]), as_double(y[0])),
                      VECTOR(double2, as_double(x[1]), as_double(y[1])),
                      VECTOR(double2, as_double(x[2]), as_double(y[2])), &area)) {
    return as_ulong(area);
  }
#endif
  return area_by_integers(x, y);
}

END_SHARED

#endif
