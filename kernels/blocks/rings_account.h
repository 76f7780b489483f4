// The account of all merges: how many predicates were undecided.
#ifndef FLAUNAY_RINGS_ACCOUNT_H
#define FLAUNAY_RINGS_ACCOUNT_H

#include "blocks/codes.h"
#include "mesh/rings.h"

BEGIN_SHARED

static inline void add_to_account(const rings* g, GLOBAL volatile uint* account) {
  if (g->undecided > 0) atomic_add(&account[RINGS_UNDECIDED], g->undecided);
  if (g->ties > 0) atomic_add(&account[RINGS_TIES], g->ties);
  if (g->ties_left > 0) atomic_add(&account[RINGS_TIES_LEFT], g->ties_left);
}

END_SHARED

#endif
