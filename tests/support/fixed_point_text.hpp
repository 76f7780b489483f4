// A reading of the shared headers in fixed point. A file that includes this has
// nothing else, and defines SHARED_NAMESPACE.
#pragma GCC diagnostic ignored "-Wunused-parameter"  // scalings, which integers have not
#define FIXED_POINT
#include "arithmetic/bit_account.h"
#include "blocks/certify.h"
#include "blocks/seams.h"
#include "predicates/planar.h"
#include "tests/support/fixed_point.hpp"

namespace SHARED_NAMESPACE {

using testing::FilteredValue;
using testing::FixedFrame;
using testing::FixedHeight;
using testing::FixedPredicates;

inline coordinate2 at(const std::int64_t* p, int k) { return {p[2 * k], p[2 * k + 1]}; }

inline int side_of_angle(const std::int64_t* p) {
  return angle_side(angle_at(at(p, 2), at(p, 0), at(p, 1)), ORIENT_BOUND);
}
inline angle angle_from(const std::int64_t* p, int k) { return angle_at(at(p, k), at(p, 0), at(p, 1)); }

// In integers, UNIT is 1.
inline FilteredValue in_integers(real value, real magnitude, int factors) {
  return {std::ldexp(double{value}, 33 * factors), std::ldexp(double{magnitude}, 33 * factors)};
}

inline FilteredValue orient_value(const std::int64_t* p) {
  const real2 ca = difference2(at(p, 0), at(p, 2)), cb = difference2(at(p, 1), at(p, 2));
  const real left = ca.x * cb.y, right = ca.y * cb.x;
  return in_integers(left - right, fabs(left) + fabs(right), 2);
}

inline FilteredValue circle_value(const std::int64_t* p) {
  const real2 ad = difference2(at(p, 0), at(p, 3)), bd = difference2(at(p, 1), at(p, 3));
  const real2 cd = difference2(at(p, 2), at(p, 3));
  const real2 det =
      circle_determinant(ad, bd, cd, squared_length(ad), squared_length(bd), squared_length(cd));
  return in_integers(det.x, det.y, 4);
}

inline FilteredValue angle_value(const std::int64_t* p) {
  const angle seen = angle_from(p, 3), other = angle_from(p, 2);
  const real_pair products = other.products * swapped(seen.products);
  const real_pair terms = other.magnitudes * swapped(seen.magnitudes);
  return in_integers(low(products) - high(products), low(terms) + high(terms), 4);
}

inline block_frame frame_of(const FixedFrame& f) {
  block_frame frame{};
  frame.rectangle = {{f.low[0], f.low[1]}, {f.high[0], f.high[1]}};
  frame.all = {{f.all_low[0], f.all_low[1]}, {f.all_high[0], f.all_high[1]}};
  return frame;
}

inline FixedHeight height_of_line(const std::int64_t* p, int axis) {
  const seam_line line = {axis, at(p, 0), 0, 0};
  const real largest = std::fmax(fabs(height_of(at(p, 1), &line)), fabs(height_of(at(p, 2), &line)));
  return {std::ldexp(double{height_at_cut(&line, at(p, 1), at(p, 2))}, 33), std::ldexp(double{largest}, 33),
          HEIGHT_ERROR};
}

inline FixedPredicates reading_named(const char* name) {
  FixedPredicates reading{};
  reading.name = name;
  reading.real_of = [](std::int64_t d) { return real_of(d); };
  reading.rounded_difference = [](std::int64_t a, std::int64_t b) {
    return std::int64_t{rounded_difference(a, b)};
  };
  reading.orient_filtered = [](const std::int64_t* p) {
    return orient_filtered(at(p, 0), at(p, 1), at(p, 2), ORIENT_BOUND);
  };
  reading.orient_exact = [](const std::int64_t* p) { return orient_exact(at(p, 0), at(p, 1), at(p, 2)); };
  reading.cross_sign = [](const std::int64_t* p) {
    return cross_sign(at(p, 0), at(p, 1), at(p, 2), at(p, 3));
  };
  reading.circle_filtered = [](const std::int64_t* p) {
    return circle_filtered(at(p, 0), at(p, 1), at(p, 2), at(p, 3), CIRCLE_BOUND);
  };
  reading.circle_exact = [](const std::int64_t* p) {
    return circle_exact(at(p, 0), at(p, 1), at(p, 2), at(p, 3));
  };
  reading.circle_undecided = [](const std::int64_t* p) {
    return circle_undecided(at(p, 0), at(p, 1), at(p, 2), at(p, 3), ANGLE_BOUND);
  };
  reading.circle_canonical = [](const std::int64_t* p) {
    return circle_canonical(at(p, 0), at(p, 1), at(p, 2), at(p, 3), CIRCLE_BOUND);
  };
  reading.angle_compared = [](const std::int64_t* p) {
    return angle_compared(angle_from(p, 3), angle_from(p, 2), ANGLE_BOUND);
  };
  reading.angle_side = side_of_angle;
  reading.orient_value = orient_value;
  reading.circle_value = circle_value;
  reading.angle_value = angle_value;
  reading.orient_bound = ORIENT_BOUND;
  reading.circle_bound = CIRCLE_BOUND;
  reading.angle_bound = ANGLE_BOUND;
  reading.roundoff = ROUNDOFF;
  reading.is_circle_inside = [](const FixedFrame& f, const std::int64_t* p) {
    const block_frame frame = frame_of(f);
    return is_circle_inside(&frame, at(p, 0), at(p, 1), at(p, 2)) != 0;
  };
  reading.is_half_plane_inside = [](const FixedFrame& f, const std::int64_t* p) {
    const block_frame frame = frame_of(f);
    return is_half_plane_inside(&frame, at(p, 0), at(p, 1)) != 0;
  };
  reading.height_at_cut = height_of_line;
  reading.fixed_point = [](std::uint64_t bits, int shift) { return std::int64_t{fixed_point(bits, shift)}; };
  reading.widened_bits = [](std::uint32_t bits) { return std::uint64_t{widened_bits(bits)}; };
  return reading;
}

}  // namespace SHARED_NAMESPACE
