// Checks of the arrays of given triangulations.
#pragma once

#include <cstddef>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::call {

/// Throws Error(usage) for points and arrays of a triangulation whose sizes or indices do not fit each other.
/// Neighbours, half-edges and areas may be empty. O(n).
void check_arrays(const double* points, const std::vector<std::size_t>& offsets, const Triangulation& mesh);

}  // namespace flaunay::call
