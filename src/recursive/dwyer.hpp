// Dwyer's divide and conquer: Guibas and Stolfi's merge with alternating cuts.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "recursive/points.hpp"

namespace flaunay::recursive {

/// The Delaunay triangulation of points[0..n), distinct and in (x, y) order; what `order` of cocircular
/// points is chosen is a function of the points.
struct Mesh {
  std::vector<std::int32_t> triangles;  ///< 3 positions in points each, counter-clockwise
  std::vector<std::int32_t> twins;      ///< of half-edges; see mesh.hpp
};

/// O(n log n) in the worst case, O(n log log n) expected for uniform points before the sort (Dwyer 1987).
/// work: if not null, gets what was counted: `cut` the comparisons of the alternating partition, `merge` that
/// of each level's merges.
Mesh dwyer(const Predicates& predicates, const Point* points, std::size_t n, Work* work = nullptr);

}  // namespace flaunay::recursive
