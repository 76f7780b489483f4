// The stage `border` on the host: the convex hull of a set, which is its border before the first cut.
#pragma once

#include "geometry/point_sets.hpp"
#include "modes/recursive/border_merge.hpp"
#include "statistics/counter.hpp"

namespace flaunay::recursive {

/// The corners of the convex hull of the points with ids low..high-1, including points on its edges,
/// counter-clockwise from the smallest id; none for points on one line. The lower and the upper hull are
/// computed independently by the given variant; their work is added to `work`.
Border first_border(const geometry::PointSets& sets, std::int32_t low, std::int32_t high,
                    statistics::Hull variant, statistics::OperationCounts& work);

}  // namespace flaunay::recursive
