#include "flaunay/research.hpp"
#include "statistics/costs.hpp"

namespace flaunay::research {

using namespace statistics;

namespace {

// Predicates with their error bounds: the sum of magnitudes, its product with the bound, a second comparison.
constexpr std::uint64_t kDepthWithBound = kernel::DEPTH_OPERATIONS + 5;
constexpr std::uint64_t kOrientationWithBound = kernel::ORIENT_OPERATIONS + 3;
constexpr std::uint64_t kCircleWithBound = kernel::CIRCLE_OPERATIONS + 10;

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
  return arithmetic + kernel::DEPTH_OPERATIONS * depths + kernel::ORIENT_OPERATIONS * orientations +
         kernel::CIRCLE_OPERATIONS * circles;
}

std::uint64_t OperationCounts::operations_with_bounds() const noexcept {
  return arithmetic + kDepthWithBound * depths + kOrientationWithBound * orientations +
         kCircleWithBound * circles;
}

}  // namespace flaunay::research
