// Exclusive prefix sums of one array, componentwise for vectors of counts.
//
// Three passes over chunks of consecutive elements, one work-item per chunk: scan_reduce_T sums each chunk, the sums
// are scanned (by these same kernels), scan_write_T walks each chunk again from its prefix. The total goes to
// output[n], so that a list's length is where the device finds it. Input and output may be the same array. A scan of at
// most one chunk is one pass, of scan_write_T alone.

#include "arithmetic/language.h"

#define SCAN_REDUCE(T, ZERO)                          \
  const int c = get_global_id(0);                     \
  const int low = c * chunk;                          \
  if (low < n) {                                      \
    const int high = min(n, low + chunk);             \
    T sum = ZERO;                                     \
    for (int i = low; i < high; ++i) sum += input[i]; \
    sums[c] = sum;                                    \
  }

#define SCAN_WRITE(T, ZERO)               \
  const int c = get_global_id(0);         \
  const int low = c * chunk;              \
  if (low < n) {                          \
    const int high = min(n, low + chunk); \
    T sum = ZERO;                         \
    if (has_prefix) sum = prefix[c];      \
    for (int i = low; i < high; ++i) {    \
      const T value = input[i];           \
      output[i] = sum;                    \
      sum += value;                       \
    }                                     \
    if (high == n) output[n] = sum;       \
  }

kernel void scan_reduce_uint(int n, int chunk, global const uint* input, global uint* restrict sums) {
  SCAN_REDUCE(uint, 0u);
}

kernel void scan_write_uint(int n, int chunk, int has_prefix, global const uint* restrict prefix,
                            global const uint* input, global uint* output) {
  SCAN_WRITE(uint, 0u);
}

kernel void scan_reduce_uint2(int n, int chunk, global const uint2* input, global uint2* restrict sums) {
  SCAN_REDUCE(uint2, VECTOR(uint2, 0u, 0u));
}

kernel void scan_write_uint2(int n, int chunk, int has_prefix, global const uint2* restrict prefix,
                             global const uint2* input, global uint2* output) {
  SCAN_WRITE(uint2, VECTOR(uint2, 0u, 0u));
}

kernel void scan_reduce_uint8(int n, int chunk, global const uint8* input, global uint8* restrict sums) {
  SCAN_REDUCE(uint8, VECTOR8(uint8, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u));
}

kernel void scan_write_uint8(int n, int chunk, int has_prefix, global const uint8* restrict prefix,
                             global const uint8* input, global uint8* output) {
  SCAN_WRITE(uint8, VECTOR8(uint8, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u));
}
