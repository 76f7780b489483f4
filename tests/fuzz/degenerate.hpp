// Random point sets that are hard for triangulators.
#pragma once

#include "tests/fuzz/batch.hpp"

namespace flaunay::fuzz {

/// A batch of one or more sets, some of them empty, few of more than a thousand points: small grids,
/// cocircular and collinear points, duplicates, all fixtures, unions of these, many moved by a unit in the
/// last place or scaled to extreme magnitudes. All coordinates are finite; few batches are out of the range
/// of magnitudes.
Batch degenerate_batch(testing::FixtureRandom& random);

/// One such set of 5,000 to 100,000 points, smaller ones more often.
Batch large_set(testing::FixtureRandom& random);

}  // namespace flaunay::fuzz
