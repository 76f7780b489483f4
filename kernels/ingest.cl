// From points as they come to points as the stages want them: checked, scaled, sorted, distinct, renumbered.
//
// widen_points makes doubles of floats. inspect looks at every coordinate once; keys_* make the radix sort's keys; after the sort by y and then by x (and by
// set), distinct_flags and distinct_write give each distinct point the id that is its rank in (set, x, y).
// Each pass is over all points of all sets.

#include "shared/coordinates.h"
#include "shared/search.h"

// Accounts of inspect, in one array of int.
#define INSPECT_LARGEST 0   // largest exponent of a leading bit
#define INSPECT_LOWEST 1    // smallest exponent of a lowest bit
#define INSPECT_BAD 2       // smallest index of a point that is not finite

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
  return (int2)(unit + 63 - (int)clz(mantissa), unit + trailing);
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
    int largest = -10000, lowest = 10000, bad = INT_MAX;
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

kernel void keys_y(int n, global const double2* restrict input, double s0, double s1, double s2,
                   global ulong* restrict keys, global int* restrict order) {
  const int i = get_global_id(0);
  if (i < n) {
    keys[i] = orderable(scaled(input[i].y, s0, s1, s2));
    order[i] = i;
  }
}

kernel void keys_x(int n, global const double2* restrict input, double s0, double s1, double s2,
                   global const int* restrict order, global ulong* restrict keys) {
  const int i = get_global_id(0);
  if (i < n) keys[i] = orderable(scaled(input[order[i]].x, s0, s1, s2));
}

kernel void keys_set(int n, int sets, global const int* restrict offsets, global const int* restrict order,
                     global ulong* restrict keys) {
  const int i = get_global_id(0);
  if (i < n) keys[i] = segment_of(order[i], sets, offsets);
}

// flags[i] = 1 where the sorted keys change, the first not counted; for dense ranks.
kernel void change_flags(int n, global const ulong* restrict keys, global uint* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) flags[i] = i > 0 && keys[i] != keys[i - 1];
}

// ranks of the input points, from the inclusive scan of change_flags.
kernel void write_ranks(int n, global const int* restrict order, global const uint* restrict scanned,
                        global uint* restrict rank) {
  const int i = get_global_id(0);
  // The scan is exclusive: element i + 1 includes i's flag.
  if (i < n) rank[order[i]] = scanned[i + 1];
}

// flags[i] = 1 if the i-th point in (set, x, y) order differs from the one before or begins a set.
kernel void distinct_flags(int n, int sets, global const int* restrict offsets, global const double2* restrict input,
                           global const int* restrict order, global uint* restrict flags) {
  const int i = get_global_id(0);
  if (i < n) {
    int first = i == 0;
    if (!first) {
      const double2 p = input[order[i]];
      const double2 before = input[order[i - 1]];
      first = p.x != before.x || p.y != before.y || (sets > 1 && offsets[segment_of(i, sets, offsets)] == i);
    }
    flags[i] = first;
  }
}

// ids[i] is the exclusive scan of distinct_flags. The sort was stable, so the first of equal points has the
// smallest index and represents them.
kernel void distinct_write(int n, global const double2* restrict input, double s0, double s1, double s2,
                           global const int* restrict order, global const uint* restrict ids,
                           global const uint* restrict y_rank, global double2* restrict points,
                           global int* restrict source, global ulong* restrict y_keys) {
  const int i = get_global_id(0);
  if (i < n && ids[i + 1] != ids[i]) {
    const int from = order[i];
    const double2 p = input[from];
    const uint id = ids[i];
    points[id] = (double2)(scaled(p.x, s0, s1, s2) + 0.0, scaled(p.y, s0, s1, s2) + 0.0);
    source[id] = from;
    y_keys[id] = y_rank[from];
  }
}

// A set's ids are consecutive: point_offsets[s] is the first of set s.
kernel void set_offsets(int n, global const int* restrict offsets, global const uint* restrict ids,
                        global int* restrict point_offsets) {
  const int s = get_global_id(0);
  if (s < n) point_offsets[s] = ids[offsets[s]];
}

kernel void representatives(int n, global const int* restrict order, global const uint* restrict ids,
                            global const int* restrict source, global int* restrict representative) {
  const int i = get_global_id(0);
  if (i < n) representative[order[i]] = source[ids[i + 1] - 1];
}

// Keys for the order by (set, y, x): stable from the order of ids, which is by (set, x, y).
kernel void keys_y_order(int n, int sets, global const int* restrict point_offsets, global ulong* restrict keys,
                         global int* restrict order) {
  const int i = get_global_id(0);
  if (i < n) {
    if (sets > 1) keys[i] |= (ulong)segment_of(i, sets, point_offsets) << 32;
    order[i] = i;
  }
}
