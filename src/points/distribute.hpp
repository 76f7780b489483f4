// Distributes points to blocks: the leaves of cut trees, each small enough for one work-item.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "arithmetic/records.h"
#include "geometry/magnitudes.hpp"
#include "host/runtime.hpp"
#include "points/cut_tree.hpp"
#include "points/records.h"

namespace flaunay::points {

using host::Arena;
using host::Buffer;

struct WeightedSolver;

/// Weights of points, for regular triangulations.
struct Weights {
  /// By index of the input. In a workspace they are scaled as the squares of coordinates are.
  Buffer<cl_double> by_point{};
  const WeightedSolver* solver = nullptr;  ///< see blocks/weighted.hpp
  /// Returns the array for this number of hidden points.
  std::function<Buffer<cl_int>(std::size_t)> hidden{};
  /// Returns the number of a point in error messages, by its index; empty if that is the number.
  std::function<std::size_t(std::size_t)> number{};
  double range = 0;  ///< the largest difference of two scaled weights
};

/// The context of every stage.
struct Workspace {
  host::Runtime& runtime;
  Arena& persistent;  ///< arrays that live as long as the call
  geometry::Bounds bounds{};
  /// Merges keep all edges in cocircular polygons as they find them, on any device. Otherwise single
  /// work-items make small polygons canonical at once.
  bool ties_are_left = false;
  const Weights* weights = nullptr;  ///< null if points have none

  Arena& scratch() { return runtime.arena(); }
};

/// The leaves of all sets' cut trees.
struct Blocks {
  std::size_t sets = 0;
  std::size_t points = 0;
  std::size_t count = 0;
  std::vector<cl_int> set_blocks;  ///< sets + 1: the first block of each set
  /// count + 1: the first point of each block. Empty if the host has not read them; then blocks of more than
  /// `largest` points are left unsolved.
  std::vector<cl_int> offsets;
  std::size_t largest = 0;
  std::vector<kernel::block_merge> merges;  ///< from the leaves to the root
  /// Merges [level_ends[l - 1], level_ends[l]) are independent of each other.
  std::vector<std::size_t> level_ends;
  Buffer<cl_int> device_set_points{};  ///< sets + 1: the first point of each set
  Buffer<cl_int> device_set_blocks{}, device_offsets{};
  Buffer<kernel::block_merge> device_merges{};
  Buffer<kernel::cut_node> device_nodes{};  ///< the nodes of all trees
  kernel::scaling scale{1, 1, 1};           ///< the factor of the nodes' coordinates
  std::vector<int> shifts;                  ///< UniformPoints::shifts
  /// The scaled points, block by block, and their indices in the input. After blocks are triangulated, the
  /// distinct points of each block come first; these are its vertices.
  Buffer<cl_double2> vertices{};
  Buffer<cl_int> source{};
};

/// Checks and scales the points, x0 y0 x1 y1 ..., and distributes them to blocks. representatives: set to its
/// own index for every point. host_points: the points in host memory, or null. Throws Error(input) for points
/// that are not finite or whose magnitudes differ too much. O(n log n).
geometry::Fitted<Blocks> make_blocks(Workspace& work, const Buffer<cl_double>& input,
                                     const std::vector<std::size_t>& offsets,
                                     const Buffer<cl_int>& representatives,
                                     const double* host_points = nullptr);

/// Where trees cut: at medians, or in gaps, which suits points along the cuts of an earlier tree.
enum class Cuts { at_medians, in_gaps };

/// Whether the host waits for the sizes of blocks.
enum class BlockSizes { read, guessed };

/// Distributes points that are scaled and checked already to blocks of at most block_points points, as a
/// rule. Their sources are their places in `points`. A set of up to twice as many points is one block, and
/// guessed sizes are at most that large. On devices without groups for tiles, all cuts are at medians and all
/// sizes are read. O(n log n).
Blocks make_blocks_of(Workspace& work, const Buffer<cl_double2>& points,
                      const std::vector<std::size_t>& offsets, std::size_t block_points, Cuts cuts,
                      BlockSizes sizes);

}  // namespace flaunay::points
