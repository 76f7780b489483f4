// Products and sums of 128 and 256 bits, for exact predicates: see docs/exactness.md.
#ifndef FLAUNAY_INTEGER_ARITHMETIC_H
#define FLAUNAY_INTEGER_ARITHMETIC_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Modulo 2^128 and 2^256, and so in two's complement.
typedef struct {
  uint64 low, high;
} integer128;

typedef struct {
  integer128 low, high;
} integer256;

static inline int sign_of_64(int64 x) { return (x > 0) - (x < 0); }

static inline int sign_of_128(integer128 x) {
  const int sign = sign_of_64(as_long(x.high));
  return sign != 0 ? sign : x.low != 0;
}

static inline int sign_of_256(integer256 x) {
  const int sign = sign_of_128(x.high);
  return sign != 0 ? sign : (x.low.high | x.low.low) != 0;
}

static inline integer128 sum_128(integer128 a, integer128 b) {
  integer128 sum;
  sum.low = a.low + b.low;
  sum.high = a.high + b.high + (sum.low < a.low);
  return sum;
}

static inline integer128 difference_128(integer128 a, integer128 b) {
  integer128 difference;
  difference.low = a.low - b.low;
  difference.high = a.high - b.high - (a.low < b.low);
  return difference;
}

static inline integer128 widened(int64 x) {
  integer128 wide;
  wide.low = as_ulong(x);
  wide.high = x < 0 ? ~(uint64)0 : (uint64)0;
  return wide;
}

static inline integer128 product_128(int64 a, int64 b) {
  integer128 product;
  product.low = as_ulong(a) * as_ulong(b);
  product.high = as_ulong(high_product(a, b));
  return product;
}

static inline integer128 unsigned_product(uint64 a, uint64 b) {
  integer128 product;
  product.low = a * b;
  product.high = high_product(a, b);
  return product;
}

// Modulo 2^128.
static inline integer128 low_product(integer128 a, integer128 b) {
  integer128 product = unsigned_product(a.low, b.low);
  product.high += a.low * b.high + a.high * b.low;
  return product;
}

static inline integer128 plus_carry(integer128 a, uint64 b) {
  integer128 sum;
  sum.low = a.low + b;
  sum.high = a.high + (sum.low < b);
  return sum;
}

static inline integer256 product_256(integer128 a, integer128 b) {
  const integer128 al_bh = unsigned_product(a.low, b.high);
  const integer128 ah_bl = unsigned_product(a.high, b.low);
  integer256 product;
  product.low = unsigned_product(a.low, b.low);
  product.high = unsigned_product(a.high, b.high);
  // An upper half of a product is at most 2^64 - 2, so that the carry fits.
  product.low.high += al_bh.low;
  product.high = plus_carry(product.high, al_bh.high + (product.low.high < al_bh.low));
  product.low.high += ah_bl.low;
  product.high = plus_carry(product.high, ah_bl.high + (product.low.high < ah_bl.low));
  // A negative number was taken for one greater by 2^128.
  if (as_long(a.high) < 0) product.high = difference_128(product.high, b);
  if (as_long(b.high) < 0) product.high = difference_128(product.high, a);
  return product;
}

static inline integer256 difference_256(integer256 a, integer256 b) {
  integer256 difference;
  difference.low = difference_128(a.low, b.low);
  const int borrow = a.low.high != b.low.high ? a.low.high < b.low.high : a.low.low < b.low.low;
  const integer128 carried = {(uint64)borrow, 0};
  difference.high = difference_128(difference_128(a.high, b.high), carried);
  return difference;
}

static inline integer256 sum_256(integer256 a, integer256 b) {
  integer256 sum;
  sum.low = sum_128(a.low, b.low);
  const int carry = sum.low.high != b.low.high ? sum.low.high < b.low.high : sum.low.low < b.low.low;
  sum.high = plus_carry(sum_128(a.high, b.high), carry);
  return sum;
}

END_SHARED

#endif
