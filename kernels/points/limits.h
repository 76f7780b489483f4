// Sizes and numbers of rounds on which kernels and the host agree.
#ifndef FLAUNAY_POINTS_LIMITS_H
#define FLAUNAY_POINTS_LIMITS_H

#include "arithmetic/language.h"
#include "operations/limits.h"

BEGIN_SHARED

// Bytes of local memory per point of a tile of points, and per sample of a tile of samples.
INTEGER_CONSTANT(LOCAL_BYTES_PER_POINT, 16);
INTEGER_CONSTANT(LOCAL_BYTES_PER_SAMPLE, 32);
INTEGER_CONSTANT(LARGEST_POINT_TILE, LOCAL_BYTES / LOCAL_BYTES_PER_POINT);
INTEGER_CONSTANT(LARGEST_SAMPLE_TILE, LOCAL_BYTES / LOCAL_BYTES_PER_SAMPLE);
// A group cuts at most this many levels of a tree in gaps.
INTEGER_CONSTANT(GAP_LEVELS, 4);
// A tile of points is sorted by at most this many bits of their blocks' numbers.
INTEGER_CONSTANT(MOST_BLOCK_BITS, 10);

END_SHARED

#endif
