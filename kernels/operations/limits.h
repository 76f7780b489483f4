// Sizes and numbers of rounds on which kernels and the host agree.
#ifndef FLAUNAY_OPERATIONS_LIMITS_H
#define FLAUNAY_OPERATIONS_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// The largest work-group that takes a tile of elements: local memory has room for no more.
INTEGER_CONSTANT(LARGEST_TILE_GROUP, 256);
// Kernels with tiles need local memory in proportion to the largest tile, at most LOCAL_BYTES, a power of two, which a
// program's build chooses. By default as much as OpenCL 1.2 guarantees; with less than the least, they cannot be built.
INTEGER_CONSTANT(DEFAULT_LOCAL_BYTES, 1 << 15);
INTEGER_CONSTANT(LEAST_LOCAL_BYTES, 1 << 14);
#ifndef LOCAL_BYTES
#define LOCAL_BYTES DEFAULT_LOCAL_BYTES
#endif
// Sorted runs of samples are merged MERGED_RUNS at a time.
INTEGER_CONSTANT(MERGED_RUNS_BITS, 3);
INTEGER_CONSTANT(MERGED_RUNS, 1 << MERGED_RUNS_BITS);

END_SHARED

#endif
