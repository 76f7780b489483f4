// The leaves of a tree of cuts: the places of the blocks of a phase.
#ifndef FLAUNAY_REFINEMENT_LEAVES_H
#define FLAUNAY_REFINEMENT_LEAVES_H

#include "arithmetic/language.h"
#include "refinement/records.h"

#ifndef FIXED_POINT

BEGIN_SHARED

static inline int leaf_at(GLOBAL const block_cut* cuts, double2 p) {
  int at = 0;
  while (cuts[at].axis >= 0) at = cuts[at].child + !((cuts[at].axis ? p.y : p.x) < cuts[at].at);
  return cuts[at].child;
}

END_SHARED

#endif

#endif
