// A search for segments that are about equally long.
#ifndef FLAUNAY_SEGMENT_NEAR_H
#define FLAUNAY_SEGMENT_NEAR_H

#include "arithmetic/language.h"
#include "operations/search.h"

BEGIN_SHARED

// The same segment as segment_of finds, for i below offsets[count]: from where it would be if all were equally
// long, by steps that double, and then by halves.
static inline int segment_near(int i, int count, GLOBAL const int* RESTRICT offsets) {
  if (count == 1) return 0;
  int low = min(count - 1, (int)((float)i / (float)offsets[count] * (float)count)), high = low + 1;
  for (int step = 1; offsets[low] > i; step *= 2) {
    high = low;
    low = max(0, low - step);
  }
  for (int step = 1; high < count && offsets[high] <= i; step *= 2) {
    low = high;
    high = min(count, high + step);
  }
  return segment_between(i, low, high, offsets);
}

END_SHARED

#endif
