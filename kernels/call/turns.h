// Whether loops run until their conditions end them. Mesa's llvmpipe ends them after 65535 turns, which all loops of a
// work-item share.
#ifndef FLAUNAY_TURNS_H
#define FLAUNAY_TURNS_H

#include "arithmetic/language.h"

BEGIN_SHARED

INTEGER_CONSTANT(MANY_TURNS, 100000);

// The state of a random number generator after MANY_TURNS steps from 1. No compiler can precompute it if the 1
// is read from memory.
#define AFTER_MANY_TURNS 0x295fbfa1u

static inline int loops_end_early(uint one) {
  uint x = one;
  for (int k = 0; k < MANY_TURNS; ++k) x = x * 1664525u + 1013904223u;
  return x != AFTER_MANY_TURNS;
}

END_SHARED

#endif
