// The range of coordinates in which every predicate is exact, and the bounds of the predicates' rounding errors. The
// host chooses by them and hands bounds to kernels; docs/exactness.md derives all numbers.
#ifndef FLAUNAY_BOUNDS_H
#define FLAUNAY_BOUNDS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// The relative error of one operation on real numbers (arithmetic/numbers.h), and of a difference of coordinates: half
// a unit in the last place of 1 with double precision. In single precision it is twice that and a little more, so that
// it holds of devices that round toward zero, too.
#define DOUBLE_ROUNDOFF 0x1p-53
#define SINGLE_ROUNDOFF 0x1.00001p-23f
#ifdef FIXED_POINT
#define ROUNDOFF SINGLE_ROUNDOFF
#else
#define ROUNDOFF DOUBLE_ROUNDOFF
#endif

// The error of a computed determinant is below its bound times the sum of its terms' magnitudes. A bound of 0 says that
// coordinates are so coarse that nothing is rounded. The first two are Shewchuk's (1997), (3 + 16e)e and (10 + 96e)e,
// rounded up; the derivations of the others stand at hull_depth, angle_compared, nearness_filtered and
// centre_side_filtered.
#define ORIENT_BOUND_FOR(roundoff) (3.00001f * (roundoff))
#define CIRCLE_BOUND_FOR(roundoff) (10.0001f * (roundoff))
#define NEARNESS_BOUND_FOR(roundoff) (6 * (roundoff))
#define ORIENT_BOUND ORIENT_BOUND_FOR(ROUNDOFF)
#define CIRCLE_BOUND CIRCLE_BOUND_FOR(ROUNDOFF)
#define HULL_DEPTH_BOUND (10 * ROUNDOFF)
#define ANGLE_BOUND (11 * ROUNDOFF)
#define NEARNESS_BOUND NEARNESS_BOUND_FOR(ROUNDOFF)
#define CENTRE_SIDE_BOUND (12 * ROUNDOFF)
#define POWER_BOUND (14 * ROUNDOFF)

// Triangulated points: coordinates below 2^250 that are multiples of 2^-255. No product of four overflows, and none
// underflows.
INTEGER_CONSTANT(LARGEST_EXPONENT, 249);
INTEGER_CONSTANT(LOWEST_EXPONENT, -255);
INTEGER_CONSTANT(MOST_BITS, LARGEST_EXPONENT - LOWEST_EXPONENT + 1);
// Coordinates that span at most this many bits, k, are coarse for a predicate, which needs 3k + 4, 2k + 3 or 4k
// + 8 of 53 bits.
INTEGER_CONSTANT(COARSE_HULL_BITS, 16);
INTEGER_CONSTANT(COARSE_ORIENT_BITS, 25);
INTEGER_CONSTANT(COARSE_CIRCLE_BITS, 11);
// In fixed point, differences of coordinates of this many bits have dot and cross products below 2^63.
INTEGER_CONSTANT(COARSE_FIXED_BITS, 29);

// Queries and the points that they are held against: coordinates below 2^509 that are multiples of 2^-511. No product
// of two differences overflows or underflows.
INTEGER_CONSTANT(LARGEST_QUERY_EXPONENT, 508);
INTEGER_CONSTANT(LOWEST_QUERY_EXPONENT, -511);
INTEGER_CONSTANT(MOST_QUERY_BITS, LARGEST_QUERY_EXPONENT - LOWEST_QUERY_EXPONENT + 1);
// Coordinates of at most this many bits, k, are coarse: orientation and nearness need 2k + 4 bits.
INTEGER_CONSTANT(COARSE_QUERY_BITS, 24);

END_SHARED

#endif
