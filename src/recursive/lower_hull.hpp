// The dividing path of a region: the strict lower hull of its points' projections, by any of the hull
// variants.
#pragma once

#include <vector>

#include "recursive/counter.hpp"
#include "recursive/line.hpp"
#include "recursive/prune.hpp"

namespace flaunay::recursive {

struct LowerHull {
  Path path;
  std::vector<Kept> corners;  ///< no: known not to be on the path
};

/// Takes the strict lower hull by the given variant, whichever it is the same: no vertex lies on or above the
/// segment of its neighbours, and of points with equal projections the one of smaller s is the vertex.
/// O(n log n) work, for prune and monotone_chain O(n) plus what sorting the corners and few survivors take;
/// statistics: candidates and survivors are added, of rounds the greatest number is noted.
LowerHull lower_hull(const Predicates& predicates, const HullPoints& points, Hull variant, Counter& counter,
                     LevelStatistics& statistics);

}  // namespace flaunay::recursive
