// Exclusive prefix sums as in scan.cl, for devices with many lanes: by work-groups.
//
// Each work-group takes `span` consecutive elements, and there are so few groups that each can add up the sums of all
// groups before it. So there are two passes: scan_span_sums_T sums each span, and scan_spans_T walks it again from its
// prefix, tile by tile. In a tile each work-item has `items` consecutive elements. A scan of a single span is one pass,
// of scan_spans_T alone. The total goes to output[n]. Input and output may be the same array.

#include "arithmetic/language.h"
#include "operations/limits.h"
#include "operations/work_group.h"

SCAN_IN_GROUP(scan_in_group_uint, uint)
SCAN_IN_GROUP(scan_in_group_uint2, uint2)
SCAN_IN_GROUP(scan_in_group_uint8, uint8)

// Elements [begin, end) from this work-item's own on, a group apart.
#define SUM_OF(values, begin, end) \
  for (int i = (begin) + (int)get_local_id(0); i < (end); i += get_local_size(0)) sum += (values)[i]

#define SCAN_SPAN_SUMS(T, SCAN)                                              \
  local T places[LARGEST_TILE_GROUP];                                        \
  const int g = get_group_id(0);                                             \
  const int low = g < spans ? g * span : n, high = low + min(span, n - low); \
  T sum = 0, total;                                                          \
  SUM_OF(input, low, high);                                                  \
  SCAN(sum, places, &total);                                                 \
  if (g < spans && get_local_id(0) == 0) sums[g] = total;

#define SCAN_SPANS(T, SCAN)                                                  \
  local T places[LARGEST_TILE_GROUP];                                        \
  const int g = get_group_id(0);                                             \
  const int tile = items * get_local_size(0);                                \
  const int low = g < spans ? g * span : n, high = low + min(span, n - low); \
  T sum = 0, prefix = 0, total;                                              \
  SUM_OF(sums, 0, spans > 1 && g < spans ? g : 0);                           \
  SCAN(sum, places, &prefix);                                                \
  for (int begin = low; begin < high; begin += tile) {                       \
    const int mine = begin + (int)get_local_id(0) * items;                   \
    const int end = min(high, mine + items);                                 \
    sum = 0;                                                                 \
    for (int i = mine; i < end; ++i) sum += input[i];                        \
    T place = prefix + SCAN(sum, places, &total);                            \
    for (int i = mine; i < end; ++i) {                                       \
      const T value = input[i];                                              \
      output[i] = place;                                                     \
      place += value;                                                        \
    }                                                                        \
    prefix += total;                                                         \
  }                                                                          \
  if (g == spans - 1 && get_local_id(0) == 0) output[n] = prefix;

kernel void scan_span_sums_uint(int n, int spans, int span, global const uint* input,
                                global uint* sums){SCAN_SPAN_SUMS(uint, scan_in_group_uint)}

kernel void scan_spans_uint(int n, int spans, int span, int items, global const uint* sums, global const uint* input,
                            global uint* output){SCAN_SPANS(uint, scan_in_group_uint)}

kernel void scan_span_sums_uint2(int n, int spans, int span, global const uint2* input,
                                 global uint2* sums){SCAN_SPAN_SUMS(uint2, scan_in_group_uint2)}

kernel void scan_spans_uint2(int n, int spans, int span, int items, global const uint2* sums, global const uint2* input,
                             global uint2* output){SCAN_SPANS(uint2, scan_in_group_uint2)}

kernel void scan_span_sums_uint8(int n, int spans, int span, global const uint8* input,
                                 global uint8* sums){SCAN_SPAN_SUMS(uint8, scan_in_group_uint8)}

kernel void scan_spans_uint8(int n, int spans, int span, int items, global const uint8* sums, global const uint8* input,
                             global uint8* output) {
  SCAN_SPANS(uint8, scan_in_group_uint8)
}
