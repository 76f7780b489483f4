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

// The coordinate by which an axis sorts has its number; the one that breaks ties has the next number.
static inline coordinate sorted_coordinate(coordinate2 p, int number) {
  return number == 0 ? p.x : number == 1 ? p.y : -p.x;
}

// An element to sort: a coarse key in the upper half, the place of the point in the lower one. One number is moved
// faster than a vector of two.
typedef uint64 keyed;
static inline keyed keyed_place(uint key, int place) { return (keyed)key << 32 | (uint)place; }
static inline uint coarse_key(keyed element) { return (uint)(element >> 32); }
static inline int place_of_keyed(keyed element) { return (int)(uint)element; }

#define COARSE_DIGIT 8
#define COARSE_DIGITS (1 << COARSE_DIGIT)
#define MOST_COARSE_DIGITS 3
static inline uint coarse_digit(uint key, int digit) { return key >> digit * COARSE_DIGIT & (COARSE_DIGITS - 1); }
// Keys of one digit distinguish most points if there are at most this many.
#define ONE_DIGIT_POINTS 64

// Sorts stably by a digit. counts: of the digit's values.
static inline void stable_pass(GLOBAL const keyed* RESTRICT from, GLOBAL keyed* RESTRICT to, int n, int digit,
                               uint* counts) {
  uint sum = 0;
  for (int d = 0; d < COARSE_DIGITS; ++d) {
    const uint count = counts[d];
    counts[d] = sum;
    sum += count;
  }
  for (int i = 0; i < n; ++i) {
    const keyed element = from[i];
    to[counts[coarse_digit(coarse_key(element), digit)]++] = element;
  }
}

// Sorts elements stably by the leading `digits` digits of a coordinate, among the bits that distinguish points
// of this block. Returns elements or spare, whichever holds the result.
static inline GLOBAL keyed* sort_coarsely(GLOBAL keyed* elements, GLOBAL keyed* spare, int n,
                                          GLOBAL const coordinate2* points, int number, int digits) {
  if (n == 0) return elements;
  coordinate least = sorted_coordinate(points[0], number), most = least;
  for (int i = 1; i < n; ++i) {
    const coordinate at = sorted_coordinate(points[i], number);
    least = at < least ? at : least;
    most = at > most ? at : most;
  }
  uint counts[MOST_COARSE_DIGITS][COARSE_DIGITS];
  for (int digit = 0; digit < digits; ++digit) {
    for (int d = 0; d < COARSE_DIGITS; ++d) counts[digit][d] = 0;
  }
  const uint64 first = orderable(least);
  const int dropped = max(0, 64 - (int)clz(orderable(most) - first) - digits * COARSE_DIGIT);
  for (int i = 0; i < n; ++i) {
    const int place = place_of_keyed(elements[i]);
    const uint key = (uint)((orderable(sorted_coordinate(points[place], number)) - first) >> dropped);
    elements[i] = keyed_place(key, place);
    for (int digit = 0; digit < digits; ++digit) ++counts[digit][coarse_digit(key, digit)];
  }
  for (int digit = 0; digit < digits; ++digit) {
    stable_pass(elements, spare, n, digit, counts[digit]);
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
    if (coarse_key(elements[j - 1]) == coarse_key(element)) {
      const coordinate2 p = points[place_of_keyed(element)];
      while (j > 0 && coarse_key(elements[j - 1]) == coarse_key(element) &&
             precedes(p, points[place_of_keyed(elements[j - 1])], axis)) {
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
        const int take_high = low == middle || (high < end && precedes(points[place_of_keyed(elements[high])],
                                                                       points[place_of_keyed(elements[low])], axis));
        spare[to] = take_high ? elements[high++] : elements[low++];
      }
    }
    GLOBAL keyed* const sorted = spare;
    spare = elements;
    elements = sorted;
  }
  return elements;
}

// So few are sorted by insertion alone: a digit has more values than there are points.
#define INSERTED_POINTS 12

// Sorts elements, whose places stand in [0, n) and whose keys are equal, by the order of the axis; equal points
// keep their order. Returns elements or spare, whichever holds the result. O(n) as a rule, O(n log n) at worst.
static inline GLOBAL keyed* sort_along(GLOBAL keyed* elements, GLOBAL keyed* spare, int n,
                                       GLOBAL const coordinate2* points, int axis) {
  if (n <= INSERTED_POINTS && sort_ties(elements, n, points, axis)) return elements;
  GLOBAL keyed* sorted = n > ONE_DIGIT_POINTS ? sort_coarsely(elements, spare, n, points, axis, 2)
                                              : sort_coarsely(elements, spare, n, points, axis, 1);
  if (sort_ties(sorted, n, points, axis)) return sorted;
  // Where many have the same coordinate, or a few are far away.
  for (int number = axis + 1; number >= axis; --number) {
    spare = sorted == elements ? spare : elements;
    elements = sorted;
    sorted = sort_coarsely(elements, spare, n, points, number, MOST_COARSE_DIGITS);
  }
  if (sort_ties(sorted, n, points, axis)) return sorted;
  return sort_by_merging(sorted, sorted == elements ? spare : elements, n, points, axis);
}

END_SHARED

#endif
