// Carries information of the given segments over to a triangulation with constraints.
#pragma once

#include <cstddef>

#include "constrained/crossings/split.hpp"
#include "flaunay/constrained.hpp"

namespace flaunay::constrained {

/// Turns a triangulation of all points with the pieces of split segments into one of the points and segments
/// themselves: added points are numbered after all others. O(n).
void carry_split(const AllPoints& all, Split&& split, ConstrainedTriangulation& result);

/// Gives edges the markers of their segments, and so points that were added on them. n: the number of points
/// of the caller. O(n).
void carry_markers(const Constraints& constraints, std::size_t n, ConstrainedTriangulation& result);

}  // namespace flaunay::constrained
