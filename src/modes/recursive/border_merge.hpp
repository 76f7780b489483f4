// The stage `merge` on the host: a region's path splits its border in two.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "modes/recursive/lower_hull.hpp"
#include "statistics/counter.hpp"

namespace flaunay::recursive {

/// A vertex of a border and its two neighbours, as ids. The region is on the left of both edges. A border is
/// a set of corners in any order; a vertex that the border passes several times has several corners.
struct Corner {
  std::int32_t before, vertex, after;
};
using Border = std::vector<Corner>;

/// The borders of the parts left and right of a path.
using SplitBorder = std::array<Border, 2>;

/// Splits a border by a path. hull.corners has a flag per corner of the border. is_internal: per path vertex,
/// whether it was an internal point, so that it gets a corner on either side. O(border log path).
SplitBorder merge_border(const geometry::Predicates& predicates, const std::vector<geometry::Point>& points,
                         const Line& line, const Border& border, const LowerHull& hull,
                         const std::vector<char>& is_internal, statistics::Counter& counter);

}  // namespace flaunay::recursive
