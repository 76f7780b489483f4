// The constrained Delaunay triangulation of what is inside of closed curves, without a triangulation of what
// is outside.
#pragma once

#include <cstddef>
#include <vector>

#include "constrained/small.hpp"

namespace flaunay::constrained {

/// Triangulates what the rules leave of small sets whose points are the corners of closed curves that neither
/// cross nor touch. Writes what blocks::small_rings and constrain_small lead to, the same bytes. Returns
/// false, with the result half changed, for all other sets, and if the request asks for labels, or for
/// levels. Throws what blocks::small_rings throws. O(n log n) as a rule, with O(s) for a point at which a
/// curve begins to the right of s segments; request.most_steps bounds their sum.
bool triangulate_inside(const double* coordinates, const std::vector<std::size_t>& offsets,
                        const Constraints& constraints, const SmallRequest& request,
                        ConstrainedTriangulation& result);

}  // namespace flaunay::constrained
