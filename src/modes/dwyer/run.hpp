// Mode dwyer: Dwyer's algorithm on the host, on the calling thread.
#pragma once

#include "geometry/point_sets.hpp"
#include "modes/dwyer/dwyer.hpp"
#include "statistics/phases.hpp"

namespace flaunay::dwyer {

/// Computes the Delaunay triangles of all sets, with any choice among cocircular points; geometry::finish
/// makes the canonical result. With Options::count, adds the work to the result. O(n log n).
geometry::Mesh run(const geometry::PointSets& sets, const research::Options& options,
                   const statistics::Phases& phases, research::Triangulation& result);

}  // namespace flaunay::dwyer
