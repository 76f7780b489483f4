// How blocks of weighted points are triangulated and merged. Programs that have none, such as the module for
// browsers, are linked without it: it comes with the weights.
#pragma once

#include <cstddef>
#include <vector>

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

/// The stages of regular triangulations, in place of those for points without weights or besides them.
struct WeightedSolver {
  /// Scales weights of points that were multiplied by these powers of two: one for all sets, or one per set.
  /// Throws Error(input) for a weight that is not finite, or beyond the squares of what coordinates may be.
  /// Waits once.
  Weights (*scale)(Workspace& work, const Weights& given, const std::vector<std::size_t>& offsets,
                   const std::vector<int>& shifts);
  void (*solve)(Workspace& work, const Blocks& blocks, const Rings& rings,
                const flaunay::blocks::BlocksLaunch& launch);
  /// After stage `halve`.
  void (*merge_halves)(Workspace& work, const flaunay::blocks::PointBlocks& blocks,
                       const flaunay::blocks::HalvedBlocks& halved, const Buffer<cl_int>& representatives,
                       const Rings& rings);
  void (*merge)(Workspace& work, const Blocks& blocks, std::size_t first, std::size_t end,
                const Rings& rings);
  /// The size of the mesh but for MeshSizes::first_rows. walked: the walks around hulls, which are being
  /// read; rows: the first triangle of each vertex. Waits once.
  flaunay::blocks::MeshSizes (*mesh_sizes)(Workspace& work, const Blocks& blocks,
                                           const std::vector<cl_int>& walked, const Buffer<cl_uint>& rows);
  /// Writes the hidden points, of which the lighter ones of points in one place are some, and makes
  /// representatives those of equal places and weights. Returns the number of hidden points. Waits twice; if
  /// there are lighter points, the host names their representatives.
  std::size_t (*settle)(Workspace& work, const Blocks& blocks, const Rings& rings,
                        const Buffer<cl_int>& representatives);
};

}  // namespace flaunay::points

namespace flaunay::blocks {

extern const points::WeightedSolver kWeightedSolver;

}  // namespace flaunay::blocks
