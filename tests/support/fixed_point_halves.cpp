#define SHARED_NAMESPACE flaunay::fixed_halves
#define CONVERT_HALVES
#include "tests/support/fixed_point_text.hpp"

const flaunay::testing::FixedPredicates& flaunay::testing::fixed_predicates_by_halves() {
  static const FixedPredicates reading = fixed_halves::reading_named("by halves");
  return reading;
}
