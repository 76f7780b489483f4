// Whether a regular triangulation is right.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/weighted.hpp"

namespace flaunay::weighted {

/// A triangulation with what it is of.
struct Claim {
  const double* points;
  const double* weights;
  const std::vector<std::size_t>& offsets;
  const WeightedTriangulation& mesh;
};

/// Finds what is wrong with the triangles and the hull, by themselves; empty if nothing is.
/// O(n log n).
std::string find_problem(const Claim& claim);
/// Finds what is wrong with hidden points in a triangulation without such a problem. hiding: of each hidden
/// point the triangle that has it inside or on its border, or -1. O(n).
std::string find_problem_of_hidden(const Claim& claim, const std::vector<std::int32_t>& hiding);

}  // namespace flaunay::weighted
