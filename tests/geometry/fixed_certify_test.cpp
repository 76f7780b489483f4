// Certificates of rounds (shared/certify.h) and heights along seams (shared/seams.h) in single precision:
// against rational numbers, and how many triangles have a certificate in double precision alone.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "flaunay/research.hpp"
#include "io/generate.hpp"
#include "tests/support/fixed_point.hpp"
#include "tests/support/rounding.hpp"

namespace flaunay::testing {
namespace {

using Integer = std::int64_t;
using Rational = mpq_class;

constexpr Integer kInfinite = std::numeric_limits<Integer>::max();
constexpr Integer kLargest = (Integer{1} << 62) - 1;

Rational rational(Integer x) { return Rational(static_cast<long>(x)); }

struct Box {
  Integer low[2], high[2];
};

/// The parts of the box around all points that lie on or beyond a side of the rectangle.
std::vector<Box> boxes_beyond(const FixedFrame& f) {
  std::vector<Box> beyond;
  for (int axis = 0; axis < 2; ++axis) {
    for (const bool is_high : {false, true}) {
      Box box{{f.all_low[0], f.all_low[1]}, {f.all_high[0], f.all_high[1]}};
      if (is_high) {
        box.low[axis] = f.high[axis];
      } else {
        box.high[axis] = f.low[axis];
      }
      if (box.low[axis] <= box.high[axis]) beyond.push_back(box);
    }
  }
  return beyond;
}

Rational distance(const Rational& x, Integer low, Integer high) {
  if (x < rational(low)) return rational(low) - x;
  if (x > rational(high)) return x - rational(high);
  return 0;
}

/// The circle through three points; false if there is none.
struct Circle {
  Rational x, y, radius_squared;
};
bool find_circle(const Integer* p, Circle& circle) {
  const Rational ax = rational(p[0]), ay = rational(p[1]);
  const Rational px = rational(p[2]) - ax, py = rational(p[3]) - ay, qx = rational(p[4]) - ax,
                 qy = rational(p[5]) - ay;
  const Rational doubled = 2 * (px * qy - py * qx);
  if (doubled == 0) return false;
  const Rational pp = px * px + py * py, qq = qx * qx + qy * qy;
  const Rational x = (qy * pp - py * qq) / doubled, y = (px * qq - qx * pp) / doubled;
  circle = {x + ax, y + ay, x * x + y * y};
  return true;
}

bool circle_is_free(const FixedFrame& frame, const Integer* p) {
  const auto beyond = boxes_beyond(frame);
  if (beyond.empty()) return true;
  Circle circle;
  if (!find_circle(p, circle)) return false;
  return std::all_of(beyond.begin(), beyond.end(), [&](const Box& box) {
    const Rational x = distance(circle.x, box.low[0], box.high[0]),
                   y = distance(circle.y, box.low[1], box.high[1]);
    return x * x + y * y > circle.radius_squared;
  });
}

/// Whether no place of another block is right of the line, and the segment is within the rectangle.
bool half_plane_is_free(const FixedFrame& f, const Integer* p) {
  for (int k = 0; k < 4; ++k) {
    if (!(f.low[k % 2] < p[k] && p[k] < f.high[k % 2])) return false;
  }
  for (const Box& box : boxes_beyond(f)) {
    for (const Integer x : {box.low[0], box.high[0]}) {
      for (const Integer y : {box.low[1], box.high[1]}) {
        const Rational cross = (rational(p[2]) - rational(p[0])) * (rational(y) - rational(p[1])) -
                               (rational(p[3]) - rational(p[1])) * (rational(x) - rational(p[0]));
        if (cross < 0) return false;
      }
    }
  }
  return true;
}

Integer limited(Integer x) { return std::clamp(x, -kLargest, kLargest); }
int between(std::mt19937_64& random, int low, int high) {
  return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
}
Integer number(std::mt19937_64& random, int bits) {
  const auto magnitude = static_cast<Integer>(random() & ((std::uint64_t{1} << bits) - 1));
  return (random() & 1) != 0 ? magnitude : -magnitude;
}

/// Three points: of some size, thin, on a grid, or nearly on a line.
void three_points(std::mt19937_64& random, Integer* p) {
  const int bits = between(random, 1, 59), kind = between(random, 0, 3);
  const Integer x = number(random, 59), y = number(random, 59);
  for (int k = 0; k < 3; ++k) {
    Integer across = number(random, bits), up = number(random, bits);
    if (kind == 1) up = number(random, std::max(0, bits - between(random, 1, 40)));
    if (kind == 2) across = across >> std::max(0, bits - 3) << std::max(0, bits - 3), up = number(random, 3);
    if (kind == 3) up = across / 4 + number(random, between(random, 0, bits));
    p[2 * k] = x + across;
    p[2 * k + 1] = y + up;
  }
}

/// A frame around points, of which each side is next to them, next to their circle, touches it or is
/// infinite.
FixedFrame frame_around(std::mt19937_64& random, const Integer* p) {
  FixedFrame frame{};
  Circle circle;
  const bool has_circle = find_circle(p, circle);
  const double radius = has_circle ? std::sqrt(circle.radius_squared.get_d()) : 0;
  for (int axis = 0; axis < 2; ++axis) {
    const auto [least, most] = std::minmax({p[axis], p[2 + axis], p[4 + axis]});
    const auto beyond = [&](Integer from, double sign) {
      const int kind = between(random, 0, 3);
      if (kind == 0) return sign > 0 ? kInfinite : -kInfinite;
      if (kind == 1 || !has_circle)
        return limited(from + static_cast<Integer>(sign) * std::abs(number(random, 60)));
      const double end = (axis == 0 ? circle.x : circle.y).get_d() + sign * radius;
      const double off =
          radius * std::ldexp(1 + static_cast<double>(random() & 1023) / 1024, -between(random, 0, 40));
      if (!(std::fabs(end) + off < 0x1p61)) return sign > 0 ? kInfinite : -kInfinite;
      const auto side =
          static_cast<Integer>(end + (kind == 2 ? off : -off / 4) * sign) + between(random, -2, 2);
      return sign > 0 ? std::max(side, from) : std::min(side, from);
    };
    frame.low[axis] = beyond(least, -1);
    frame.high[axis] = beyond(most, 1);
    const auto outer = [&](Integer side, Integer own, Integer sign) {
      const Integer end = std::abs(side) == kInfinite ? own : side;
      return random() % 4 == 0 ? end : limited(end + sign * std::abs(number(random, between(random, 0, 60))));
    };
    frame.all_low[axis] = outer(frame.low[axis], least, -1);
    frame.all_high[axis] = outer(frame.high[axis], most, 1);
  }
  return frame;
}

TEST(SmallFixedCertify, IsNeverWrong) {
  std::mt19937_64 random(1);
  std::size_t free_circles = 0, free_half_planes = 0, said_circles[3] = {}, said_half_planes[3] = {};
  const Device devices[] = {{"to nearest", FE_TONEAREST, false},
                            {"to nearest, flushes", FE_TONEAREST, true},
                            {"toward zero, flushes", FE_TOWARDZERO, true}};
  for (int trial = 0; trial < 60000; ++trial) {
    Integer p[6];
    three_points(random, p);
    const FixedFrame frame = frame_around(random, p);
    const bool circle = circle_is_free(frame, p), half_plane = half_plane_is_free(frame, p);
    free_circles += circle;
    free_half_planes += half_plane;
    std::size_t k = 0;
    for (const FixedPredicates* const reading : all_fixed_predicates()) {
      for (const Device& device : devices) {
        const Rounding rounding(device.direction, device.flushes);
        const bool says_circle = reading->is_circle_inside(frame, p);
        const bool says_half_plane = reading->is_half_plane_inside(frame, p);
        ASSERT_TRUE(circle || !says_circle) << reading->name << ", " << device.name << ", trial " << trial;
        ASSERT_TRUE(half_plane || !says_half_plane)
            << reading->name << ", " << device.name << ", trial " << trial;
        if (device.direction == FE_TONEAREST && !device.flushes) {
          said_circles[k] += says_circle;
          said_half_planes[k] += says_half_plane;
        }
      }
      ++k;
    }
  }
  for (std::size_t k = 0; k < 3; ++k) {
    std::printf("  circles %zu of %zu, half-planes %zu of %zu\n", said_circles[k], free_circles,
                said_half_planes[k], free_half_planes);
    // Many a side is next to a circle, nearer than a float can tell, and many a triangle is nearly a line.
    EXPECT_GT(10 * said_circles[k], 5 * free_circles);
    EXPECT_GT(10 * said_half_planes[k], 7 * free_half_planes);
  }
  EXPECT_GT(free_circles, 5000U);
  EXPECT_GT(free_half_planes, 1000U);
}

// Of coordinates at the ends of the range, circles are so large that numbers are infinite: then the answer is
// no.
TEST(SmallFixedCertify, OfTheLargestTriangles) {
  std::mt19937_64 random(2);
  int free = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    Integer p[6];
    for (Integer& x : p) {
      const Integer ends[] = {kLargest, -kLargest, 0, number(random, 62)};
      x = limited(ends[random() % 4] + between(random, -2, 2));
    }
    FixedFrame frame{
        {-kLargest, -kLargest}, {kLargest, kLargest}, {-kLargest, -kLargest}, {kLargest, kLargest}};
    if (trial % 2 == 0) frame.low[0] = -kInfinite;
    if (trial % 3 == 0) frame.high[1] = kInfinite;
    const bool is_free = circle_is_free(frame, p), is_free_half_plane = half_plane_is_free(frame, p);
    free += is_free;
    for (const FixedPredicates* const reading : all_fixed_predicates()) {
      ASSERT_TRUE(is_free || !reading->is_circle_inside(frame, p));
      ASSERT_TRUE(is_free_half_plane || !reading->is_half_plane_inside(frame, p));
    }
  }
  EXPECT_LT(free, 20000);
}

TEST(SmallFixedCertify, SidesAlongTheHullAreDecided) {
  // A border on an axis: no point is beyond the line, and some are on it.
  const FixedFrame frame{{-kInfinite, -kInfinite}, {1000, kInfinite}, {0, 0}, {5000, 5000}};
  const Integer along[] = {20, 0, 10, 0}, against[] = {10, 0, 20, 0};
  for (const FixedPredicates* const reading : all_fixed_predicates()) {
    EXPECT_FALSE(reading->is_half_plane_inside(frame, along));
    EXPECT_TRUE(reading->is_half_plane_inside(frame, against));
  }
}

// -----------------------------------------------------------------------------------------------------------
// How many triangles of blocks have a certificate

/// Points of a distribution in fixed point, with at most 53 bits.
std::vector<Integer> points_of(const std::string& distribution, std::size_t n) {
  const auto points = io::generate(distribution, n, 5).coordinates;
  double most = 0;
  for (const double x : points) most = std::max(most, std::fabs(x));
  std::vector<Integer> integers;
  for (const double x : points) {
    integers.push_back(static_cast<Integer>(std::nearbyint(std::ldexp(x, 52 - std::ilogb(most)))) * (1 << 9));
  }
  return integers;
}

struct Certificates {
  std::size_t triangles = 0, in_doubles = 0, in_floats = 0, free = 0;
};

/// Halves a part along its longer extent until it is a block, and asks for the certificates of its triangles.
void certify_blocks(const std::vector<Integer>& points, std::vector<std::size_t> part, FixedFrame frame,
                    std::size_t block, Certificates& found) {
  if (part.size() > block) {
    Integer extent[2];
    for (int axis = 0; axis < 2; ++axis) {
      const auto less = [&](std::size_t i, std::size_t j) {
        return points[2 * i + axis] < points[2 * j + axis];
      };
      const auto [least, most] = std::minmax_element(part.begin(), part.end(), less);
      extent[axis] = points[2 * *most + axis] - points[2 * *least + axis];
    }
    const int axis = extent[1] > extent[0];
    const auto middle = part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2);
    std::nth_element(part.begin(), middle, part.end(), [&](std::size_t i, std::size_t j) {
      return points[2 * i + axis] < points[2 * j + axis];
    });
    FixedFrame low = frame, high = frame;
    low.high[axis] = high.low[axis] = points[2 * *middle + axis];
    certify_blocks(points, {part.begin(), middle}, low, block, found);
    certify_blocks(points, {middle, part.end()}, high, block, found);
    return;
  }
  std::vector<double> coordinates;
  for (const std::size_t i : part) {
    coordinates.push_back(static_cast<double>(points[2 * i]));
    coordinates.push_back(static_cast<double>(points[2 * i + 1]));
  }
  research::Options options;
  options.mode = research::Mode::dwyer;
  const auto mesh = research::triangulate_on_host(coordinates.data(), {0, part.size()}, options);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    Integer p[6];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = part[static_cast<std::size_t>(mesh.triangles[t + k])];
      p[2 * k] = points[2 * i];
      p[2 * k + 1] = points[2 * i + 1];
    }
    ++found.triangles;
    const bool in_doubles = is_circle_inside_in_doubles(frame, p);
    const bool in_floats = fixed_predicates().is_circle_inside(frame, p);
    found.in_doubles += in_doubles;
    found.in_floats += in_floats;
    ASSERT_TRUE(in_doubles || !in_floats || circle_is_free(frame, p));
  }
}

