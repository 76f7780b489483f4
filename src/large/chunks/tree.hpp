// Trees of cuts between chunks, made from samples of the points on the host (kernels/points/cut_tree.h).
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "arithmetic/records.h"
#include "points/records.h"

namespace flaunay::chunks {

/// Where nodes are cut: the first round at medians; later ones in gaps, because their points lie along the
/// cuts of the round before.
enum class Cuts { at_medians, in_gaps };

/// A tree whose leaves are chunks. Equal points have the same leaf.
class ChunkTree {
 public:
  /// A single leaf.
  ChunkTree() = default;
  /// This many leaves, at least 1, which have about as many samples each unless points are equal. O(s log s)
  /// for s samples.
  static ChunkTree of_leaves(std::vector<kernel::double2> samples, std::size_t leaves, Cuts cuts);
  /// The tree with these nodes(), made elsewhere.
  ChunkTree(std::size_t leaves, std::vector<kernel::cut_node> nodes);

  /// Four leaves: the one with this number has the points that are equal to p, and no others.
  static ChunkTree around(kernel::double2 p);
  static constexpr std::size_t kEqualLeaf = 2;

  std::size_t leaves() const { return leaves_; }
  const std::vector<kernel::cut_node>& nodes() const { return nodes_; }
  /// The leaf of each of `count` points. O(count * depth).
  void find_leaves(const double* coordinates, std::size_t count, std::size_t* leaves) const;
  /// The part of a rectangle that belongs to a leaf. Its sides are cuts, so points may lie on them.
  kernel::vertex_box rectangle(std::size_t leaf, kernel::vertex_box whole) const;

 private:
  using Sample = std::vector<kernel::double2>::iterator;
  void number(std::size_t node, std::size_t first, std::size_t count);
  void cut(std::size_t node, std::size_t leaves, Sample begin, Sample end, Cuts cuts, double per_leaf);

  std::size_t leaves_ = 1;
  int depth_ = 0;
  std::vector<kernel::cut_node> nodes_;  // in the order of a heap, from 1 on
  // The numbers of the heap's leaves, if they are more than this tree's. Nodes that have one leaf only then
  // have a cut that all points are below.
  std::vector<std::size_t> numbers_;
};

/// The rectangle that is the whole plane.
kernel::vertex_box whole_plane();

}  // namespace flaunay::chunks
