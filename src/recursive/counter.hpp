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

/// Comparisons of a binary search among m elements, whatever is found.
inline std::uint64_t search_comparisons(std::size_t m) { return reduce_depth(m); }

/// What the stages of the hull and of the border merge take; tests/counting_test.cpp holds them to the code.
constexpr std::uint64_t kProjectOperations = 2;
constexpr std::uint64_t kDepthOperations = 12;
constexpr std::uint64_t kOrientOperations = 8;
/// To say which of two points of equal u is the lower one.
constexpr std::uint64_t kLowerOperations = 4;
/// The dot product that goes with an orientation, and the comparison of two angles.
constexpr std::uint64_t kDotOperations = 3;
constexpr std::uint64_t kAngleOperations = 4;

/// The work of one component on one region.
class Counter {
 public:
  void arithmetic(std::uint64_t operations = 1) { counts_.arithmetic += operations; }
  void depth() { ++counts_.depths; }
  void orientation() { ++counts_.orientations; }
  void circle() { ++counts_.circles; }
  /// A stage that takes so many operations one after the other.
  void critical_path(std::uint64_t operations) { counts_.critical_path += operations; }
  /// What was done after what has been counted.
  void add(const OperationCounts& counts) {
    counts_.arithmetic += counts.arithmetic;
    counts_.depths += counts.depths;
    counts_.orientations += counts.orientations;
    counts_.circles += counts.circles;
    counts_.critical_path += counts.critical_path;
  }
  /// All that has been counted was done one after the other.
  void sequential() { counts_.critical_path = counts_.operations(); }

  const OperationCounts& counts() const { return counts_; }

 private:
  OperationCounts counts_;
};

/// All of a work's components and levels, one after the other.
inline OperationCounts sum_of(const Work& work) {
  Counter sum;
  const auto add = [&sum](const Work::Components& components) {
    for (const OperationCounts& counts : components) sum.add(counts);
  };
  add(work.start);
  for (const Work::Components& level : work.levels) add(level);
  return sum.counts();
}

/// Adds the work of a region to that of its level, whose regions are worked on side by side.
inline void add_beside(OperationCounts& level, const OperationCounts& region) {
  level.arithmetic += region.arithmetic;
  level.depths += region.depths;
  level.orientations += region.orientations;
  level.circles += region.circles;
  level.critical_path = std::max(level.critical_path, region.critical_path);
}

}  // namespace flaunay::recursive