TEST(FixedCertify, FewTrianglesWaitForSinglePrecision) {
  for (const char* const distribution : {"uniform", "kuzmin", "line", "normal"}) {
    const std::size_t n = 60000;
    const auto points = points_of(distribution, n);
    for (const std::size_t block : {64, 1024}) {
      Certificates found;
      FixedFrame frame{
          {-kInfinite, -kInfinite}, {kInfinite, kInfinite}, {kInfinite, kInfinite}, {-kInfinite, -kInfinite}};
      for (std::size_t k = 0; k < 2 * n; ++k) {
        frame.all_low[k % 2] = std::min(frame.all_low[k % 2], points[k]);
        frame.all_high[k % 2] = std::max(frame.all_high[k % 2], points[k]);
      }
      std::vector<std::size_t> all(n);
      std::iota(all.begin(), all.end(), 0);
      certify_blocks(points, all, frame, block, found);
      const auto lost = static_cast<double>(found.in_doubles) - static_cast<double>(found.in_floats);
      std::printf(
          "  %-8s blocks of %4zu: %zu triangles, certified %.4f%% in doubles, %.4f%% in floats: %.1f of 10^5 "
          "lost\n",
          distribution, block, found.triangles,
          100.0 * static_cast<double>(found.in_doubles) / found.triangles,
          100.0 * static_cast<double>(found.in_floats) / found.triangles, 1e5 * lost / found.in_doubles);
      EXPECT_LT(lost, 3e-3 * static_cast<double>(found.in_doubles)) << distribution;
    }
  }
}

