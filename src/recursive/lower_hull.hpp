// The dividing path of a region: the strict lower hull of its points' projections, by any of the hull
// variants.
#pragma once

#include <vector>

#include "recursive/counter.hpp"
#include "recursive/line.hpp"
#include "recursive/prune.hpp"

namespace flaunay::recursive {

/// The points of a region in the frame of its line.
struct HullPoints {
  Line line;
  HullPoint first, last;  ///< the hull's ends: least and greatest u, the lower of these if there are several
  std::vector<HullPoint> internal;  ///< sorted along the line, either way
  std::vector<HullPoint> corners;   ///< of the border, in any order, a vertex perhaps more than once
};

struct LowerHull {
  Path path;
  std::vector<Kept> corners;  ///< no: known not to be on the path
};

/// Takes the strict lower hull by the given variant, whichever it is the same: no vertex lies on or above the
/// segment of its neighbours, and of points with equal projections the one of smaller s is the vertex.
/// O(n log n) work, for prune and monotone_chain O(n) plus what sorting the corners and few survivors take;
/// statistics: candidates, survivors and rounds are added.
LowerHull lower_hull(const Predicates& predicates, const HullPoints& points, Hull variant, Counter& counter,
                     LevelStatistics& statistics);

}  // namespace flaunay::recursive
