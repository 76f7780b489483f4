// Sizes and numbers of rounds on which kernels and the host agree.
#ifndef FLAUNAY_FLATTENED_LIMITS_H
#define FLAUNAY_FLATTENED_LIMITS_H

#include "arithmetic/language.h"

BEGIN_SHARED

// Corners of the largest region that one work-item triangulates in private memory, unless a program's build says
// otherwise by SMALL_REGION. At most 64, the bits of a ulong.
INTEGER_CONSTANT(DEFAULT_SMALL_REGION, 48);
// Prune takes one candidate from so many points that are consecutive along the cut line.
INTEGER_CONSTANT(BUCKET, 16);
// Regions with more candidates than this prune them in two steps.
INTEGER_CONSTANT(MANY_CANDIDATES, 256);
// Of so many kept corners in a region, each finds its place by comparing itself with all.
INTEGER_CONSTANT(COUNTED_CORNERS, 256);
// Quickhull splits at deepest points for so many rounds, then it balances its splits. No input has been seen to take
// more that was not made to.
INTEGER_CONSTANT(MOST_QUICKHULL_ROUNDS, 64);
// Rounds of splits at deepest points for Hull::balanced: what the paper's authors found to serve skewed input well.
INTEGER_CONSTANT(ROUNDS_BEFORE_BALANCE, 4);
// Dropping vertices that are not strictly below their neighbours' segment can lay bare one vertex at a time. After so
// many rounds quickhull sorts out what is left.
INTEGER_CONSTANT(CLEAN_UP_ROUNDS, 8);

END_SHARED

#endif
