#include "blocks/certify.h"
#include "tests/support/fixed_point.hpp"

namespace flaunay::testing {
namespace {

// Infinite sides are those at COORDINATE_LARGEST.
double coordinate_of(std::int64_t x) {
  const std::int64_t largest = std::numeric_limits<std::int64_t>::max();
  return x == largest ? HUGE_VAL : x == -largest ? -HUGE_VAL : static_cast<double>(x);
}
kernel::double2 point_of(const std::int64_t* p) { return {coordinate_of(p[0]), coordinate_of(p[1])}; }

}  // namespace

bool is_circle_inside_in_doubles(const FixedFrame& f, const std::int64_t* p) {
  kernel::block_frame frame{};
  frame.rectangle = {point_of(f.low), point_of(f.high)};
  frame.all = {point_of(f.all_low), point_of(f.all_high)};
  return kernel::is_circle_inside(&frame, point_of(p), point_of(p + 2), point_of(p + 4)) != 0;
}

}  // namespace flaunay::testing
