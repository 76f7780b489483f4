// The stage `endgame` on the host: the triangles of regions without internal points.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "geometry/region_arrays.hpp"
#include "modes/recursive/border_merge.hpp"
#include "statistics/counter.hpp"

namespace flaunay::recursive {

/// Triangulates one region with many corners. Returns 3 ids per triangle, and adds to the work. Throws
/// Error(input) if its corners do not form a border.
using SolveRegion =
    std::function<std::vector<std::int32_t>(const geometry::RegionArrays& region, research::Work& work)>;

/// Appends the triangles of a region, 3 ids each, counter-clockwise, with any choice among cocircular points.
/// Throws Error(internal) if the border is not made of closed cycles. Small regions of k corners take O(k^2)
/// in the worst case; solve_large triangulates larger ones.
void end_game(const geometry::Predicates& predicates, const std::vector<geometry::Point>& points,
              const Border& border, const SolveRegion& solve_large, std::vector<std::int32_t>& triangles,
              statistics::Counter& counter);

}  // namespace flaunay::recursive
