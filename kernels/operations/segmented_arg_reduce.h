// One pass of a segmented arg-reduce, as a kernel made to measure.
#ifndef FLAUNAY_SEGMENTED_ARG_REDUCE_H
#define FLAUNAY_SEGMENTED_ARG_REDUCE_H

#include "operations/counters.h"

// The body of a kernel
//   kernel void name(ARG_REDUCE_ARGUMENTS, arrays that CANDIDATE and BETTER read COUNTERS)
// Elements 0..n-1 belong to segments, numbered without descent in segment[]. Element i stands for the candidate
// candidate[i], or for CANDIDATE(i) in the first pass; a negative candidate stands for nothing. Each work-item walks a
// chunk. A segment that lies within a chunk gets its best candidate in result[]; of one that reaches beyond, the
// chunk's best goes to partial_segment[], partial_candidate[], two entries per chunk, which are the elements of
// the next pass. With one chunk nothing reaches beyond. result[] must hold a negative value for every segment.
// BETTER(segment, i, j): whether candidate i comes before j; a strict total order, so that chunks do not matter. The
// build that counts takes its uses for comparisons of the hull.
#define ARG_REDUCE_ARGUMENTS                                                                                  \
  int n, int chunk, int first_pass, global const int *restrict segment, global const int *restrict candidate, \
      global int *restrict partial_segment, global int *restrict partial_candidate, global int *restrict result
#define SEGMENTED_ARG_REDUCE(CANDIDATE, BETTER)                               \
  const int c = get_global_id(0);                                             \
  const int low = c * chunk;                                                  \
  if (low < n) {                                                              \
    const int high = min(n, low + chunk);                                     \
    int head = -1;                                                            \
    int run = segment[low];                                                   \
    const int first_run = run;                                                \
    int best = -1;                                                            \
    int open = low > 0 && segment[low - 1] == run;                            \
    for (int i = low; i < high; ++i) {                                        \
      const int now = segment[i];                                             \
      if (now != run) {                                                       \
        if (open) {                                                           \
          head = best;                                                        \
        } else if (best >= 0) {                                               \
          result[run] = best;                                                 \
        }                                                                     \
        open = 0;                                                             \
        best = -1;                                                            \
        run = now;                                                            \
      }                                                                       \
      const int other = first_pass ? (CANDIDATE(i)) : candidate[i];           \
      COUNT(HULL, ARITHMETIC, other >= 0 && best >= 0);                       \
      if (other >= 0 && (best < 0 || BETTER(run, other, best))) best = other; \
    }                                                                         \
    int tail = -1;                                                            \
    if (open || (high < n && segment[high] == run)) {                         \
      tail = best;                                                            \
    } else if (best >= 0) {                                                   \
      result[run] = best;                                                     \
    }                                                                         \
    partial_segment[2 * c] = first_run;                                       \
    partial_candidate[2 * c] = head;                                          \
    partial_segment[2 * c + 1] = run;                                         \
    partial_candidate[2 * c + 1] = tail;                                      \
  }

#endif
