// Fetching into a CPU's cache what will be needed soon.
#ifndef FLAUNAY_PREFETCH_H
#define FLAUNAY_PREFETCH_H

// How many elements ahead of its use; 0 for devices that hide waiting otherwise, where fetch() does nothing.
#ifndef FETCH_AHEAD
#define FETCH_AHEAD 0
#endif

static inline void fetch(global const void* what) {
#if FETCH_AHEAD
  __builtin_prefetch(what);
#endif
}

#endif
