// Counting of work, by the rules of docs/counting.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "counting/costs.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::recursive {

using namespace counting;

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
  void add(const OperationCounts& counts) { counts_ += counts; }
  /// All that has been counted was done one after the other.
  void sequential() { counts_.critical_path = counts_.operations(); }

  const OperationCounts& counts() const { return counts_; }

 private:
  OperationCounts counts_;
};

/// All of a work's components and levels, one after the other.
inline OperationCounts sum_of(const Work& work) {
  OperationCounts sum;
  const auto add = [&sum](const Work::Components& components) {
    for (const OperationCounts& counts : components) sum += counts;
  };
  add(work.start);
  for (const Work::Components& level : work.levels) add(level);
  return sum;
}

/// Adds the work of a region to that of its level, whose regions are worked on side by side.
inline void add_beside(OperationCounts& level, const OperationCounts& region) {
  const std::uint64_t dearest = std::max(level.critical_path, region.critical_path);
  level += region;
  level.critical_path = dearest;
}

}  // namespace flaunay::recursive
