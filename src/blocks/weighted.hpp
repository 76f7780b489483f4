// How blocks of weighted points are triangulated and merged. Programs that have none, such as the module for
// browsers, are linked without it: it comes with the weights.
#pragma once

#include <cstddef>

#include "blocks/pipeline.hpp"
#include "launchers/blocks/divide.cl.hpp"

namespace flaunay::blocks {

/// A launch that solves blocks, one after the other on each worker; see solve_blocks in blocks/divide.cl.
struct BlocksLaunch {
  std::size_t workers, blocks, capacity;
  std::ptrdiff_t larger;
  host::Buffer<cl_int> next;
  kernels::block_points points;
  kernels::block_scratch scratch;
  host::Buffer<cl_uchar> scratch_axes;
};

}  // namespace flaunay::blocks

namespace flaunay::points {

/// Launches in place of those for points without weights.
struct WeightedSolver {
  void (*solve)(Workspace& work, const Blocks& blocks, const Rings& rings,
                const flaunay::blocks::BlocksLaunch& launch);
  void (*merge)(Workspace& work, const Blocks& blocks, std::size_t first, std::size_t end,
                const Rings& rings);
};

}  // namespace flaunay::points

namespace flaunay::blocks {

extern const points::WeightedSolver kWeightedSolver;

}  // namespace flaunay::blocks
