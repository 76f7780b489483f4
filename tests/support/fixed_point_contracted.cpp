// Compiled so that products and sums are contracted, where compilers and processors can (with -O2).
#define SHARED_NAMESPACE flaunay::fixed_contracted
#include "tests/support/fixed_point_text.hpp"

const flaunay::testing::FixedPredicates& flaunay::testing::fixed_predicates_contracted() {
#ifdef __FMA__
  static const FixedPredicates reading = fixed_contracted::reading_named("contracted");
  if (__builtin_cpu_supports("fma") != 0) return reading;
#endif
  return fixed_predicates();
}
