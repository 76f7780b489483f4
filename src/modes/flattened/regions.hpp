// Regions that are small enough for the solver of blocks.
#pragma once

#include <cstddef>

#include "modes/flattened/run.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {

/// The result of solve_regions.
struct SolvedRegions {
  std::size_t triangles = 0;
  std::size_t undecided = 0;  ///< predicates that were evaluated exactly
  std::size_t ties = 0;       ///< how many of them found cocircular points
};

/// Triangulates a level's regions as blocks of their points, and writes the triangles inside of their borders
/// as rows from `base` on; twins: where both half-edges of an edge are in these rows. Ties may be broken in
/// any way. If there are more rows than `triangles` has room for, none are written. arena: for the points, at
/// most 28 bytes each. Waits four times.
SolvedRegions solve_regions(Workspace& work, const PointTable& table, const Level& level, Arena& arena,
                            const BlockSolver& solver, const Buffer<cl_int>& triangles, std::size_t base,
                            const Buffer<cl_int>& twins);

}  // namespace flaunay::flattened
