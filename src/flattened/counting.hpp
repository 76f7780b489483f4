// Options::count: what the kernels count, by level, and the critical path, which the host knows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"

namespace flaunay::flattened {

/// Operations of one evaluation; as in kernels/shared/counting.h.
constexpr std::uint64_t kProjectOperations = 2;
constexpr std::uint64_t kDepthOperations = 12;
constexpr std::uint64_t kOrientOperations = 8;

/// The ceiling of log2 m: the depth of a reduction of m elements.
std::uint64_t log2_ceiling(std::size_t m);
/// Of a scan, a pack or a stable split of m elements.
inline std::uint64_t scan_depth(std::size_t m) { return 2 * log2_ceiling(m); }

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
