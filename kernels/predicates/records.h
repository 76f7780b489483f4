// Records that predicates get from the host.
#ifndef FLAUNAY_PREDICATES_RECORDS_H
#define FLAUNAY_PREDICATES_RECORDS_H

#include "arithmetic/language.h"
#include "arithmetic/numbers.h"

BEGIN_SHARED

// Bounds of the predicates' filters: HULL_DEPTH_BOUND, ORIENT_BOUND and CIRCLE_BOUND of predicates/bounds.h, or 0 where
// the input is so coarse that floating point is exact. In fixed point, `coarse` says instead that products of
// differences fit into 64 bits (COARSE_FIXED_BITS).
typedef struct {
  filter_bound hull, orient, circle;
  int coarse;
} filter_bounds;
ASSERT_SIZE(filter_bounds, 16);

END_SHARED

#endif
