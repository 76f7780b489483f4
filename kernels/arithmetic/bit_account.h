// The bits of coordinates as they come from the caller, in double precision: the account of them, which kernels of
// points/inspect.cl and points/inspect_tiles.cl make, and numbers in fixed point. They use integers alone, so
// that devices without double precision can read them.
#ifndef FLAUNAY_BIT_ACCOUNT_H
#define FLAUNAY_BIT_ACCOUNT_H

#include "arithmetic/language.h"
#include "arithmetic/numbers.h"

BEGIN_SHARED

// The exponents of a largest and a lowest bit, and the first point that is not finite, before any coordinate is seen.
INTEGER_CONSTANT(NO_LARGEST, -10000);
INTEGER_CONSTANT(NO_LOWEST, 10000);
INTEGER_CONSTANT(NO_BAD, 0x7fffffff);

// The account of coordinates: the largest magnitude, as its bits, and the exponent of the lowest set bit.
typedef struct {
  uint64 most;
  int lowest;
} bit_account;

#define MAGNITUDE_BITS 0x7fffffffffffffffUL
#define MANTISSA_BITS 0x000fffffffffffffUL
#define HIDDEN_BIT 0x0010000000000000UL
#define INFINITE_BITS 0x7ff0000000000000UL

static inline bit_account no_bits(void) {
  const bit_account none = {0, NO_LOWEST};
  return none;
}

// The exponent of the last bit that a double of this magnitude has room for.
static inline int unit_of(uint64 magnitude) { return max(1, (int)(magnitude >> 52)) - 1075; }
static inline uint64 mantissa_of(uint64 magnitude) {
  return (magnitude & MANTISSA_BITS) | (magnitude > MANTISSA_BITS ? HIDDEN_BIT : 0);
}

static inline void account_for(uint64 magnitude, bit_account* account) {
  account->most = max(account->most, magnitude);
  const int unit = unit_of(magnitude);
  if (unit < account->lowest && magnitude != 0) {
    const uint64 mantissa = mantissa_of(magnitude);
    account->lowest = min(account->lowest, unit + 63 - (int)clz(mantissa & (~mantissa + 1)));
  }
}

// bad: becomes the point, if it is not finite and comes before.
static inline void account_for_point(int i, GLOBAL const double_bits* input, bit_account* account, int* bad) {
  // Which need not be aligned as pairs.
  const uint64 x = input[2 * (int64)i] & MAGNITUDE_BITS, y = input[2 * (int64)i + 1] & MAGNITUDE_BITS;
  if (x < INFINITE_BITS && y < INFINITE_BITS) {
    account_for(x, account);
    account_for(y, account);
  } else {
    *bad = min(*bad, i);
  }
}

// The exponent of the largest magnitude.
static inline int largest_exponent(bit_account account) {
  return account.most == 0 ? NO_LARGEST : unit_of(account.most) + 63 - (int)clz(mantissa_of(account.most));
}

// A coordinate, times 2^shift, as an integer: which it is, by the host's choice of the shift.
static inline int64 fixed_point(uint64 bits, int shift) {
  const uint64 magnitude = bits & MAGNITUDE_BITS, mantissa = mantissa_of(magnitude);
  if (mantissa == 0) return 0;
  const int up = unit_of(magnitude) + shift;
  const int64 integer = as_long(up >= 0 ? mantissa << up : mantissa >> -up);
  return bits >> 63 ? -integer : integer;
}

// An unsigned number in the order of the coordinates; -0 counts as +0.
static inline uint64 order_of_bits(uint64 bits) {
  const uint64 magnitude = bits & MAGNITUDE_BITS;
  return bits == magnitude || magnitude == 0 ? ~MAGNITUDE_BITS | magnitude : ~bits;
}

// Whether point i comes before point j in the canonical order, by x, then by y.
static inline int lies_before(int i, int j, GLOBAL const double_bits* input) {
  const uint64 x = order_of_bits(input[2 * (int64)i]), other = order_of_bits(input[2 * (int64)j]);
  if (x != other) return x < other;
  return order_of_bits(input[2 * (int64)i + 1]) < order_of_bits(input[2 * (int64)j + 1]);
}

// The bits of the double that equals a float.
static inline uint64 widened_bits(uint bits) {
  const uint64 sign = (uint64)(bits >> 31) << 63, magnitude = bits & 0x7fffffffU;
  if (magnitude >= 0x7f800000U) return sign | INFINITE_BITS | (magnitude & 0x007fffffU) << 29;
  if (magnitude >= 0x00800000U) return sign | ((magnitude << 29) + ((uint64)(1023 - 127) << 52));
  if (magnitude == 0) return sign;
  // A subnormal number, of units of 2^-149, which becomes a normal one.
  const int leading = 63 - (int)clz(magnitude);
  return sign | ((uint64)(1023 - 149 + leading) << 52) | (magnitude << (52 - leading) & MANTISSA_BITS);
}

END_SHARED

#endif
