// Exclusive prefix sums of one array, componentwise for vectors of counts.
//
// Three passes over chunks of consecutive elements, one work-item a chunk: scan_reduce_T sums each chunk, the sums are
// scanned (by these same kernels), scan_write_T walks each chunk again from its prefix. The total goes to output[n], so
// that a list's length is where the device finds it. In and out may be the same array. A scan of at most one
// chunk is one pass, of scan_write_T alone.

#define SCAN(T, ZERO)                                                                                          \
  kernel void scan_reduce_##T(int n, int chunk, global const T* input, global T* restrict sums) {             \
    const int c = get_global_id(0);                                                                            \
    const int low = c * chunk;                                                                                 \
    if (low < n) {                                                                                             \
      const int high = min(n, low + chunk);                                                                    \
      T sum = ZERO;                                                                                            \
      for (int i = low; i < high; ++i) sum += input[i];                                                        \
      sums[c] = sum;                                                                                           \
    }                                                                                                          \
  }                                                                                                            \
  kernel void scan_write_##T(int n, int chunk, int has_prefix, global const T* restrict prefix,                \
                             global const T* input, global T* output) {                                        \
    const int c = get_global_id(0);                                                                            \
    const int low = c * chunk;                                                                                 \
    if (low < n) {                                                                                             \
      const int high = min(n, low + chunk);                                                                    \
      T sum = ZERO;                                                                                            \
      if (has_prefix) sum = prefix[c];                                                                         \
      for (int i = low; i < high; ++i) {                                                                       \
        const T value = input[i];                                                                              \
        output[i] = sum;                                                                                       \
        sum += value;                                                                                          \
      }                                                                                                        \
      if (high == n) output[n] = sum;                                                                          \
    }                                                                                                          \
  }

SCAN(uint, 0u)
SCAN(uint2, (uint2)(0u))
SCAN(uint8, (uint8)(0u))
