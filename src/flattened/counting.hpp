// Options::count: what the kernels count, by level, and the critical path, which the host knows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "counting/costs.hpp"
#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"

namespace flaunay::flattened {

using namespace counting;

/// While it lives, the runtime's kernels count. See docs/counting.md.
class Counting {
 public:
  Counting(host::Runtime& runtime, host::Arena& arena, Work& work);
  ~Counting();
  Counting(const Counting&) = delete;
  Counting& operator=(const Counting&) = delete;

  /// Lengthens the critical path of what is counted now.
  void add_depth(Component component, std::uint64_t operations);

  /// A sort of sets of points by one coordinate, which comparisons stand in for: comparisons_to_sort.
  void add_sort(const std::vector<std::size_t>& offsets);

  /// Adds what was counted since the last call to a level; -1 is what precedes the first. Of several regions
  /// that are cut one by one the dearest makes the level's critical path. One host wait.
  void end_step(int level);

  /// The end game's regions by their number of corners.
  void finish();

 private:
  host::Runtime& runtime_;
  Work& work_;
  host::Buffer<cl_uint> counters_;
  std::uint64_t depth_[kComponents] = {};
  std::uint64_t sort_comparisons_ = 0;
};

}  // namespace flaunay::flattened
