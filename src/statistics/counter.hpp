// Counting of work, by the rules of docs/counting.md.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "flaunay/research.hpp"
#include "statistics/costs.hpp"

namespace flaunay::statistics {

using research::Component;
using research::Cut;
using research::Hull;
using research::kComponents;
using research::LevelStatistics;
using research::OperationCounts;
using research::Work;

/// The work of one component on one region.
class Counter {
 public:
  void arithmetic(std::uint64_t operations = 1) { counts_.arithmetic += operations; }
  void depth() { ++counts_.depths; }
  void orientation() { ++counts_.orientations; }
  void circle() { ++counts_.circles; }
  /// Counts a stage whose critical path has this many operations.
  void critical_path(std::uint64_t operations) { counts_.critical_path += operations; }
  /// Adds work that was done after the work counted so far.
  void add(const OperationCounts& counts) { counts_ += counts; }
  /// States that all operations counted so far were done one after the other.
  void sequential() { counts_.critical_path = counts_.operations(); }

  const OperationCounts& counts() const { return counts_; }

 private:
  OperationCounts counts_;
};

inline OperationCounts& part_of(Work::Components& components, Component component) {
  return components[static_cast<std::size_t>(component)];
}

/// The sum over all components and levels, which are done one after the other.
inline OperationCounts sum_of(const Work& work) {
  OperationCounts sum;
  const auto add = [&sum](const Work::Components& components) {
    for (const OperationCounts& counts : components) sum += counts;
  };
  add(work.start);
  for (const Work::Components& level : work.levels) add(level);
  return sum;
}

/// Adds the work of a region to that of its level, whose regions are independent of each other.
inline void add_beside(OperationCounts& level, const OperationCounts& region) {
  const std::uint64_t dearest = std::max(level.critical_path, region.critical_path);
  level += region;
  level.critical_path = dearest;
}

/// Adds the work for a part of a level's regions to the level. The level's rounds are the most of any part.
inline void add_part(LevelStatistics& level, const LevelStatistics& part) {
  level.regions += part.regions;
  level.internal_points += part.internal_points;
  level.corners += part.corners;
  level.candidates += part.candidates;
  level.survivors += part.survivors;
  level.path_vertices += part.path_vertices;
  level.candidate_rounds = std::max(level.candidate_rounds, part.candidate_rounds);
  level.hull_rounds = std::max(level.hull_rounds, part.hull_rounds);
  level.seconds += part.seconds;
}

}  // namespace flaunay::statistics
