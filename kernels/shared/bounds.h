// The range of coordinates in which every predicate is exact, and the bounds of the predicates' rounding errors. The
// host chooses by them and hands bounds to kernels; docs/exactness.md derives all numbers.
#ifndef FLAUNAY_BOUNDS_H
#define FLAUNAY_BOUNDS_H

#include "shared/language.h"

BEGIN_SHARED

// Half a unit in the last place of 1: the relative error of one operation.
#define ROUNDOFF 0x1p-53

// The error of a computed determinant is below its bound times the sum of its terms' magnitudes. A bound of 0 says that
// coordinates are so coarse that nothing is rounded. The first two are Shewchuk's (1997); the derivations of the others
// stand at hull_depth, angle_compared, nearness_filtered and centre_side_filtered.
#define ORIENT_BOUND ((3.0 + 16.0 * ROUNDOFF) * ROUNDOFF)
#define CIRCLE_BOUND ((10.0 + 96.0 * ROUNDOFF) * ROUNDOFF)
#define HULL_DEPTH_BOUND (10.0 * ROUNDOFF)
#define ANGLE_BOUND (11.0 * ROUNDOFF)
#define NEARNESS_BOUND (6.0 * ROUNDOFF)
#define CENTRE_SIDE_BOUND (12.0 * ROUNDOFF)

// Triangulated points: coordinates below 2^250 that are multiples of 2^-255. No product of four overflows, and none
// underflows.
INTEGER_CONSTANT(LARGEST_EXPONENT, 249);
INTEGER_CONSTANT(LOWEST_EXPONENT, -255);
INTEGER_CONSTANT(MOST_BITS, LARGEST_EXPONENT - LOWEST_EXPONENT + 1);
// Coordinates that span so many bits, k, are coarse for a predicate: it takes 3k + 4, 2k + 3 or 4k + 8 of a
// double's 53.
INTEGER_CONSTANT(COARSE_HULL_BITS, 16);
INTEGER_CONSTANT(COARSE_ORIENT_BITS, 25);
INTEGER_CONSTANT(COARSE_CIRCLE_BITS, 11);

// Queries and the points that they are held against: coordinates below 2^509 that are multiples of 2^-511. No product
// of two differences overflows or underflows.
INTEGER_CONSTANT(LARGEST_QUERY_EXPONENT, 508);
INTEGER_CONSTANT(LOWEST_QUERY_EXPONENT, -511);
INTEGER_CONSTANT(MOST_QUERY_BITS, LARGEST_QUERY_EXPONENT - LOWEST_QUERY_EXPONENT + 1);
// Coordinates of so many bits are coarse: orientation and nearness take 2k + 4.
INTEGER_CONSTANT(COARSE_QUERY_BITS, 24);

END_SHARED

#endif
