// Dwyer's divide and conquer: Guibas and Stolfi's merge with alternating cuts.
#pragma once

#include <cstddef>

#include "flaunay/flaunay.hpp"
#include "recursive/mesh.hpp"
#include "recursive/predicates.hpp"

namespace flaunay::recursive {

/// The Delaunay triangulation of points[0..n), distinct and in (x, y) order; triangles hold positions in
/// points. The choice among cocircular points is a function of the points. O(n log n) in the worst case; the
/// merges take O(n log log n) together for uniform points (Dwyer 1987). No recursion is deeper than log2 n.
///
/// work: if not null, what was done is added to it, n points at a time: `start` gets the sort by y, as `cut`
/// (see comparisons_to_sort); level l the cuts at depth l of the recursion, a comparison a point, its
/// critical path that of a stable split; and the merges at that depth, with the leaves of two or three points
/// that are there, each a sequence that is as long as its critical path.
Mesh dwyer(const Predicates& predicates, const Point* points, std::size_t n, Work* work = nullptr);

}  // namespace flaunay::recursive
