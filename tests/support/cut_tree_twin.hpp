// The samples that cut trees are made from, and their nodes.
#pragma once

#include <CL/cl.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/sort.hpp"
#include "points/cut_tree.hpp"

namespace flaunay::testing {

inline kernel::cut_node node_of(const cl_double2& pivot, int axis) {
  // Adding 0 turns -0 into 0.
  const cl_ulong x = geometry::sort_key(pivot.s[0] + 0.0), y = geometry::sort_key(pivot.s[1] + 0.0);
  return axis == 0 ? kernel::cut_node{x, y, 0} : kernel::cut_node{y, ~x, ~cl_ulong{0}};
}

inline std::uint64_t mixed_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
  x = (x ^ x >> 27) * 0x94d049bb133111eb;
  return x ^ x >> 31;
}

/// Indices below n of so many samples.
inline std::vector<cl_int> spread_indices(std::size_t n, std::size_t count) {
  std::vector<cl_int> indices(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t begin = k * n / count, end = (k + 1) * n / count;
    indices[k] = static_cast<cl_int>(begin + mixed_bits(k) % std::max<std::size_t>(1, end - begin));
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

}  // namespace flaunay::testing
