// Fetching into a CPU's cache what will be needed soon.
#ifndef FLAUNAY_PREFETCH_H
#define FLAUNAY_PREFETCH_H

#include "shared/language.h"

// What suits CPUs, with 3 pairs of edges per point of a block: an edge rarely leads farther.
#define CPU_FETCH_AHEAD 6144

// How many elements ahead of its use; 0 for devices that hide waiting otherwise, where fetch() does nothing.
#ifndef FETCH_AHEAD
#ifdef __cplusplus
#define FETCH_AHEAD CPU_FETCH_AHEAD
#else
#define FETCH_AHEAD 0
#endif
#endif

BEGIN_SHARED

static inline void fetch(GLOBAL const void* what) {
#if FETCH_AHEAD
  __builtin_prefetch(what);
#endif
}

END_SHARED

#endif
