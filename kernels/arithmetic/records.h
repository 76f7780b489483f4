// Records of coordinates, which kernels and the host share.
#ifndef FLAUNAY_ARITHMETIC_RECORDS_H
#define FLAUNAY_ARITHMETIC_RECORDS_H

#include "arithmetic/language.h"
#include "arithmetic/numbers.h"

BEGIN_SHARED

// Coordinates are scaled by the product of three powers of two, which may be no double itself. Coordinates in
// fixed point are scaled already.
typedef struct {
  coordinate s0, s1, s2;
} scaling;
ASSERT_SIZE(scaling, 24);

// A box around vertices, its sides parallel to the axes.
typedef struct {
  coordinate2 low, high;
} vertex_box;
ASSERT_SIZE(vertex_box, 32);

END_SHARED

#endif
