// Launches of few work-items that each have long work, one in each of several warps. For kernels alone.
#ifndef FLAUNAY_SPREAD_H
#define FLAUNAY_SPREAD_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Where only each spread-th work-item has an element: the number of this one's, or n if it has none.
static inline int spread_item(int n, int spread) {
  const int i = (int)get_global_id(0) / spread;
  return i * spread == (int)get_global_id(0) ? min(i, n) : n;
}

END_SHARED

#endif
