// Is it a Delaunay triangulation? For triangles that come from outside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recursive/mesh.hpp"
#include "recursive/predicates.hpp"

namespace flaunay::recursive {

/// The mesh of a Delaunay triangulation of points[0..n), distinct and in (x, y) order. triangles: 3 positions
/// in points each, in either orientation. Throws Error(input) that says what is wrong if it is anything else;
/// names[i] is what to call points[i] there. Collinear points have no triangles. O(n log n).
Mesh checked_mesh(const Predicates& predicates, const Point* points, std::size_t n, const std::int32_t* names,
                  std::vector<std::int32_t> triangles);

}  // namespace flaunay::recursive
