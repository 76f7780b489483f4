#include "recursive/predicates.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace flaunay::recursive {
namespace {

__extension__ using Wide = __int128;

constexpr int kMantissaBits = 52;
constexpr int kExponentBias = 1023;
// Coordinates that span so many binary places are integers of one unit, differences and all.
constexpr int kSpanMost = 120;
// Differences below 2^61: an orientation is below 2^123, and so are both factors of each term of an in-circle
// determinant.
constexpr Wide kDifferenceMost = Wide{1} << 61;
// The limbs of such factors.
constexpr int kLimbBits = 62;
constexpr Wide kLimbMask = (Wide{1} << kLimbBits) - 1;

struct Decoded {
  std::int64_t odd = 0;  // or 0
  int exponent = 0;
  int end = 0;  // the highest bit's, plus 1
};

// x: 0 or normal, as all coordinates in the range of docs/exactness.md.
Decoded decode(double x) {
  if (x == 0) return {};
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  const std::uint64_t one = std::uint64_t{1} << kMantissaBits;
  const std::uint64_t mantissa = (bits & (one - 1)) | one;
  const int zeros = __builtin_ctzll(mantissa);
  const int top = static_cast<int>(bits >> kMantissaBits & 0x7ff) - kExponentBias;
  const auto odd = static_cast<std::int64_t>(mantissa >> zeros);
  return {bits >> 63 ? -odd : odd, top - kMantissaBits + zeros, top + 1};
}

// Differences of points to another one, x and y in turn, as integers of one unit. False if there are too many
// bits for that.
template <std::size_t kCount>
bool integer_differences(const std::array<Point, kCount>& points, Point origin,
                         std::array<Wide, 2 * kCount>& differences) {
  std::array<Decoded, 2 * kCount + 2> decoded;
  decoded[0] = decode(origin.x);
  decoded[1] = decode(origin.y);
  for (std::size_t k = 0; k < kCount; ++k) {
    decoded[2 * k + 2] = decode(points[k].x);
    decoded[2 * k + 3] = decode(points[k].y);
  }
  int lowest = 2 * kExponentBias, end = -2 * kExponentBias;
  for (const Decoded& number : decoded) {
    if (number.odd == 0) continue;
    lowest = std::min(lowest, number.exponent);
    end = std::max(end, number.end);
  }
  if (end - lowest > kSpanMost) return false;
  const auto integer = [lowest](const Decoded& number) {
    return number.odd == 0 ? Wide{0} : Wide{number.odd} * (Wide{1} << (number.exponent - lowest));
  };
  for (std::size_t k = 0; k < 2 * kCount; ++k) {
    differences[k] = integer(decoded[k + 2]) - integer(decoded[k % 2]);
    if (differences[k] >= kDifferenceMost || differences[k] <= -kDifferenceMost) return false;
  }
  return true;
}

int sign_of(Wide x) { return (x > 0) - (x < 0); }

// The sum of up to three products of numbers below 2^124.
class ProductSum {
 public:
  // lift >= 0.
  void add(Wide lift, Wide minor) {
    const int sign = sign_of(minor);
    const Wide size = sign < 0 ? -minor : minor;
    const Wide low = lift & kLimbMask, high = lift >> kLimbBits;
    const Wide other_low = size & kLimbMask, other_high = size >> kLimbBits;
    limbs_[0] += sign * (low * other_low);
    limbs_[1] += sign * (low * other_high + high * other_low);
    limbs_[2] += sign * (high * other_high);
  }
  int sign() const {
    const Wide middle = limbs_[1] + (limbs_[0] >> kLimbBits);  // rounds down
    const Wide high = limbs_[2] + (middle >> kLimbBits);
    if (high != 0) return sign_of(high);
    return (middle & kLimbMask) != 0 || (limbs_[0] & kLimbMask) != 0;
  }

 private:
  Wide limbs_[3] = {0, 0, 0};
};

}  // namespace

int exact_orient(Point a, Point b, Point c) {
  std::array<Wide, 4> differences;
  if (!integer_differences<2>({a, b}, c, differences)) return kernel::orient_exact(a, b, c);
  const auto [ax, ay, bx, by] = differences;
  return sign_of(ax * by - ay * bx);
}

int exact_circle(Point a, Point b, Point c, Point d) {
  std::array<Wide, 6> differences;
  if (!integer_differences<3>({a, b, c}, d, differences)) return kernel::circle_exact(a, b, c, d);
  const auto [ax, ay, bx, by, cx, cy] = differences;
  ProductSum sum;
  sum.add(ax * ax + ay * ay, bx * cy - by * cx);
  sum.add(bx * bx + by * by, cx * ay - cy * ax);
  sum.add(cx * cx + cy * cy, ax * by - ay * bx);
  return sum.sign();
}

}  // namespace flaunay::recursive
