// Mode::recursive: the algorithm of Blelloch, Miller and Talmor (1996) as plain recursion, one region at a
// time.
//
// The readable twin of the kernels: the same decisions by the same predicates, a function for each stage.
#pragma once

#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "recursive/points.hpp"

namespace flaunay::recursive {

/// The Delaunay triangles of all sets: 3 ids each, counter-clockwise, in no order of note, with any choice
/// among cocircular points; finish() makes the canonical result of them. Honours Options::cut, hull, and
/// count; adds to statistics the levels, and with Options::count the work. Throws Error(internal) for a
/// broken invariant. Recursion of log2 n levels; O(n log n) work for points without long borders.
std::vector<std::int32_t> recursive_triangles(const PointSets& sets, const Options& options,
                                              Statistics& statistics);

}  // namespace flaunay::recursive
