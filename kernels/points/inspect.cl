// The account of the coordinates: the range of their bits, and whether they are finite.
//
// inspect reads every coordinate once, with one work-item per chunk of points. widen_points converts floats to doubles,
// with one work-item per point.

#include "shared/codes.h"
#include "shared/coordinates.h"

// Exponents of the leading and of the lowest set bit of a finite x other than 0.
static inline int2 bit_range(double x) {
  const ulong bits = as_ulong(x) & 0x7fffffffffffffffUL;
  const int field = (int)(bits >> 52);
  ulong mantissa = bits & 0x000fffffffffffffUL;
  int unit = -1074;
  if (field > 0) {
    mantissa |= 0x0010000000000000UL;
    unit = field - 1075;
  }
  const int trailing = (int)popcount((mantissa & (~mantissa + 1)) - 1);
  return VECTOR(int2, unit + 63 - (int)clz(mantissa), unit + trailing);
}

// Points of single precision from `first` on.
kernel void widen_points(int n, ulong first, global const float* restrict narrow, global double* restrict points) {
  const int i = get_global_id(0);
  if (i < n) vstore2(convert_double2(vload2(first + i, narrow)), i, points);
}

kernel void inspect(int n, int chunk, global const double* restrict input, global volatile int* restrict accounts) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    int largest = NO_LARGEST, lowest = NO_LOWEST, bad = NO_BAD;
    for (int i = low; i < high; ++i) {
      const double2 p = vload2(i, input);  // which need not be aligned as pairs
      if (!isfinite(p.x) || !isfinite(p.y)) {
        bad = min(bad, i);
        continue;
      }
      if (p.x != 0.0) {
        const int2 range = bit_range(p.x);
        largest = max(largest, range.x);
        lowest = min(lowest, range.y);
      }
      if (p.y != 0.0) {
        const int2 range = bit_range(p.y);
        largest = max(largest, range.x);
        lowest = min(lowest, range.y);
      }
    }
    atomic_max(&accounts[INSPECT_LARGEST], largest);
    atomic_min(&accounts[INSPECT_LOWEST], lowest);
    atomic_min(&accounts[INSPECT_BAD], bad);
  }
}
