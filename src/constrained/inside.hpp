// The constrained Delaunay triangulation of the inside of closed curves, without triangulating the outside.
#pragma once

#include <cstddef>
#include <vector>

#include "constrained/small.hpp"

namespace flaunay::constrained {

/// Triangulates the area that the rules keep of small sets whose points are the corners of closed curves that
/// neither cross nor touch. Writes the same bytes as blocks::small_rings followed by constrain_small. Returns
/// false, with the result half changed, for all other sets, and if the request asks for labels, or for
/// levels. Throws the errors of blocks::small_rings. O(n log n) as a rule, with O(s) for a point at which a
/// curve begins to the right of s segments; request.most_steps bounds their sum.
bool triangulate_inside(const double* coordinates, const std::vector<std::size_t>& offsets,
                        const Constraints& constraints, const SmallRequest& request,
                        ConstrainedTriangulation& result);

}  // namespace flaunay::constrained
