// An exact check of a triangulation on the sphere.
#pragma once

#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::prove {

/// Returns the first error found; empty if all is right. places: of the points. The mesh has arrays of
/// fitting sizes, and indices in their range. O(n log n).
std::string find_problem(const std::vector<double>& places, const Triangulation& mesh);

}  // namespace flaunay::prove
