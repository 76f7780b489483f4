// How a set of points is cut into blocks.
#pragma once

#include <CL/cl.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "host/runtime.hpp"

namespace flaunay::hybrid {

/// A cut across x or y, as blocks.cl has it: a point goes high unless it comes before the pivot, by (x, y),
/// or by (y, -x) if turn has all bits set. Coordinates as numbers in their order, of -x the complement.
struct CutNode {
  cl_ulong major, minor, turn;

  int axis() const { return turn != 0; }
};

/// Of a tree whose leaves are blocks, by leaf: the largest of so many blocks holds less than twice its share,
/// as a rule.
constexpr std::size_t kSamplesPerBlock = 16;

/// A set of points [first_point, first_point + points) and how deep its tree is to be.
struct SetToCut {
  int depth;
  std::size_t first_point, points;
};

/// A set's tree, as cut_tree.cl has it.
struct SampledTree {
  cl_int first_sample, samples, leaf, chunk, first_node, first_point, points;
};

/// Trees with 2^depth leaves, in the order of a heap: node k has the children 2k and 2k + 1, and node 0 is
/// not used. Cuts go across the longer interquartile range of the samples. Made on the device, those of all
/// sets at once, from equally many samples by leaf. Nothing waits. All memory is the runtime's arena's, and
/// the caller's scope ends it.
class CutTrees {
 public:
  CutTrees(host::Runtime& runtime, const std::vector<SetToCut>& sets, std::size_t samples_per_leaf);

  /// Of all trees: each one's after those of the tree before.
  std::size_t samples() const { return samples_; }
  std::size_t nodes() const { return nodes_; }

  struct Samples {
    host::Buffer<cl_double2> points;
    host::Buffer<cl_int> indices;
  };
  /// One point from each of as many equal parts of its set, drawn by the same rule every time. input: x0 y0
  /// x1 y1...
  Samples draw(const host::Buffer<cl_double>& input) const;
  /// Makes the nodes and returns the numbers of the samples in the order of leaves (and then, as many, in
  /// another such order). O(m log m).
  host::Buffer<cl_int> cut(const host::Buffer<cl_double2>& samples, const host::Buffer<CutNode>& nodes) const;

  /// A bound of the memory for so many trees that have so many leaves together, without rounding.
  static std::size_t bytes(std::size_t trees, std::size_t leaves, std::size_t samples_per_leaf);

 private:
  template <typename... Arguments>
  void launch(const char* kernel, std::size_t items_per_chunk, const Arguments&... arguments) const;
  void sort_chunks(const host::Buffer<cl_double2>& samples, const host::Buffer<cl_int>& order) const;

  host::Runtime& runtime_;
  std::size_t samples_ = 0, nodes_ = 0, chunks_ = 0;
  int levels_above_chunks_ = 0;
  host::Buffer<SampledTree> trees_{};
  host::Buffer<cl_int> first_chunks_{};
};

}  // namespace flaunay::hybrid
