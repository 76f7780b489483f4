// Mode::recursive: the algorithm of Blelloch, Miller and Talmor (1996) as plain recursion, one region at a
// time.
//
// The readable version of the kernels: it takes the same decisions by the same predicates, and has a function
// per stage.
#pragma once

#include <cstdint>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/point_sets.hpp"
#include "modes/recursive/endgame.hpp"

namespace flaunay::recursive {

/// Computes the Delaunay triangles of all sets: 3 ids each, counter-clockwise, in any order, with any choice
/// among cocircular points; geometry::finish makes the canonical result. Uses Options::cut, hull and count.
/// Adds the levels to the result, and with Options::count the work. Throws Error(internal) for a broken
/// invariant. The recursion has log2 n levels. O(n log n) work if borders are short.
std::vector<std::int32_t> run(const geometry::PointSets& sets, const research::Options& options,
                              const SolveRegion& solve_large, research::Triangulation& result);

}  // namespace flaunay::recursive
