// Dwyer's divide and conquer: Guibas and Stolfi's merge with alternating cuts.
#pragma once

#include <cstddef>

#include "flaunay/research.hpp"
#include "geometry/mesh.hpp"
#include "geometry/point_sets.hpp"
#include "statistics/phases.hpp"

namespace flaunay::dwyer {

/// Computes the Delaunay triangulation of points[0..n), which must be distinct and in the order of (x, y).
/// Triangles hold positions in points. The choice among cocircular points depends on the points alone.
/// O(n log n) in the worst case; for uniform points all merges together take O(n log log n) (Dwyer 1987). The
/// recursion is not deeper than log2 n.
///
/// work: if not null, the work is added to it. `start` gets the sort by y, as component `cut` (see
/// comparisons_to_sort). Level l gets the cuts at depth l of the recursion, one comparison per point with the
/// critical path of a stable split; and the merges at that depth, with the leaves of two or three points.
/// Each merge is sequential, so its critical path is as long as its work.
geometry::Mesh triangulate(const geometry::Predicates& predicates, const geometry::Point* points,
                           std::size_t n, research::Work* work = nullptr);

/// Mode dwyer: triangulates all sets on the calling thread; geometry::finish makes the canonical result. With
/// Options::count, adds the work to the result. O(n log n).
geometry::Mesh run(const geometry::PointSets& sets, const research::Options& options,
                   const statistics::Phases& phases, research::Triangulation& result);

}  // namespace flaunay::dwyer
