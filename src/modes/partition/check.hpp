// Checks whether triangles that another program made are a Delaunay triangulation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/mesh.hpp"
#include "geometry/predicates.hpp"

namespace flaunay::partition {

/// Makes the mesh of a Delaunay triangulation of points[0..n), which must be distinct and in the order of
/// (x, y). triangles: 3 positions in points each, in either orientation; none if the points are collinear.
/// Throws Error(input), which says why, if they are not a Delaunay triangulation; its message calls points[i]
/// by the number names[i]. O(n log n).
geometry::Mesh checked_mesh(const geometry::Predicates& predicates, const geometry::Point* points,
                            std::size_t n, const std::int32_t* names, std::vector<std::int32_t> triangles);

}  // namespace flaunay::partition
