// Input points to the points that the stages need: scaled, sorted, distinct and renumbered.
//
// keys_y, keys_x and keys_set make the keys of the radix sort. After the sort by y, then by x, and then by set,
// distinct_flags and distinct_write give each distinct point the id that is its rank in (set, x, y). sets_of_ids writes
// the set of each id. Each kernel is one pass over the points of all sets, with one work-item per point.

#include "arithmetic/coordinates.h"
#include "arithmetic/records.h"
#include "operations/search.h"

kernel void keys_y(int n, global const double2* restrict input, scaling scale, global uint64* restrict keys,
                   global int* restrict order) {
  const int i = get_global_id(0);
  if (i < n) {
    keys[i] = orderable(scaled(input[i].y, scale));
    order[i] = i;
  }
}

kernel void keys_x(int n, global const double2* restrict input, scaling scale, global const int* restrict order,
                   global uint64* restrict keys) {
  const int i = get_global_id(0);
  if (i < n) keys[i] = orderable(scaled(input[order[i]].x, scale));
}

kernel void keys_set(int n, int sets, global const int* restrict offsets, global const int* restrict order,
                     global uint64* restrict keys) {
  const int i = get_global_id(0);
  if (i < n) keys[i] = segment_of(order[i], sets, offsets);
}

// flags[i] = 1 where the sorted keys change, the first not counted; for dense ranks.
kernel void change_flags(int n, global const uint64* restrict keys, global uint* restrict flags) {
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
kernel void distinct_write(int n, global const double2* restrict input, scaling scale, global const int* restrict order,
                           global const uint* restrict ids, global const uint* restrict y_rank,
                           global double2* restrict points, global int* restrict source,
                           global uint64* restrict y_keys) {
  const int i = get_global_id(0);
  if (i < n && ids[i + 1] != ids[i]) {
    const int from = order[i];
    const double2 p = input[from];
    const uint id = ids[i];
    points[id] = VECTOR(double2, scaled(p.x, scale) + 0.0, scaled(p.y, scale) + 0.0);
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
kernel void keys_y_order(int n, int sets, global const int* restrict point_offsets, global uint64* restrict keys,
                         global int* restrict order) {
  const int i = get_global_id(0);
  if (i < n) {
    if (sets > 1) keys[i] |= (uint64)segment_of(i, sets, point_offsets) << 32;
    order[i] = i;
  }
}

kernel void sets_of_ids(int n, int sets, global const int* restrict offsets, global int* restrict set_of_id) {
  const int id = get_global_id(0);
  if (id < n) set_of_id[id] = segment_of(id, sets, offsets);
}
