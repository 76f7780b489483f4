#include "flaunay/flaunay.hpp"

namespace flaunay {
namespace {

// Operations of one evaluation, as kernels/shared/{hull_height,planar}.h write it: additions, multiplications
// and the comparison of the result with 0. tests/counting_test.cpp holds them to the code.
constexpr std::uint64_t kDepth = 12;
constexpr std::uint64_t kOrientation = 8;
constexpr std::uint64_t kCircle = 30;
// With the sum of magnitudes, its product with the bound, and a second comparison.
constexpr std::uint64_t kDepthWithBound = kDepth + 5;
constexpr std::uint64_t kOrientationWithBound = kOrientation + 3;
constexpr std::uint64_t kCircleWithBound = kCircle + 10;

}  // namespace

std::uint64_t OperationCounts::operations() const noexcept {
  return arithmetic + kDepth * depths + kOrientation * orientations + kCircle * circles;
}

std::uint64_t OperationCounts::operations_with_bounds() const noexcept {
  return arithmetic + kDepthWithBound * depths + kOrientationWithBound * orientations +
         kCircleWithBound * circles;
}

}  // namespace flaunay
