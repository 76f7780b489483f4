// The ranks by which changes that are made at once claim rows.
#ifndef FLAUNAY_RANKS_H
#define FLAUNAY_RANKS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Each number up to a mask, which is one less than a power of two, for one of these: ranks that went up along the plane
// would make each point wait for the one before.
static inline uint shuffled(uint x, uint mask) {
  x = (x * 0x9e3779b1u) & mask;
  x ^= x >> 7;
  return (x * 0x85ebca6bu) & mask;
}

END_SHARED

#endif
