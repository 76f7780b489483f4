// Counters of operations, in a build of the kernels with FLAUNAY_COUNT; nothing otherwise. docs/counting.md says what
// counts.
#ifndef FLAUNAY_COUNTERS_H
#define FLAUNAY_COUNTERS_H

#include "arithmetic/language.h"
#include "operations/costs.h"

BEGIN_SHARED

// Counters for each component of the algorithm, one for each kind of operation.
INTEGER_CONSTANT(COMPONENT_CUT, 0);
INTEGER_CONSTANT(COMPONENT_HULL, 1);
INTEGER_CONSTANT(COMPONENT_MERGE, 2);
INTEGER_CONSTANT(COMPONENT_SPLIT, 3);
INTEGER_CONSTANT(COMPONENT_ENDGAME, 4);
INTEGER_CONSTANT(COMPONENTS, 5);
INTEGER_CONSTANT(KIND_ARITHMETIC, 0);
INTEGER_CONSTANT(KIND_DEPTH, 1);
INTEGER_CONSTANT(KIND_ORIENTATION, 2);
INTEGER_CONSTANT(KIND_CIRCLE, 3);
INTEGER_CONSTANT(KINDS, 4);

// Counters are pairs of low and high halves, one pair for each component and kind. Behind them stand the largest number
// of weighted operations that one region of the end game took, and how many of its regions had each number of corners:
// more than MOST_COUNTED_SIZE count as that many. Last are the steps of one launch (host/launch/launch_log.hpp): the
// most that COUNT_STEPS got at once, and the low and high half of the sum.
INTEGER_CONSTANT(COUNTER_DEAREST, 2 * COMPONENTS * KINDS);
INTEGER_CONSTANT(COUNTER_SIZES, COUNTER_DEAREST + 1);
INTEGER_CONSTANT(MOST_COUNTED_SIZE, 1023);
INTEGER_CONSTANT(COUNTER_STEPS, COUNTER_SIZES + MOST_COUNTED_SIZE + 1);
INTEGER_CONSTANT(STEP_COUNTERS, 3);
INTEGER_CONSTANT(COUNTERS_LENGTH, COUNTER_STEPS + STEP_COUNTERS);

// The counts of one work-item, in its own variable, before COUNT_TALLY adds them to the counters.
typedef struct {
  uint arithmetic, orientations, circles;
  uint steps;  // of merges
} tally;

// Kernels count in four ways. COUNT and COUNT_TALLY add to the counters, once or twice in each kernel. COUNT_STEPS adds
// steps that a work-item does one after the other. A struct with
// TALLY_MEMBER has a tally, which TALLY adds to where the struct's predicates are evaluated. The predicates at the end
// of flattened/hull_height.h count each of their calls. COUNTERS stands behind the last parameter of each kernel and
// each function that counts, and WITH_COUNTERS behind the last argument of such a function; the host sets the kernels'.
#ifdef FLAUNAY_COUNT
#define COUNTERS , GLOBAL volatile uint* counters
#define WITH_COUNTERS , counters
#define COUNT(component, kind, amount) count_up(counters + 2 * (KINDS * COMPONENT_##component + KIND_##kind), amount)
#define COUNT_SIZE(corners) atomic_inc(counters + COUNTER_SIZES + min(corners, MOST_COUNTED_SIZE))
#define COUNT_STEPS(amount) count_steps(counters, amount)
#define COUNT_TALLY(component, of) count_tally(counters, COMPONENT_##component, (of).counted)

static inline void count_up(GLOBAL volatile uint* counter, uint amount) {
  if (amount == 0) return;
  const uint old = atomic_add(counter, amount);
  if (old + amount < old) atomic_inc(counter + 1);
}

static inline void count_steps(GLOBAL volatile uint* counters, uint steps) {
  atomic_max(counters + COUNTER_STEPS, steps);
  count_up(counters + COUNTER_STEPS + 1, steps);
}

static inline void count_tally(GLOBAL volatile uint* counters, int component, tally counted) {
  GLOBAL volatile uint* const kinds = counters + 2 * KINDS * component;
  count_up(kinds + 2 * KIND_ARITHMETIC, counted.arithmetic);
  count_up(kinds + 2 * KIND_ORIENTATION, counted.orientations);
  count_up(kinds + 2 * KIND_CIRCLE, counted.circles);
  if (component == COMPONENT_ENDGAME) {
    atomic_max(counters + COUNTER_DEAREST,
               counted.arithmetic + ORIENT_OPERATIONS * counted.orientations + CIRCLE_OPERATIONS * counted.circles);
  }
}
#else
#define COUNTERS
#define WITH_COUNTERS
#define COUNT(component, kind, amount)
#define COUNT_SIZE(corners)
#define COUNT_STEPS(amount)
#define COUNT_TALLY(component, of)
#endif

// The host's own algorithms always have tallies; kernels that run on the host have the member, but leave it alone.
#if defined(FLAUNAY_COUNT) || defined(__cplusplus)
#define TALLY_MEMBER tally counted;
#define CLEAR_TALLY(of) \
  (of).counted.arithmetic = (of).counted.orientations = (of).counted.circles = (of).counted.steps = 0
#else
#define TALLY_MEMBER
#define CLEAR_TALLY(of)
#endif
#if defined(FLAUNAY_COUNT) || (defined(__cplusplus) && !defined(FLAUNAY_NATIVE_KERNELS))
#define TALLY(of, kind, amount) (of).counted.kind += (amount)
#else
#define TALLY(of, kind, amount)
#endif

// Comparisons of a binary search among m elements: the ceiling of log2 m.
static inline int search_comparisons(int m) { return m <= 1 ? 0 : 32 - clz(m - 1); }

END_SHARED

#endif
