// Stable radix sort of 64-bit keys with 32-bit payloads, least significant digit first.
//
// Two passes and a scan per digit: sort_count counts the digits of each work-group's tile into table[digit][group], the
// table is scanned, and sort_scatter moves. In a tile each work-item has `items` consecutive elements; its counters are
// column `local id` of count[][], so the order within a tile is that of the work-items and the sort is stable.
// sort_varying finds the bits in which keys differ at all, so that the host skips the other digits.

#include "arithmetic/language.h"

#ifndef SORT_BITS
#define SORT_BITS 8
#endif
#ifndef SORT_GROUP
#define SORT_GROUP 1
#endif
#define SORT_DIGITS (1 << SORT_BITS)

static inline uint digit_of(uint64 key, int shift) { return (uint)(key >> shift) & (SORT_DIGITS - 1); }

kernel void sort_varying(int n, int chunk, global const uint64* restrict keys, global volatile uint* restrict varying) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    const uint64 first = keys[0];
    uint64 bits = 0;
    for (int i = low; i < high; ++i) bits |= keys[i] ^ first;
    if ((uint)bits) atomic_or(&varying[0], (uint)bits);
    if ((uint)(bits >> 32)) atomic_or(&varying[1], (uint)(bits >> 32));
  }
}

__attribute__((reqd_work_group_size(SORT_GROUP, 1, 1))) kernel void sort_count(int n, int items, int shift,
                                                                               global const uint64* restrict keys,
                                                                               global uint* restrict table) {
  local uint count[SORT_DIGITS * SORT_GROUP];
  const int me = get_local_id(0);
  const int groups = get_num_groups(0);
  const int low = min(n, (int)get_global_id(0) * items);
  const int high = min(n, low + items);
  for (int d = 0; d < SORT_DIGITS; ++d) count[d * SORT_GROUP + me] = 0;
  for (int i = low; i < high; ++i) ++count[digit_of(keys[i], shift) * SORT_GROUP + me];
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int d = me; d < SORT_DIGITS; d += SORT_GROUP) {
    uint sum = 0;
    for (int w = 0; w < SORT_GROUP; ++w) sum += count[d * SORT_GROUP + w];
    table[d * groups + get_group_id(0)] = sum;
  }
}

__attribute__((reqd_work_group_size(SORT_GROUP, 1, 1))) kernel void sort_scatter(
    int n, int items, int shift, global const uint64* restrict keys, global const int* restrict payloads,
    global const uint* restrict table, global uint64* restrict sorted_keys, global int* restrict sorted_payloads) {
  local uint place[SORT_DIGITS * SORT_GROUP];
  const int me = get_local_id(0);
  const int groups = get_num_groups(0);
  const int low = min(n, (int)get_global_id(0) * items);
  const int high = min(n, low + items);
  for (int d = 0; d < SORT_DIGITS; ++d) place[d * SORT_GROUP + me] = 0;
#if SORT_GROUP > 1
  for (int i = low; i < high; ++i) ++place[digit_of(keys[i], shift) * SORT_GROUP + me];
#endif
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int d = me; d < SORT_DIGITS; d += SORT_GROUP) {
    uint sum = table[d * groups + get_group_id(0)];
    for (int w = 0; w < SORT_GROUP; ++w) {
      const uint mine = place[d * SORT_GROUP + w];
      place[d * SORT_GROUP + w] = sum;
      sum += mine;
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int i = low; i < high; ++i) {
    const uint64 key = keys[i];
    const uint to = place[digit_of(key, shift) * SORT_GROUP + me]++;
    sorted_keys[to] = key;
    sorted_payloads[to] = payloads[i];
  }
}