// -----------------------------------------------------------------------------------------------------------
// Heights

TEST(SmallFixedSeams, HeightsAreWithinTheirError) {
  std::mt19937_64 random(3);
  double largest = 0;
  for (int trial = 0; trial < 100000; ++trial) {
    const int axis = trial % 2;
    const int bits = between(random, 0, 60), along = between(random, 0, 60);
    // A point on the cut; one of the low side and one of the high side.
    Integer p[6];
    for (int k = 0; k < 3; ++k) {
      const Integer from_cut = std::abs(number(random, bits)) >> (random() % 4 == 0 ? 40 : 0);
      p[2 * k + axis] = k == 0 ? 0 : k == 1 ? -from_cut : from_cut;
      p[2 * k + 1 - axis] = number(random, along);
    }
    const Integer by = number(random, 60);
    for (Integer& x : p) x += by;
    const Rational before = rational(p[axis]) - rational(p[2 + axis]),
                   run = rational(p[4 + axis]) - rational(p[2 + axis]);
    // Upwards is along y, or against x.
    const int up = 1 - axis, sign = axis == 0 ? 1 : -1;
    const Rational low = sign * (rational(p[2 + up]) - rational(p[up])),
                   high = sign * (rational(p[4 + up]) - rational(p[up]));
    const Rational share = run > 0 ? Rational(before / run) : Rational(1, 2);
    const Rational height = low + share * (high - low);
    for (const FixedPredicates* const reading : all_fixed_predicates()) {
      for (const Device& device :
           {Device{"to nearest", FE_TONEAREST, false}, Device{"toward zero", FE_TOWARDZERO, true}}) {
        FixedHeight found{};
        {
          const Rounding rounding(device.direction, device.flushes);
          found = reading->height_at_cut(p, axis);
        }
        const double wrong = std::fabs(Rational(Rational(found.at_cut) - height).get_d());
        const double allowed = found.error * found.largest;
        ASSERT_LE(wrong, allowed) << reading->name << ", " << device.name;
        if (allowed > 0) largest = std::max(largest, wrong / allowed);
      }
    }
  }
  std::printf("  heights wrong by at most %.3f of their bound\n", largest);
  EXPECT_GT(largest, 0.02);
}

}  // namespace
}  // namespace flaunay::testing
