// The account of the coordinates: the range of their bits, and whether they are finite.
//
// inspect reads every coordinate once, with one work-item per chunk of points. If the magnitudes of sets differ too
// much for one scaling, inspect_sets makes an account per set, and scale_sets scales each set by its own; the latter
// has one work-item per point. In fixed point it always runs, and makes integers. widen_points converts floats to
// doubles, with one work-item per point. For devices with many lanes, inspect_tiles.cl takes the place of inspect.

#include "arithmetic/bit_account.h"
#include "arithmetic/coordinates.h"
#include "operations/prefetch.h"
#include "operations/search.h"
#include "points/codes.h"

// Points of single precision from `first` on. They become the bits of doubles.
kernel void widen_points(int n, uint64 first, global const float_bits* restrict narrow,
                         global double_bits* restrict points) {
  const int i = get_global_id(0);
  if (i < n) {
    points[2 * (int64)i] = widened_bits(narrow[2 * (first + i)]);
    points[2 * (int64)i + 1] = widened_bits(narrow[2 * (first + i) + 1]);
  }
}

// Adds the points [low, high) to an account.
static inline void inspect_points(int low, int high, global const double_bits* input, global volatile int* account) {
  bit_account bits = no_bits();
  int bad = NO_BAD;
  for (int i = low; i < high; ++i) {
    fetch(&input[2 * min(high - 1, i + STREAM_AHEAD)]);
    account_for_point(i, input, &bits, &bad);
  }
  atomic_max(&account[INSPECT_LARGEST], largest_exponent(bits));
  atomic_min(&account[INSPECT_LOWEST], bits.lowest);
  atomic_min(&account[INSPECT_BAD], bad);
}

kernel void inspect(int n, int chunk, global const double_bits* restrict input, global volatile int* restrict account) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) inspect_points(low, min(n, low + chunk), input, account);
}

// accounts: one per set.
kernel void inspect_sets(int n, int chunk, int sets, global const int* restrict offsets,
                         global const double_bits* restrict input, global volatile int* restrict accounts) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    for (int s = segment_of(low, sets, offsets); s < sets && offsets[s] < high; ++s) {
      inspect_points(max(low, offsets[s]), min(high, offsets[s + 1]), input, accounts + INSPECT_NUMBERS * s);
    }
  }
}

// shifts: by set. Without double precision, points are made of the bits of doubles.
kernel void scale_sets(int n, int sets, global const int* restrict offsets, global const int* restrict shifts,
                       global const double_bits* restrict input, global coordinate* restrict scaled_input) {
  const int i = get_global_id(0);
  if (i < n) {
    const int shift = shifts[segment_of(i, sets, offsets)];
    scaled_input[2 * (int64)i] = scaled_bits(input[2 * (int64)i], shift);
    scaled_input[2 * (int64)i + 1] = scaled_bits(input[2 * (int64)i + 1], shift);
  }
}
