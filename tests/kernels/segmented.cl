// Instances of operations/segmented_arg_reduce.h: the least and the greatest value of each segment, of equal
// ones the first; and the least positive one, so that some elements are no candidates.

#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#pragma OPENCL FP_CONTRACT OFF

#include "operations/segmented_arg_reduce.h"

#define SELF(i) i
#define KEPT(i) values[i] > 0 ? i : -1
#define SMALLER(run, i, j) (values[i] < values[j] || (values[i] == values[j] && i < j))
#define GREATER(run, i, j) (values[i] > values[j] || (values[i] == values[j] && i < j))
kernel void segmented_arg_min(ARG_REDUCE_ARGUMENTS, global const double* restrict values COUNTERS) {
  SEGMENTED_ARG_REDUCE(SELF, SMALLER);
}
kernel void segmented_arg_max(ARG_REDUCE_ARGUMENTS, global const double* restrict values COUNTERS) {
  SEGMENTED_ARG_REDUCE(SELF, GREATER);
}
kernel void least_positive(ARG_REDUCE_ARGUMENTS, global const int* restrict values COUNTERS) {
  SEGMENTED_ARG_REDUCE(KEPT, SMALLER);
}
