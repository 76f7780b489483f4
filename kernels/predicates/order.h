// Sorting a block's points along an axis, by one work-item.
#ifndef FLAUNAY_ORDER_H
#define FLAUNAY_ORDER_H

#include "arithmetic/coordinates.h"
#include "arithmetic/language.h"
#include "predicates/planar.h"

BEGIN_SHARED

// The orders of axis 0, by (x, y), and of axis 1, by (y, -x).
static inline int precedes(coordinate2 p, coordinate2 q, int axis) {
  return axis ? comes_before(VECTOR(coordinate2, p.y, -p.x), VECTOR(coordinate2, q.y, -q.x)) : comes_before(p, q);
}

// Elements to sort: a coarse key and the place of the point.
typedef uint2 keyed;
#define COARSE_BITS 24
#define COARSE_DIGIT 8
#define COARSE_DIGITS (1 << COARSE_DIGIT)

static inline void stable_pass(GLOBAL const keyed* RESTRICT from, GLOBAL keyed* RESTRICT to, int n, int shift) {
  uint place[COARSE_DIGITS];
  for (int d = 0; d < COARSE_DIGITS; ++d) place[d] = 0;
  for (int i = 0; i < n; ++i) ++place[from[i].x >> shift & (COARSE_DIGITS - 1)];
  uint sum = 0;
  for (int d = 0; d < COARSE_DIGITS; ++d) {
    const uint count = place[d];
    place[d] = sum;
    sum += count;
  }
  for (int i = 0; i < n; ++i) {
    const keyed element = from[i];
    to[place[element.x >> shift & (COARSE_DIGITS - 1)]++] = element;
  }
}

// Sorts elements stably by the leading bits of a coordinate, as many as tell points of this block apart. Returns
// elements or spare, whichever holds the result.
static inline GLOBAL keyed* sort_coarsely(GLOBAL keyed* elements, GLOBAL keyed* spare, int n,
                                          GLOBAL const coordinate2* points, int axis) {
  ulong least = ~0UL, most = 0;
  for (int i = 0; i < n; ++i) {
    const coordinate2 p = points[i];
    const ulong key = orderable(axis ? p.y : p.x);
    least = min(least, key);
    most = max(most, key);
  }
  const int bits = 64 - (int)clz(most - least);
  const int dropped = max(0, bits - COARSE_BITS);
  for (int i = 0; i < n; ++i) {
    const coordinate2 p = points[elements[i].y];
    elements[i].x = (uint)((orderable(axis ? p.y : p.x) - least) >> dropped);
  }
  for (int shift = 0; shift < bits - dropped; shift += COARSE_DIGIT) {
    stable_pass(elements, spare, n, shift);
    GLOBAL keyed* const sorted = spare;
    spare = elements;
    elements = sorted;
  }
  return elements;
}

// Sorts elements of equal coarse keys by insertion; gives up, returning 0, where that would take long.
#define INSERTIONS_A_POINT 4
static inline int sort_ties(GLOBAL keyed* elements, int n, GLOBAL const coordinate2* points, int axis) {
  int left = INSERTIONS_A_POINT * n;
  for (int i = 1; i < n; ++i) {
    const keyed element = elements[i];
    int j = i;
    if (elements[j - 1].x == element.x) {
      const coordinate2 p = points[element.y];
      while (j > 0 && elements[j - 1].x == element.x && precedes(p, points[elements[j - 1].y], axis)) {
        elements[j] = elements[j - 1];
        --j;
        if (--left < 0) {
          elements[j] = element;
          return 0;
        }
      }
      elements[j] = element;
    }
  }
  return 1;
}

// Bottom-up merge sort, stable, by comparisons. Returns elements or spare.
static inline GLOBAL keyed* sort_by_merging(GLOBAL keyed* elements, GLOBAL keyed* spare, int n,
                                            GLOBAL const coordinate2* points, int axis) {
  for (int width = 1; width < n; width *= 2) {
    for (int begin = 0; begin < n; begin += 2 * width) {
      const int middle = min(n, begin + width), end = min(n, begin + 2 * width);
      int low = begin, high = middle;
      for (int to = begin; to < end; ++to) {
        const int take_high =
            low == middle || (high < end && precedes(points[elements[high].y], points[elements[low].y], axis));
        spare[to] = take_high ? elements[high++] : elements[low++];
      }
    }
    GLOBAL keyed* const sorted = spare;
    spare = elements;
    elements = sorted;
  }
  return elements;
}

// Sorts elements, whose places stand in [0, n), by the order of the axis; those of equal points stay in their order.
// Returns elements or spare, whichever holds the result. O(n) as a rule, O(n log n) at worst.
static inline GLOBAL keyed* sort_along(GLOBAL keyed* elements, GLOBAL keyed* spare, int n,
                                       GLOBAL const coordinate2* points, int axis) {
  GLOBAL keyed* sorted = sort_coarsely(elements, spare, n, points, axis);
  if (sort_ties(sorted, n, points, axis)) return sorted;
  return sort_by_merging(sorted, sorted == elements ? spare : elements, n, points, axis);
}

END_SHARED

#endif
