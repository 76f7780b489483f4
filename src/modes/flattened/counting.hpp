// Counts of operations (Options::count): kernels count them per level, and the host adds up the critical
// path.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/magnitudes.hpp"
#include "host/runtime.hpp"
#include "statistics/costs.hpp"
#include "statistics/counter.hpp"

namespace flaunay::flattened {

/// Makes the runtime's kernels count until it is destroyed. See docs/counting.md.
class Counting {
 public:
  Counting(host::Runtime& runtime, host::Arena& arena, statistics::Work& work);
  ~Counting();
  Counting(const Counting&) = delete;
  Counting& operator=(const Counting&) = delete;

  /// Adds operations to the critical path of the step that is counted now.
  void add_depth(statistics::Component component, std::uint64_t operations);

  /// Adds a sort of sets of points by one coordinate, counted as comparisons_to_sort.
  void add_sort(const std::vector<std::size_t>& offsets);

  /// Adds the counts since the last call to a level; level -1 is the work before the first cut. If the
  /// regions of a level are cut one by one, its critical path is the longest of theirs. Waits once.
  void end_step(int level);

  /// Reads how many regions of each size the end game triangulated.
  void finish();

 private:
  host::Runtime& runtime_;
  statistics::Work& work_;
  host::Buffer<cl_uint> counters_;
  std::uint64_t depth_[statistics::kComponents] = {};
  std::uint64_t sort_comparisons_ = 0;
};

}  // namespace flaunay::flattened
