// Sorting along an axis (predicates/order.h) on arrays of cases, one case a work-item, for
// order_test.cpp.
//
// Case c has the points [offsets[c], offsets[c + 1]) and as many elements, whose places are counted from its
// first point.

#include "predicates/order.h"

static inline void copy_elements(global const keyed* restrict from, global keyed* restrict to, int n) {
  for (int i = 0; i < n; ++i) to[i] = from[i];
}

kernel void sort_cases(int n, int axis, global const int* restrict offsets,
                       global const double2* restrict points, global keyed* restrict elements,
                       global keyed* restrict spare, global keyed* restrict sorted) {
  const int c = get_global_id(0);
  if (c < n) {
    const int first = offsets[c], size = offsets[c + 1] - first;
    copy_elements(sort_along(elements + first, spare + first, size, points + first, axis), sorted + first,
                  size);
  }
}

// What each step of a sort leaves: the coarse keys, here of two digits, their ties, which are finished or
// given up, and the merge of these.
kernel void sort_steps(int n, int axis, global const int* restrict offsets,
                       global const double2* restrict points, global keyed* elements, global keyed* spare,
                       global keyed* restrict coarse, global int* restrict finished,
                       global keyed* restrict ties, global keyed* restrict merged) {
  const int c = get_global_id(0);
  if (c < n) {
    const int first = offsets[c], size = offsets[c + 1] - first;
    global keyed* const in_order =
        sort_coarsely(elements + first, spare + first, size, points + first, axis, 2);
    global keyed* const other = in_order == elements + first ? spare + first : elements + first;
    copy_elements(in_order, coarse + first, size);
    finished[c] = sort_ties(in_order, size, points + first, axis);
    copy_elements(in_order, ties + first, size);
    copy_elements(sort_by_merging(in_order, other, size, points + first, axis), merged + first, size);
  }
}
