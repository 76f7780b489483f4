// The positions at which an array of flags holds a given value, in order, as in pack.cl; for devices with many lanes:
// by work-groups.
//
// Spans and tiles are as in scan_tiles.cl. Two passes: pack_span_counts counts in each span, and pack_spans
// adds up the counts of the spans before, reads the flags again and writes. If there is a single span,
// pack_spans does it alone.

#include "operations/limits.h"
#include "operations/work_group.h"

SCAN_IN_GROUP(scan_counts, uint)

kernel void pack_span_counts(int n, int spans, int span, global const uchar* restrict flags, int wanted,
                             global uint* restrict counts) {
  local uint places[LARGEST_TILE_GROUP];
  const int g = get_group_id(0), me = get_local_id(0), group = get_local_size(0);
  const int low = g < spans ? g * span : n, high = low + min(span, n - low);
  uint count = 0, total;
  for (int i = low + me; i < high; i += group) count += flags[i] == wanted;
  scan_counts(count, places, &total);
  if (g < spans && me == 0) counts[g] = total;
}

// total: gets the number of positions.
kernel void pack_spans(int n, int spans, int span, int items, global const uchar* restrict flags, int wanted,
                       global const uint* restrict counts, global int* restrict positions,
                       global uint* restrict total) {
  local uint places[LARGEST_TILE_GROUP];
  const int g = get_group_id(0), me = get_local_id(0), group = get_local_size(0);
  const int low = g < spans ? g * span : n, high = low + min(span, n - low);
  uint count = 0, prefix = 0, all;
  if (spans > 1 && g < spans) {
    for (int k = me; k < g; k += group) count += counts[k];
  }
  scan_counts(count, places, &prefix);
  for (int begin = low; begin < high; begin += items * group) {
    const int mine = begin + me * items, end = min(high, mine + items);
    count = 0;
    for (int i = mine; i < end; ++i) count += flags[i] == wanted;
    uint place = prefix + scan_counts(count, places, &all);
    for (int i = mine; i < end; ++i) {
      if (flags[i] == wanted) positions[place++] = i;
    }
    prefix += all;
  }
  if (g == spans - 1 && me == 0) total[0] = prefix;
}
