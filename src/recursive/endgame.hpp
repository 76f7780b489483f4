// The host's twin of the stage `endgame`: the triangles of regions without internal points.
#pragma once

#include <cstdint>
#include <vector>

#include "recursive/border_merge.hpp"
#include "recursive/counter.hpp"

namespace flaunay::recursive {

/// Corners up to which a region is small, as SMALL_REGION in the kernels.
constexpr std::size_t kSmallRegion = 48;

/// Appends the triangles of a region, 3 ids each, counter-clockwise: of cocircular vertices any that fit
/// together. Throws Error(internal) if the border is not made of closed cycles. O(k^2) for k corners of a
/// small region at worst, else by dwyer() in O(k log k).
void end_game(const Predicates& predicates, const std::vector<Point>& points, const Border& border,
              std::vector<std::int32_t>& triangles, Counter& counter);

}  // namespace flaunay::recursive
