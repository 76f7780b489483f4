// Functions that the work-items of a group compute together, for kernels that work on tiles: a tile is one
// work-group's share. Such kernels allow for any size of group, up to LARGEST_TILE_GROUP where they scan, and for
// groups behind the last tile, which do nothing. All work-items of a group must call them at the same place. Loops with
// barriers have a first turn in any case, and no barrier is in a branch, where that is possible: PoCL compiles what
// follows them once more for each that may be left out. For kernel files alone.
#ifndef FLAUNAY_WORK_GROUP_H
#define FLAUNAY_WORK_GROUP_H

#include "arithmetic/language.h"

BEGIN_SHARED

// For functions with barriers: PoCL 3.1 loses barriers of functions that are called twice and not inlined.
#define WITH_BARRIERS static inline __attribute__((always_inline))

// Defines a function that returns the sum of the values of the work-items before this one, and writes the sum
// of all values to *total. sums: LARGEST_TILE_GROUP elements, which may be used again afterwards.
#define SCAN_IN_GROUP(NAME, T)                                 \
  WITH_BARRIERS T NAME(T value, local T* sums, T* total) {     \
    const int me = get_local_id(0), group = get_local_size(0); \
    sums[me] = value;                                          \
    barrier(CLK_LOCAL_MEM_FENCE);                              \
    int distance = 1;                                          \
    do {                                                       \
      T sum = sums[me];                                        \
      if (me >= distance) sum += sums[me - distance];          \
      barrier(CLK_LOCAL_MEM_FENCE);                            \
      sums[me] = sum;                                          \
      barrier(CLK_LOCAL_MEM_FENCE);                            \
      distance *= 2;                                           \
    } while (distance < group);                                \
    const T before = sums[me] - value;                         \
    *total = sums[group - 1];                                  \
    barrier(CLK_LOCAL_MEM_FENCE);                              \
    return before;                                             \
  }

// The tasks of a work-item: every `step`-th from `first` on, each as item `rank` of `size` that share it.
typedef struct {
  int first, step, rank, size;
} team;

static inline team team_of(int tasks) {
  const int me = get_local_id(0), lanes = get_local_size(0), size = max(1, lanes / max(1, tasks)), teams = lanes / size;
  const team t = {me / size < teams ? me / size : tasks, teams, me % size, size};
  return t;
}

// How many of a tile's elements each work-item takes, if it takes consecutive ones.
static inline int share_of(int elements) {
  const int group = get_local_size(0);
  return (elements + group - 1) / group;
}

END_SHARED

#endif
