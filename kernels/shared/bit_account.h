// The account of the bits of coordinates, which kernels of points/inspect.cl and points/inspect_tiles.cl make. It needs
// isfinite, which C++ has for kernels alone (host/native/opencl.hpp).
#ifndef FLAUNAY_BIT_ACCOUNT_H
#define FLAUNAY_BIT_ACCOUNT_H

#include "shared/codes.h"
#include "shared/language.h"

BEGIN_SHARED

// What coordinates have in common: the largest magnitude, as its bits, and the exponent of the lowest set bit.
typedef struct {
  ulong most;
  int lowest;
} bit_account;

#define MAGNITUDE_BITS 0x7fffffffffffffffUL
#define MANTISSA_BITS 0x000fffffffffffffUL
#define HIDDEN_BIT 0x0010000000000000UL

static inline bit_account no_bits(void) {
  const bit_account none = {0, NO_LOWEST};
  return none;
}

// The exponent of the last bit that a double of this magnitude has room for.
static inline int unit_of(ulong magnitude) { return max(1, (int)(magnitude >> 52)) - 1075; }
static inline ulong mantissa_of(ulong magnitude) {
  return (magnitude & MANTISSA_BITS) | (magnitude > MANTISSA_BITS ? HIDDEN_BIT : 0);
}

static inline void account_for(double x, bit_account* account) {
  const ulong magnitude = as_ulong(x) & MAGNITUDE_BITS;
  account->most = max(account->most, magnitude);
  if (magnitude != 0) {
    const ulong mantissa = mantissa_of(magnitude);
    account->lowest = min(account->lowest, unit_of(magnitude) + 63 - (int)clz(mantissa & (~mantissa + 1)));
  }
}

// bad: becomes the point, if it is not finite and comes before.
static inline void account_for_point(int i, GLOBAL const double* input, bit_account* account, int* bad) {
  const double2 p = vload2(i, input);  // which need not be aligned as pairs
  if (isfinite(p.x) && isfinite(p.y)) {
    account_for(p.x, account);
    account_for(p.y, account);
  } else {
    *bad = min(*bad, i);
  }
}

// The exponent of the largest magnitude.
static inline int largest_exponent(bit_account account) {
  return account.most == 0 ? NO_LARGEST : unit_of(account.most) + 63 - (int)clz(mantissa_of(account.most));
}

END_SHARED

#endif
