// What operations cost by the rules of docs/counting.md, for the kernels' host side and for the twin alike.
#pragma once

#include <cstddef>
#include <cstdint>

namespace flaunay::counting {

/// The ceiling of log2 m, 0 for m < 2: steps of a reduction of m elements in the scan model.
inline std::uint64_t log2_ceiling(std::size_t m) {
  std::uint64_t log = 0;
  while ((std::size_t{1} << log) < m) ++log;
  return log;
}

/// Steps of a scan of m elements, and of a pack or a stable split.
inline std::uint64_t scan_depth(std::size_t m) { return 2 * log2_ceiling(m); }

/// Comparisons of a binary search among m elements, whatever is found.
inline std::uint64_t search_comparisons(std::size_t m) { return log2_ceiling(m); }

/// One evaluation, as kernels/shared writes it: additions, multiplications, and the comparison of the result
/// with 0; as in kernels/shared/counting.h. tests/counting_test.cpp holds them to the code.
constexpr std::uint64_t kProjectOperations = 2;
constexpr std::uint64_t kDepthOperations = 12;
constexpr std::uint64_t kOrientOperations = 8;
constexpr std::uint64_t kCircleOperations = 30;
/// To say which of two points of equal u is the lower one.
constexpr std::uint64_t kLowerOperations = 4;
/// The dot product that goes with an orientation, and the comparison of two angles.
constexpr std::uint64_t kDotOperations = 3;
constexpr std::uint64_t kAngleOperations = 4;

}  // namespace flaunay::counting
