// The account of the coordinates: the range of their bits, and whether they are finite.
//
// inspect reads every coordinate once, with one work-item per chunk of points. If the magnitudes of sets differ too
// much for one scaling, inspect_sets makes an account per set, and scale_sets scales each set by its own; the latter
// has one work-item per point. widen_points converts floats to doubles, with one work-item per point.

#include "shared/codes.h"
#include "shared/coordinates.h"
#include "shared/prefetch.h"
#include "shared/search.h"

// What coordinates have in common: the largest magnitude, as its bits, and the exponent of the lowest set
// bit.
typedef struct {
  ulong most;
  int lowest;
} bit_account;

#define MAGNITUDE_BITS 0x7fffffffffffffffUL
#define MANTISSA_BITS 0x000fffffffffffffUL
#define HIDDEN_BIT 0x0010000000000000UL

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

// Points of single precision from `first` on.
kernel void widen_points(int n, ulong first, global const float* restrict narrow, global double* restrict points) {
  const int i = get_global_id(0);
  if (i < n) vstore2(convert_double2(vload2(first + i, narrow)), i, points);
}

// Adds the points [low, high) to an account.
static inline void inspect_points(int low, int high, global const double* input, global volatile int* account) {
  bit_account bits = {0, NO_LOWEST};
  int bad = NO_BAD;
  for (int i = low; i < high; ++i) {
    fetch(&input[2 * min(high - 1, i + STREAM_AHEAD)]);
    const double2 p = vload2(i, input);  // which need not be aligned as pairs
    if (isfinite(p.x) && isfinite(p.y)) {
      account_for(p.x, &bits);
      account_for(p.y, &bits);
    } else {
      bad = min(bad, i);
    }
  }
  const int largest = bits.most == 0 ? NO_LARGEST : unit_of(bits.most) + 63 - (int)clz(mantissa_of(bits.most));
  atomic_max(&account[INSPECT_LARGEST], largest);
  atomic_min(&account[INSPECT_LOWEST], bits.lowest);
  atomic_min(&account[INSPECT_BAD], bad);
}

kernel void inspect(int n, int chunk, global const double* restrict input, global volatile int* restrict account) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) inspect_points(low, min(n, low + chunk), input, account);
}

// accounts: one per set.
kernel void inspect_sets(int n, int chunk, int sets, global const int* restrict offsets,
                         global const double* restrict input, global volatile int* restrict accounts) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    for (int s = segment_of(low, sets, offsets); s < sets && offsets[s] < high; ++s) {
      inspect_points(max(low, offsets[s]), min(high, offsets[s + 1]), input, accounts + INSPECT_NUMBERS * s);
    }
  }
}

// shifts: by set.
kernel void scale_sets(int n, int sets, global const int* restrict offsets, global const int* restrict shifts,
                       global const double* restrict input, global double* restrict scaled_input) {
  const int i = get_global_id(0);
  if (i < n) vstore2(scaled_point(i, input, scale_of(shifts[segment_of(i, sets, offsets)])), i, scaled_input);
}
