// An exact check of a triangulation on the sphere.
#pragma once

#include <string>
#include <vector>

#include "flaunay/sphere.hpp"
#include "host/runtime.hpp"

namespace flaunay::sphere {

/// Returns what is wrong, or nothing. places: those of the points. The mesh has arrays of fitting sizes, and
/// indices in their range. O(n).
std::string find_problem(host::Runtime& runtime, const std::vector<double>& places,
                         const SphericalTriangulation& mesh);

}  // namespace flaunay::sphere
