// Sizes and numbers of rounds on which kernels and the host agree.
#ifndef FLAUNAY_FLATTENED_LIMITS_H
#define FLAUNAY_FLATTENED_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Corners of the largest region that one work-item triangulates in private memory, unless a program's build says
// otherwise by SMALL_REGION. At most 64, the bits of a ulong.
INTEGER_CONSTANT(DEFAULT_SMALL_REGION, 48);
// Prune takes one candidate from a bucket of this many consecutive points along the cut line.
INTEGER_CONSTANT(BUCKET, 16);
// Regions with more candidates than this prune them in two steps.
INTEGER_CONSTANT(MANY_CANDIDATES, 256);
// If a region has at most this many kept corners, each finds its place by comparing itself with all.
INTEGER_CONSTANT(COUNTED_CORNERS, 256);
// Quickhull splits at deepest points for this many rounds, then it balances its splits. Only inputs made for
// that purpose have been seen to take more.
INTEGER_CONSTANT(MOST_QUICKHULL_ROUNDS, 64);
// Rounds of splits at deepest points for Hull::balanced: they served skewed input well in the paper.
INTEGER_CONSTANT(ROUNDS_BEFORE_BALANCE, 4);
// Dropping vertices that are not strictly below their neighbours' segment can expose one vertex at a time.
// After this many rounds, a quickhull of the remaining vertices finishes.
INTEGER_CONSTANT(CLEAN_UP_ROUNDS, 8);

END_SHARED

#endif
