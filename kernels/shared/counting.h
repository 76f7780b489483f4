// Counters of operations, in a build of the kernels with FLAUNAY_COUNT; nothing otherwise. docs/counting.md says what
// counts.
#ifndef FLAUNAY_COUNTING_H
#define FLAUNAY_COUNTING_H

// As flaunay::Component and the members of flaunay::OperationCounts.
#define COMPONENT_CUT 0
#define COMPONENT_HULL 1
#define COMPONENT_MERGE 2
#define COMPONENT_SPLIT 3
#define COMPONENT_ENDGAME 4
#define KIND_ARITHMETIC 0
#define KIND_DEPTH 1
#define KIND_ORIENTATION 2
#define KIND_CIRCLE 3

// Operations of one evaluation; tests/counting_test.cpp holds them to the code.
#define DEPTH_OPERATIONS 12
#define ORIENT_OPERATIONS 8
#define CIRCLE_OPERATIONS 30
// The dot product that goes with an orientation, and the comparison of two angles.
#define DOT_OPERATIONS 3
#define ANGLE_OPERATIONS 4

// The counters are pairs of low and high halves, a pair a component and kind; behind them the largest number of
// weighted operations that one region of the end game took, and how many regions it had by their number of corners.
#define KINDS 4
#define COUNTER_DEAREST 40
#define COUNTER_SIZES 41
#define MOST_COUNTED_SIZE 1023

#ifdef FLAUNAY_COUNT
// Stands behind a kernel's last parameter; the host sets it.
#define COUNTERS , global volatile uint *counters
#define WITH_COUNTERS , counters
static inline void count_up(global volatile uint* counter, uint amount) {
  const uint old = atomic_add(counter, amount);
  if (old + amount < old) atomic_inc(counter + 1);
}
#define COUNT(component, kind, amount) count_up(counters + 2 * (KINDS * (component) + (kind)), amount)
#define COUNT_REGION(corners, operations)                                     \
  {                                                                           \
    atomic_inc(counters + COUNTER_SIZES + min(corners, MOST_COUNTED_SIZE));   \
    atomic_max(counters + COUNTER_DEAREST, (uint)(operations));               \
  }
#define COUNTED(statement) statement
#else
#define COUNTERS
#define WITH_COUNTERS
#define COUNT(component, kind, amount)
#define COUNT_REGION(corners, operations)
#define COUNTED(statement)
#endif

// Comparisons of a binary search among m elements: the ceiling of log2 m.
static inline int search_comparisons(int m) { return m <= 1 ? 0 : 32 - clz(m - 1); }

#endif
