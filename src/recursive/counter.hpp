// Counting of work, by the rules of docs/counting.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "flaunay/flaunay.hpp"

namespace flaunay::recursive {

/// Steps of a reduction of m elements in the scan model.
inline std::uint64_t reduce_depth(std::size_t m) {
  std::uint64_t steps = 0;
  while ((std::size_t{1} << steps) < m) ++steps;
  return steps;
}

/// Steps of a scan of m elements, and of a pack or a stable split.
inline std::uint64_t scan_depth(std::size_t m) { return 2 * reduce_depth(m); }

/// The work of one component on one region.
class Counter {
 public:
  void arithmetic(std::uint64_t operations = 1) { counts_.arithmetic += operations; }
  void depth() { ++counts_.depths; }
  void orientation() { ++counts_.orientations; }
  void circle() { ++counts_.circles; }
  /// A stage that takes so many operations one after the other.
  void critical_path(std::uint64_t operations) { counts_.critical_path += operations; }
  /// All that has been counted was done one after the other.
  void sequential() { counts_.critical_path = counts_.operations(); }

  const OperationCounts& counts() const { return counts_; }

 private:
  OperationCounts counts_;
};

/// Adds the work of a region to that of its level, whose regions are worked on side by side.
inline void add_beside(OperationCounts& level, const OperationCounts& region) {
  level.arithmetic += region.arithmetic;
  level.depths += region.depths;
  level.orientations += region.orientations;
  level.circles += region.circles;
  level.critical_path = std::max(level.critical_path, region.critical_path);
}

}  // namespace flaunay::recursive
