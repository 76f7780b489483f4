// Cut trees as kernels/cut_tree.cl makes them, sequentially.
#pragma once

#include <CL/cl.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/sort.hpp"
#include "points/cut_tree.hpp"

namespace flaunay::testing {

struct CutTree {
  int depth = 0;
  std::vector<kernel::cut_node> nodes;
};

namespace cut_tree_detail {

using Iterator = std::vector<cl_double2>::iterator;

inline bool precedes(const cl_double2& p, const cl_double2& q, int axis) {
  if (p.s[axis] != q.s[axis]) return p.s[axis] < q.s[axis];
  return axis == 0 ? p.s[1] < q.s[1] : p.s[0] > q.s[0];
}

inline kernel::cut_node node_of(const cl_double2& pivot, int axis) {
  // Adding 0 turns -0 into 0.
  const cl_ulong x = geometry::sort_key(pivot.s[0] + 0.0), y = geometry::sort_key(pivot.s[1] + 0.0);
  return axis == 0 ? kernel::cut_node{x, y, 0} : kernel::cut_node{y, ~x, ~cl_ulong{0}};
}

inline double interquartile_range(Iterator begin, Iterator end, int axis) {
  std::sort(begin, end, [axis](const auto& p, const auto& q) { return p.s[axis] < q.s[axis]; });
  const auto quarter = (end - begin) / 4;
  return (end - 1 - quarter)->s[axis] - begin[quarter].s[axis];
}

inline void cut(CutTree& tree, std::size_t node, Iterator begin, Iterator end) {
  const int axis = interquartile_range(begin, end, 1) > interquartile_range(begin, end, 0) ? 1 : 0;
  const auto middle = begin + (end - begin) / 2;
  std::sort(begin, end, [axis](const auto& p, const auto& q) { return precedes(p, q, axis); });
  tree.nodes[node] = node_of(*middle, axis);
  if (2 * node >= tree.nodes.size()) return;
  cut(tree, 2 * node, begin, middle);
  cut(tree, 2 * node + 1, middle, end);
}

inline std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
  x = (x ^ x >> 27) * 0x94d049bb133111eb;
  return x ^ x >> 31;
}

}  // namespace cut_tree_detail

/// Indices below n of so many samples.
inline std::vector<cl_int> spread_indices(std::size_t n, std::size_t count) {
  std::vector<cl_int> indices(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = k * n / count, end = (k + 1) * n / count;
    indices[k] =
        static_cast<cl_int>(begin + cut_tree_detail::mixed(k) % std::max<std::size_t>(1, end - begin));
  }
  return indices;
}

/// As the tuning table has it.
constexpr std::size_t kSamplesPerBlock = 16;

/// Of a tree whose leaves are blocks.
inline std::size_t samples_for(int depth) { return kSamplesPerBlock << depth; }
inline std::vector<cl_int> sample_indices(std::size_t n, int depth) {
  return spread_indices(n, samples_for(depth));
}

/// samples: brought to the order of the leaves.
inline CutTree cut_tree(std::vector<cl_double2>& samples, int depth) {
  CutTree tree;
  tree.depth = depth;
  tree.nodes.resize(std::size_t{1} << depth);
  if (depth > 0) cut_tree_detail::cut(tree, 1, samples.begin(), samples.end());
  return tree;
}

}  // namespace flaunay::testing
