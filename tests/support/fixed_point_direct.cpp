#define SHARED_NAMESPACE flaunay::fixed_direct
#include "tests/support/fixed_point_text.hpp"

const flaunay::testing::FixedPredicates& flaunay::testing::fixed_predicates() {
  static const FixedPredicates reading = fixed_direct::reading_named("as written");
  return reading;
}
