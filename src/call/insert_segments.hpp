// Makes segments edges of a triangulation in host memory: on the calling thread or on an engine.
#pragma once

#include <cstddef>
#include <vector>

#include "call/implementation.hpp"
#include "flaunay/constrained.hpp"
#include "geometry/magnitudes.hpp"

namespace flaunay::call {

/// Makes the segments edges of the result, which is what call::triangulate returned, with neighbours. Each
/// segment is one piece, and no points are added. Small sets stay on the calling thread if no device was
/// named. Throws what constrained::constrain throws.
void insert_segments(Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
                     const Constraints& constraints, const Options& options,
                     ConstrainedTriangulation& result);

/// Makes them edges on this engine. If points do not fit fixed point, nothing is changed.
geometry::Fitted<geometry::Done> insert_segments_on(Engine& engine, const double* coordinates,
                                                    const std::vector<std::size_t>& offsets,
                                                    const Constraints& constraints, const Options& options,
                                                    ConstrainedTriangulation& result);

}  // namespace flaunay::call
