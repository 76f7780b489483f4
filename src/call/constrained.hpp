// Constrained triangulations of points in host memory.
#pragma once

#include <cstddef>
#include <vector>

#include "call/domains.hpp"
#include "call/implementation.hpp"
#include "flaunay/constrained.hpp"

namespace flaunay::call {

/// Triangulates sets with segments, labels the triangles, and leaves out what the request and the holes say.
/// Rings must have been checked.
ConstrainedTriangulation constrain_and_leave(Implementation& self, const double* coordinates,
                                             const std::vector<std::size_t>& offsets,
                                             const Constraints& constraints,
                                             const ConstrainedOptions& options, const DomainRequest& request);

}  // namespace flaunay::call
