// An exact check of a triangulation on a torus or a cylinder.
#pragma once

#include <string>

#include "flaunay/periodic.hpp"
#include "host/runtime.hpp"

namespace flaunay::periodic {

/// Returns what is wrong, or nothing. The mesh must have been checked by call::check. O(n log n).
std::string find_problem(host::Runtime& runtime, const PeriodicTriangulation& mesh);

}  // namespace flaunay::periodic
