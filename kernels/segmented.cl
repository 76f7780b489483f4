// Segmented operations on doubles: elements 0..n-1 belong to segments, numbered without descent in segment[].
//
// Arg-min and arg-max, one pass a kernel: see shared/segmented_arg_reduce.h. Ties go to the smaller index.
// Inclusive segmented scan of sums, and the segmented sums themselves: per chunk one work-item; segmented_sum_reduce
// gives each chunk's last run's sum (and whether that run began in the chunk), segmented_sum_carry walks the
// chunks and turns those into what each chunk inherits, segmented_sum_write walks the elements.

#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF

#include "shared/segmented_arg_reduce.h"

#define SELF(i) i
#define SMALLER(run, i, j) (values[i] < values[j] || (values[i] == values[j] && i < j))
#define GREATER(run, i, j) (values[i] > values[j] || (values[i] == values[j] && i < j))
SEGMENTED_ARG_REDUCE(segmented_arg_min, SELF, SMALLER, global const double* restrict values)
SEGMENTED_ARG_REDUCE(segmented_arg_max, SELF, GREATER, global const double* restrict values)

kernel void segmented_sum_reduce(int n, int chunk, global const int* restrict segment,
                                 global const long* restrict values, global long* restrict sums,
                                 global int* restrict begins) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    int i = high - 1;
    const int last = segment[i];
    long sum = 0;
    while (i >= low && segment[i] == last) sum += values[i--];
    sums[c] = sum;
    begins[c] = i >= low || low == 0 || segment[low - 1] != last;
  }
}

// One work-item: chunks are few. carry[c]: what chunk c's first run has gathered in the chunks before.
kernel void segmented_sum_carry(int chunks, global const long* restrict sums, global const int* restrict begins,
                                global long* restrict carry) {
  if (get_global_id(0) == 0) {
    long open = 0;
    for (int c = 0; c < chunks; ++c) {
      carry[c] = open;
      open = begins[c] ? sums[c] : open + sums[c];
    }
  }
}

// scanned may be values. scanned[i]: the sum of i's segment up to and with i; total[s]: the sum of segment s, where it has elements.
kernel void segmented_sum_write(int n, int chunk, global const int* restrict segment,
                                global const long* values, global const long* restrict carry, global long* scanned,
                                global long* restrict total) {
  const int c = get_global_id(0);
  const int low = c * chunk;
  if (low < n) {
    const int high = min(n, low + chunk);
    long sum = low > 0 && segment[low - 1] == segment[low] ? carry[c] : 0;
    for (int i = low; i < high; ++i) {
      if (i > low && segment[i] != segment[i - 1]) sum = 0;
      sum += values[i];
      scanned[i] = sum;
      if (i == n - 1 || segment[i + 1] != segment[i]) total[segment[i]] = sum;
    }
  }
}
