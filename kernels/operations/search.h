// Binary searches.
#ifndef FLAUNAY_SEARCH_H
#define FLAUNAY_SEARCH_H

#include "arithmetic/language.h"
#include "arithmetic/numbers.h"

BEGIN_SHARED

// The last of the segments low..high - 1 that begins at i or before; offsets ascend and offsets[low] <= i. If several
// segments begin at the same place, it is the last one, which is not empty.
static inline int segment_between(int i, int low, int high, GLOBAL const int* RESTRICT offsets) {
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    if (offsets[middle] <= i) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return low;
}
// The same of `count` segments.
static inline int segment_of(int i, int count, GLOBAL const int* RESTRICT offsets) {
  return segment_between(i, 0, count, offsets);
}

// How many of the ascending positions are below i.
static inline int positions_below(int i, int count, GLOBAL const int* RESTRICT positions) {
  int low = 0, high = count;
  while (low < high) {
    const int middle = low + (high - low) / 2;
    if (positions[middle] < i) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

// The last path vertex of first..last with u no greater than the given one; first if all are greater.
// Projections are (h, u), ascending in u.
static inline int search_path(real u, int first, int last, GLOBAL const real2* RESTRICT path_projections) {
  int low = first, high = last + 1;
  while (high - low > 1) {
    const int middle = low + (high - low) / 2;
    if (path_projections[middle].y <= u) {
      low = middle;
    } else {
      high = middle;
    }
  }
  return low;
}

END_SHARED

#endif
