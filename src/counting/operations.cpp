#include "counting/costs.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay {

using namespace counting;

namespace {

// With the sum of magnitudes, its product with the bound, and a second comparison.
constexpr std::uint64_t kDepthWithBound = kDepthOperations + 5;
constexpr std::uint64_t kOrientationWithBound = kOrientOperations + 3;
constexpr std::uint64_t kCircleWithBound = kCircleOperations + 10;

}  // namespace

OperationCounts& OperationCounts::operator+=(const OperationCounts& other) noexcept {
  arithmetic += other.arithmetic;
  depths += other.depths;
  orientations += other.orientations;
  circles += other.circles;
  critical_path += other.critical_path;
  return *this;
}

std::uint64_t OperationCounts::operations() const noexcept {
  return arithmetic + kDepthOperations * depths + kOrientOperations * orientations +
         kCircleOperations * circles;
}

std::uint64_t OperationCounts::operations_with_bounds() const noexcept {
  return arithmetic + kDepthWithBound * depths + kOrientationWithBound * orientations +
         kCircleWithBound * circles;
}

}  // namespace flaunay
