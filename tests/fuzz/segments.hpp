// Random segments that are hard for constrained triangulations.
#pragma once

#include "tests/fuzz/batch.hpp"

namespace flaunay::fuzz {

/// Like degenerate_batch, with segments: between any points, of which some cross; ones that do not cross;
/// along lines through many points, overlapping and nested; stars; edges of other triangulations; and nasty
/// ones (tests/constrained/nasty.hpp), also between points rounded onto few lines. Some are then scaled, by
/// 2^-1074 to 2^970, and points of some are moved by one unit in the last place.
SegmentBatch degenerate_segments(testing::FixtureRandom& random);

/// Like degenerate_batch, with closed curves that do not cross: around triangles of another triangulation, in
/// both directions, some of them twice.
SegmentBatch closed_curves(testing::FixtureRandom& random);

}  // namespace flaunay::fuzz
