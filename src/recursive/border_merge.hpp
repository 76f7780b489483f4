// The host's twin of the stage `merge`: a region's path splits its border in two.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "recursive/counter.hpp"
#include "recursive/lower_hull.hpp"

namespace flaunay::recursive {

/// A vertex of a border with its neighbours, the region on the left of both edges. Ids. A border is an
/// unordered run of corners; a vertex that it passes more than once has a corner for each time.
struct Corner {
  std::int32_t before, vertex, after;
};
using Border = std::vector<Corner>;

/// The borders of what lies left and right of a path.
using SplitBorder = std::array<Border, 2>;

/// border: with a flag in hull.corners for each corner. is_internal: for each path vertex whether it was an
/// internal point, so that it gets a corner on either side. O(border log path).
SplitBorder merge_border(const Predicates& predicates, const std::vector<Point>& points, const Line& line,
                         const Border& border, const LowerHull& hull, const std::vector<char>& is_internal,
                         Counter& counter);

}  // namespace flaunay::recursive
