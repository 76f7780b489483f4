// Contour lines of values at the corners of triangles.
#pragma once

#include <vector>

#include "flaunay/terrain.hpp"
#include "host/runtime.hpp"

namespace flaunay::contours {

/// See trace_contours. The arrays of the mesh are there, and heights increase. The runtime runs natively.
Contours compute(host::Runtime& runtime, const MeshView& mesh, const double* values,
                 const std::vector<double>& heights, double max_edge);

}  // namespace flaunay::contours
