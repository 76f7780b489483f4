// Twins of the cut trees and of the stage `distribute`: points in blocks, and how blocks are to be merged.
#pragma once

#include <CL/cl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "points/distribute.hpp"

namespace flaunay::testing {

/// The orders that points are sorted and cut by: (x, y), and (y, -x) for axis 1.
inline bool comes_first(const cl_double2& p, const cl_double2& q, int axis) {
  if (p.s[axis] != q.s[axis]) return p.s[axis] < q.s[axis];
  return axis == 0 ? p.s[1] < q.s[1] : q.s[0] < p.s[0];
}

/// In the order of a heap, as the nodes of points::CutTrees.
struct TreeTwin {
  struct Node {
    cl_double2 pivot;
    int axis;
  };
  int depth = 0;
  std::vector<Node> nodes;
  std::vector<std::vector<cl_double2>> leaves;  ///< the samples of each

  int leaf(const cl_double2& p) const {
    int node = 1;
    for (int d = 0; d < depth; ++d) {
      const Node& cut = nodes[static_cast<std::size_t>(node)];
      node = 2 * node + (comes_first(p, cut.pivot, cut.axis) ? 0 : 1);
    }
    return node - (1 << depth);
  }
};

inline double interquartile_range(const std::vector<cl_double2>& points, int axis) {
  std::vector<double> sorted;
  for (const cl_double2& p : points) sorted.push_back(p.s[axis]);
  std::sort(sorted.begin(), sorted.end());
  return sorted[sorted.size() - 1 - sorted.size() / 4] - sorted[sorted.size() / 4];
}

inline TreeTwin tree_twin(const std::vector<cl_double2>& samples, int depth) {
  TreeTwin tree;
  tree.depth = depth;
  tree.nodes.resize(std::size_t{1} << depth);
  std::vector<std::vector<cl_double2>> parts(2 * tree.nodes.size());
  parts[1] = samples;
  for (std::size_t k = 1; k < tree.nodes.size(); ++k) {
    std::vector<cl_double2>& part = parts[k];
    const int axis = interquartile_range(part, 1) > interquartile_range(part, 0);
    std::sort(part.begin(), part.end(),
              [axis](const auto& p, const auto& q) { return comes_first(p, q, axis); });
    const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
    tree.nodes[k] = {*middle, axis};
    parts[2 * k].assign(part.begin(), middle);
    parts[2 * k + 1].assign(middle, part.end());
  }
  tree.leaves.assign(parts.begin() + static_cast<std::ptrdiff_t>(tree.nodes.size()), parts.end());
  return tree;
}

/// The number whose place in the order of doubles this is.
inline double from_orderable(cl_ulong key) {
  const cl_ulong sign = cl_ulong{1} << 63;
  const cl_ulong bits = key & sign ? key ^ sign : ~key;
  double value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// A kernel::cut_node as its twin has it.
inline TreeTwin::Node decoded(const kernel::cut_node& node) {
  if (node.turn == 0) return {{{from_orderable(node.major), from_orderable(node.minor)}}, 0};
  if (node.turn != ~cl_ulong{0}) throw std::logic_error("a node that turns halfway");
  return {{{from_orderable(~node.minor), from_orderable(node.major)}}, 1};
}

/// samples_of(set, depth): the indices, in the set, of the points that its tree is made from.
struct BlocksTwin {
  std::vector<cl_int> set_blocks{0}, offsets{0};
  std::vector<TreeTwin> trees;  ///< by set
  std::vector<cl_double2> vertices;
  std::vector<cl_int> source;

  template <typename SamplesOf>
  BlocksTwin(const std::vector<double>& coordinates, const std::vector<std::size_t>& set_offsets,
             std::size_t block_points, int shift, const SamplesOf& samples_of) {
    const auto point = [&](std::size_t i) {
      return cl_double2{{coordinates[2 * i], coordinates[2 * i + 1]}};
    };
    for (std::size_t s = 0; s + 1 < set_offsets.size(); ++s) {
      const std::size_t first = set_offsets[s], size = set_offsets[s + 1] - first;
      int depth = 0;
      for (std::size_t room = block_points; room < size; room *= 2) ++depth;
      std::vector<cl_double2> samples;
      if (depth > 0) {
        for (const cl_int i : samples_of(size, depth))
          samples.push_back(point(first + static_cast<std::size_t>(i)));
      }
      trees.push_back(tree_twin(samples, depth));
      std::vector<std::vector<cl_int>> blocks(std::size_t{1} << depth);
      for (std::size_t i = first; i < first + size; ++i) {
        blocks[static_cast<std::size_t>(trees.back().leaf(point(i)))].push_back(static_cast<cl_int>(i));
      }
      for (const std::vector<cl_int>& block : blocks) {
        source.insert(source.end(), block.begin(), block.end());
        offsets.push_back(static_cast<cl_int>(source.size()));
      }
      set_blocks.push_back(static_cast<cl_int>(offsets.size() - 1));
    }
    for (const cl_int i : source) {
      const cl_double2 p = point(static_cast<std::size_t>(i));
      // Adding 0 makes +0 of -0.
      vertices.push_back({{std::ldexp(p.s[0], shift) + 0.0, std::ldexp(p.s[1], shift) + 0.0}});
    }
  }
};

/// What is wrong with the nodes of all sets' trees, one after the other, or "".
inline std::string broken_nodes(const std::vector<kernel::cut_node>& nodes,
                                const std::vector<TreeTwin>& trees) {
  std::size_t first = 0;
  for (std::size_t t = 0; t < trees.size(); ++t) {
    if (trees[t].depth == 0) continue;
    for (std::size_t k = 1; k < trees[t].nodes.size(); ++k) {
      if (first + k >= nodes.size()) return fmt::format("no node {} of tree {}", k, t);
      const TreeTwin::Node found = decoded(nodes[first + k]), &expected = trees[t].nodes[k];
      for (const std::size_t c : {0, 1}) {
        if (found.pivot.s[c] != expected.pivot.s[c] ||
            (found.pivot.s[c] == 0 && std::signbit(found.pivot.s[c])))
          return fmt::format("node {} of tree {} is elsewhere", k, t);
      }
      if (found.axis != expected.axis) return fmt::format("node {} of tree {} is along the wrong axis", k, t);
    }
    first += trees[t].nodes.size();
  }
  return first == nodes.size() ? "" : "nodes of no tree";
}

/// What is wrong with the list of merges, or "": level by level, they join each set's blocks, neighbours all
/// of them, by the nodes of its tree, which stand after those of the trees before. spans[b]: behind the last
/// block that b was joined with.
inline std::string broken_merges(const points::Blocks& blocks, const std::vector<TreeTwin>& trees,
                                 std::vector<cl_int>& spans) {
  // For each span its node in the set's tree; 0 if it is no span's first block.
  std::vector<int> node(blocks.count);
  std::vector<std::size_t> set(blocks.count);
  std::vector<int> first_node(blocks.sets + 1);
  for (std::size_t s = 0; s < blocks.sets; ++s) {
    first_node[s + 1] = first_node[s] + (trees[s].depth == 0 ? 0 : 1 << trees[s].depth);
    for (cl_int b = blocks.set_blocks[s]; b < blocks.set_blocks[s + 1]; ++b) {
      node[static_cast<std::size_t>(b)] = (1 << trees[s].depth) + b - blocks.set_blocks[s];
      set[static_cast<std::size_t>(b)] = s;
    }
  }
  spans.resize(blocks.count);
  std::iota(spans.begin(), spans.end(), 1);
  std::size_t m = 0;
  for (const std::size_t end : blocks.level_ends) {
    if (end < m || end > blocks.merges.size()) return "levels do not ascend";
    std::set<cl_int> touched;
    for (; m < end; ++m) {
      const kernel::block_merge& merge = blocks.merges[m];
      const auto low = static_cast<std::size_t>(merge.low), high = static_cast<std::size_t>(merge.high);
      if (low >= blocks.count || high >= blocks.count) return fmt::format("merge {} of no blocks", m);
      if (!touched.insert(merge.low).second || !touched.insert(merge.high).second) {
        return fmt::format("merge {} depends on another of its level", m);
      }
      if (node[low] == 0 || node[high] == 0) return fmt::format("merge {} of a block that is gone", m);
      if (spans[low] != merge.high || set[low] != set[high])
        return fmt::format("merge {} is not of neighbours", m);
      if (node[low] % 2 != 0 || node[high] != node[low] + 1)
        return fmt::format("merge {} is across a cut", m);
      node[low] /= 2;
      node[high] = 0;
      spans[low] = spans[high];
      if (merge.node != first_node[set[low]] + node[low]) return fmt::format("merge {} has another node", m);
    }
  }
  if (m != blocks.merges.size()) return "merges of no level";
  for (std::size_t s = 0; s < blocks.sets; ++s) {
    const auto first = static_cast<std::size_t>(blocks.set_blocks[s]);
    if (node[first] != 1) return fmt::format("set {} is left in parts", s);
  }
  return "";
}

}  // namespace flaunay::testing
