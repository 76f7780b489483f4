// The dividing path of a region: the strict lower hull of its points' projections, by any of the hull
// variants.
#pragma once

#include "modes/recursive/line.hpp"
#include "modes/recursive/prune.hpp"
#include "statistics/counter.hpp"

namespace flaunay::recursive {

/// Computes the strict lower hull by the given variant; all variants give the same hull. No vertex lies on or
/// above the segment between its neighbours. If several points have equal projections, the one of smaller s
/// is the vertex. O(n log n) work; prune and monotone_chain take O(n) plus sorting the corners and the few
/// survivors. statistics: candidates and survivors are added; the numbers of rounds become the maximum.
LowerHull lower_hull(const geometry::Predicates& predicates, const HullPoints& points,
                     statistics::Hull variant, statistics::Counter& counter,
                     statistics::LevelStatistics& statistics);

}  // namespace flaunay::recursive
