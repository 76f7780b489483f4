// Trees of cuts, which divide sets of points into blocks.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/runtime.hpp"
#include "launchers/points/cut_tree.cl.hpp"
#include "points/records.h"

namespace flaunay::points {

/// A set, which has points [first_point, first_point + points), and the depth that its tree shall have.
struct SetToCut {
  int depth;
  std::size_t first_point, points;
};

/// Trees with 2^depth leaves, stored like a heap: node k has the children 2k and 2k + 1, and node 0 is not
/// used. Cuts go across the longer interquartile range of the samples. The trees of all sets are made at
/// once, on the device, from the same number of samples per leaf. No function waits. Memory comes from the
/// runtime's arena, in the caller's scope.
class CutTrees {
 public:
  CutTrees(host::Runtime& runtime, const std::vector<SetToCut>& sets, std::size_t samples_per_leaf);

  /// The number of samples of all trees; they are stored tree by tree.
  std::size_t samples() const { return samples_; }
  /// The number of nodes of all trees; they are stored tree by tree.
  std::size_t nodes() const { return nodes_; }

  struct Samples {
    host::Buffer<cl_double2> points;
    host::Buffer<cl_int> indices;
  };
  /// Divides each set into as many equal parts as it has samples, and draws one point from each part by a
  /// fixed rule. input: x0 y0 x1 y1 ...
  Samples draw(const host::Buffer<cl_double>& input) const;
  /// Computes the nodes from m samples. Returns the numbers of the samples in the order of the leaves; behind
  /// them, the array has m further entries in another such order. O(m log m).
  host::Buffer<cl_int> cut(const host::Buffer<cl_double2>& samples,
                           const host::Buffer<kernel::cut_node>& nodes) const;

  /// Computes the nodes for points that lie along the cuts of an earlier tree, on a device that has groups
  /// for tiles (Sizes::tile_group): each is cut in its widest gap. O(m log m).
  void cut_at_gaps(const host::Buffer<cl_double2>& samples,
                   const host::Buffer<kernel::cut_node>& nodes) const;

 private:
  template <typename Kernel>
  void launch(std::size_t items_per_chunk, const Kernel& kernel) const;
  kernels::sampled_chunks chunks_of(const host::Buffer<cl_double2>& samples) const;
  void sort_chunks(const host::Buffer<cl_double2>& samples, const host::Buffer<cl_int>& order) const;

  // For devices with many lanes; see cut_tree_tiles.cpp.
  template <typename Kernel>
  void launch_tiles(std::size_t groups_per_tile, const Kernel& kernel) const;
  void draw_each(const host::Buffer<cl_double>& input, const Samples& samples) const;
  /// The numbers of the samples in the orders along x and y, and for each sample its places in both.
  struct Sorted {
    host::Buffer<cl_int> order, spare, ranks;
  };
  Sorted sort_tiles(const host::Buffer<cl_double2>& samples) const;
  host::Buffer<cl_int> cut_tiles(const host::Buffer<cl_double2>& samples,
                                 const host::Buffer<kernel::cut_node>& nodes) const;

  host::Runtime& runtime_;
  std::size_t samples_per_leaf_;
  bool by_tiles_;  // work-groups take chunks
  std::size_t samples_ = 0, nodes_ = 0, chunks_ = 0;
  int levels_above_chunks_ = 0;
  std::vector<int> depths_;
  host::Buffer<kernel::sampled_tree> trees_{};
  host::Buffer<cl_int> first_chunks_{};
  host::Buffer<cl_int> first_samples_{};
};

}  // namespace flaunay::points
