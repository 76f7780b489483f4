// The host's twin of the stage `border`: what encloses a set before the first cut.
#pragma once

#include "recursive/border_merge.hpp"
#include "recursive/counter.hpp"
#include "recursive/points.hpp"

namespace flaunay::recursive {

/// The corners of the convex hull of the points with ids low..high-1, those on its edges included,
/// counter-clockwise from the smallest id; none for points on one line. By the planar hulls of the given
/// variant, the lower and the upper one side by side. work: what they take is added.
Border first_border(const PointSets& sets, std::int32_t low, std::int32_t high, Hull variant,
                    OperationCounts& work);

}  // namespace flaunay::recursive
