// An exact check of a triangulation on a torus or a cylinder.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::prove {

/// Returns the first error found; empty if all is right. call::check_on_torus must have checked the mesh.
/// weights: one per point, or null. O(n log n), but for walks to hidden points.
std::string find_problem(const Triangulation& mesh, const double* weights);

/// The triangles beyond the edges opposite to corners, or -1. offsets: as in Triangulation. If a
/// half-edge occurs twice, either of its triangles is returned. O(t log t) for t triangles.
std::vector<std::int32_t> neighbors_of(const std::vector<std::int32_t>& triangles,
                                       const std::vector<std::int8_t>& offsets);

}  // namespace flaunay::prove
