// Mode blocks for sets of at most a block's points each, on the calling thread: native kernels, launched
// without a runtime, arenas and a frame, which would take half as long again as a call on 32 points.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "points/rings.hpp"

namespace flaunay::blocks {

/// Triangulates sets that are one block each, with the results and the errors of run(). Writes all of
/// `result` but times and the name of the device. coordinates: x0 y0 x1 y1 ...; offsets: as in
/// Triangulator::triangulate. Scratch memory of some 140 bytes per point is kept for the thread's next call.
/// O(n log n).
void run_small(const double* coordinates, const std::vector<std::size_t>& offsets, const Options& options,
               Triangulation& result);

/// Does the part of run_small before triangles, neighbours and half-edges are written. Returns nothing if all
/// is done, since the points of a single set are on one line.
std::optional<points::SmallRings> small_rings(const double* coordinates,
                                              const std::vector<std::size_t>& offsets, Triangulation& result);

}  // namespace flaunay::blocks
