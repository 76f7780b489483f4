// Fetching data into a CPU's cache before it is needed.
#ifndef FLAUNAY_PREFETCH_H
#define FLAUNAY_PREFETCH_H

#include "arithmetic/language.h"

// The distance that suits CPUs, with 3 pairs of edges per point of a block: an edge rarely leads farther.
#define CPU_FETCH_AHEAD 6144

// How many elements ahead of its use; 0 for devices that hide waiting otherwise, where fetch() does nothing.
#ifndef FETCH_AHEAD
#ifdef __cplusplus
#define FETCH_AHEAD CPU_FETCH_AHEAD
#else
#define FETCH_AHEAD 0
#endif
#endif

// How many points or pairs of edges ahead of its use memory is fetched that is read in its order. That is a few
// kilobytes: more than a page, at which processors stop fetching by themselves.
#define STREAM_AHEAD 512
#define CACHE_LINE 64

// Compilers see no effect in a function that only fetches, and leave out its calls unless they inline them before.
#if FETCH_AHEAD
#define FETCHING __attribute__((always_inline)) static inline
#else
#define FETCHING static inline
#endif

BEGIN_SHARED

FETCHING void fetch(GLOBAL const void* what) {
#if FETCH_AHEAD
  __builtin_prefetch(what);
#endif
}

// May reach beyond the end of an array, as nothing is read.
FETCHING void fetch_bytes(GLOBAL const void* what, int bytes) {
#if FETCH_AHEAD
  for (int k = 0; k < bytes; k += CACHE_LINE) fetch((GLOBAL const uchar*)what + k);
#endif
}

END_SHARED

#endif
