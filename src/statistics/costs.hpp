// Costs of operations by the rules of docs/counting.md: the costs of predicates, from
// kernels/operations/costs.h, and steps in the scan model.
#pragma once

#include <cstddef>
#include <cstdint>

#include "operations/costs.h"

namespace flaunay::statistics {

/// The ceiling of log2 m, 0 for m < 2. A reduction of m elements takes this many steps in the scan model.
inline std::uint64_t log2_ceiling(std::size_t m) {
  std::uint64_t log = 0;
  while ((std::size_t{1} << log) < m) ++log;
  return log;
}

/// Steps of a scan of m elements, and of a pack or a stable split.
inline std::uint64_t scan_depth(std::size_t m) { return 2 * log2_ceiling(m); }

/// Comparisons of a binary search among m elements, in every case.
inline std::uint64_t search_comparisons(std::size_t m) { return log2_ceiling(m); }

}  // namespace flaunay::statistics
