// Cases for the predicates in fixed point, and what GMP says of them. Shares no code with kernels/.
#pragma once

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "tests/support/fixed_point.hpp"
#include "tests/support/whole.hpp"

namespace flaunay::testing {

using Integer = std::int64_t;
/// Fills a case: points one after the other.
using Cases = std::function<void(std::mt19937_64&, Integer*)>;

constexpr Integer kLargest = (Integer{1} << 62) - 1;

inline mpz_class integer(Integer x) { return whole(x); }

inline mpz_class cross(const Integer* a, const Integer* b, const Integer* c, const Integer* d) {
  return (integer(b[0]) - integer(a[0])) * (integer(d[1]) - integer(c[1])) -
         (integer(b[1]) - integer(a[1])) * (integer(d[0]) - integer(c[0]));
}

inline mpz_class orientation(const Integer* p) { return cross(p, p + 2, p, p + 4); }

/// The 4 x 4 determinant of rows (x, y, x^2 + y^2, 1), expanded by the lifts.
inline mpz_class in_circle(const Integer* p) {
  mpz_class determinant = 0;
  for (int i = 0; i < 4; ++i) {
    const Integer* others[3];
    for (int j = 0, k = 0; j < 4; ++j) {
      if (j != i) others[k++] = p + 2 * j;
    }
    const mpz_class x = integer(p[2 * i]), y = integer(p[2 * i + 1]);
    const mpz_class term = (x * x + y * y) * cross(others[0], others[1], others[0], others[2]);
    if (i % 2 == 0) {
      determinant += term;
    } else {
      determinant -= term;
    }
  }
  return determinant;
}

inline std::string text_of(const Integer* p, int count) {
  std::string text;
  for (int k = 0; k < count; ++k) text += (k == 0 ? "" : ", ") + std::to_string(p[k]);
  return text;
}

inline Integer limited(Integer x) { return std::clamp(x, -kLargest, kLargest); }

/// Of at most so many bits, of either sign.
inline Integer number(std::mt19937_64& random, int bits) {
  const auto magnitude = static_cast<Integer>(random() & ((std::uint64_t{1} << bits) - 1));
  return (random() & 1) != 0 ? magnitude : -magnitude;
}
inline int between(std::mt19937_64& random, int low, int high) {
  return low + static_cast<int>(random() % static_cast<std::uint64_t>(high - low + 1));
}
inline long double angle(std::mt19937_64& random) {
  return 6.283185307179586L * static_cast<long double>(random()) * 0x1p-64L;
}

inline void random_points(std::mt19937_64& random, Integer* p, int count, int bits) {
  for (int k = 0; k < 2 * count; ++k) p[k] = number(random, bits);
}

inline void swap_points(std::mt19937_64& random, Integer* p, int count) {
  for (int k = count - 1; k > 0; --k) {
    const int j = between(random, 0, k);
    std::swap_ranges(p + 2 * k, p + 2 * k + 2, p + 2 * j);
  }
}

/// Moves all points, as far as there is room.
inline void move_points(std::mt19937_64& random, Integer* p, int count) {
  for (int axis = 0; axis < 2; ++axis) {
    Integer low = kLargest, high = -kLargest;
    for (int k = 0; k < count; ++k) {
      low = std::min(low, p[2 * k + axis]);
      high = std::max(high, p[2 * k + axis]);
    }
    const bool is_up = (random() & 1) != 0;
    const auto room = static_cast<std::uint64_t>(is_up ? kLargest - high : low + kLargest);
    const auto by = static_cast<Integer>(random() % (room + 1) >> between(random, 0, 61));
    for (int k = 0; k < count; ++k) p[2 * k + axis] += is_up ? by : -by;
  }
}

inline void nudge_one(std::mt19937_64& random, Integer* p, int count) {
  Integer& x = p[between(random, 0, 2 * count - 1)];
  x = limited(x + between(random, -1, 1));
}

/// Three points on a line, or as near to it as integers can be.
inline void nearly_straight(std::mt19937_64& random, Integer* p) {
  const int bits = between(random, 1, 61);
  random_points(random, p, 2, bits);
  const long double t = angle(random) - 3;
  for (int axis = 0; axis < 2; ++axis) {
    const long double from = static_cast<long double>(p[axis]), to = static_cast<long double>(p[2 + axis]);
    p[4 + axis] = static_cast<Integer>(std::clamp(from + t * (to - from), -0x1p61L, 0x1p61L));
  }
  nudge_one(random, p, 3);
  swap_points(random, p, 3);
  move_points(random, p, 3);
}

/// Exactly on a line.
inline void straight(std::mt19937_64& random, Integer* p) {
  const int bits = between(random, 1, 60);
  const Integer dx = number(random, bits), dy = number(random, bits);
  const int most = 61 - bits;
  for (int k = 0; k < 3; ++k) {
    const Integer steps = number(random, between(random, 0, most));
    p[2 * k] = steps * dx;
    p[2 * k + 1] = steps * dy;
  }
  move_points(random, p, 3);
}

/// Four points next to a circle, a unit off or less: often of very different distances.
inline void nearly_round(std::mt19937_64& random, Integer* p) {
  const long double radius = std::ldexp(1 + angle(random) / 7, between(random, 0, 60));
  const long double x = static_cast<long double>(number(random, 60)),
                    y = static_cast<long double>(number(random, 60));
  const long double first = angle(random), spread = std::ldexp(1, -between(random, 0, 30));
  for (int k = 0; k < 4; ++k) {
    const long double at = (random() & 1) != 0 ? angle(random) : first + spread * angle(random);
    p[2 * k] = limited(static_cast<Integer>(std::llrint(x + radius * std::cos(at))));
    p[2 * k + 1] = limited(static_cast<Integer>(std::llrint(y + radius * std::sin(at))));
  }
  nudge_one(random, p, 4);
}

/// Exactly on a circle: a rectangle or an isosceles trapezium, turned.
inline void exactly_round(std::mt19937_64& random, Integer* p) {
  const int bits = between(random, 1, 28);
  const Integer ux = number(random, bits), uy = number(random, bits);
  const Integer length = number(random, between(random, 0, 30)),
                height = number(random, between(random, 0, 30));
  const Integer shift = number(random, between(random, 0, 30));
  // Of the coordinates along (ux, uy) and across.
  const Integer places[4][2] = {{-length, 0}, {length, 0}, {shift, height}, {-shift, height}};
  for (int k = 0; k < 4; ++k) {
    p[2 * k] = places[k][0] * ux - places[k][1] * uy;
    p[2 * k + 1] = places[k][0] * uy + places[k][1] * ux;
  }
  swap_points(random, p, 4);
  move_points(random, p, 4);
}

/// At the limits of what coordinates may be, and 0, all of them a unit off or not.
inline void extreme(std::mt19937_64& random, Integer* p, int count) {
  for (int k = 0; k < 2 * count; ++k) {
    const Integer ends[] = {kLargest,     -kLargest,    0,
                            kLargest - 1, 1 - kLargest, Integer{1} << between(random, 0, 61)};
    p[k] = limited(ends[random() % 6] + between(random, -1, 1));
  }
}

/// Points few units apart, somewhere.
inline void close_together(std::mt19937_64& random, Integer* p, int count) {
  random_points(random, p, count, between(random, 1, 6));
  move_points(random, p, count);
}

/// Points of which some are close to others and far from the rest: magnitudes of terms differ.
inline void of_all_scales(std::mt19937_64& random, Integer* p, int count) {
  for (int k = 0; k < 2 * count; ++k) p[k] = number(random, between(random, 0, 61));
}

struct Class {
  const char* name;
  Cases make;
  double zeros_least;
};

inline Cases of(int count, void (*make)(std::mt19937_64&, Integer*, int)) {
  return [=](std::mt19937_64& random, Integer* p) { make(random, p, count); };
}

inline std::vector<Class> orientation_classes() {
  return {{"random", [](auto& random, Integer* p) { random_points(random, p, 3, 61); }, 0},
          {"nearly straight", nearly_straight, 0.001},
          {"straight", straight, 1},
          {"extreme", of(3, extreme), 0.01},
          {"close together", of(3, close_together), 0.01},
          {"of all scales", of(3, of_all_scales), 0}};
}

inline std::vector<Class> circle_classes() {
  return {{"random", [](auto& random, Integer* p) { random_points(random, p, 4, 61); }, 0},
          {"nearly round", nearly_round, 0.001},
          {"round", exactly_round, 1},
          {"extreme", of(4, extreme), 0.01},
          {"close together", of(4, close_together), 0.01},
          {"of all scales", of(4, of_all_scales), 0},
          // Three on a line, or nearly, and one more.
          {"nearly straight",
           [](auto& random, Integer* p) {
             nearly_straight(random, p);
             random_points(random, p + 6, 1, 61);
             swap_points(random, p, 4);
           },
           0}};
}

// Certificates: a triangle, and the block that it is of

using Rational = mpq_class;

constexpr Integer kInfinite = std::numeric_limits<Integer>::max();

inline Rational rational(Integer x) { return Rational(whole(x)); }

struct Box {
  Integer low[2], high[2];
};

/// The parts of the box around all points that lie on or beyond a side of the rectangle.
inline std::vector<Box> boxes_beyond(const FixedFrame& f) {
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

inline Rational distance(const Rational& x, Integer low, Integer high) {
  if (x < rational(low)) return rational(low) - x;
  if (x > rational(high)) return x - rational(high);
  return 0;
}

/// The circle through three points; false if there is none.
struct Circle {
  Rational x, y, radius_squared;
};
inline bool find_circle(const Integer* p, Circle& circle) {
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

inline bool circle_is_free(const FixedFrame& frame, const Integer* p) {
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
inline bool half_plane_is_free(const FixedFrame& f, const Integer* p) {
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

/// Three points: of some size, thin, on a grid, or nearly on a line.
inline void three_points(std::mt19937_64& random, Integer* p) {
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
inline FixedFrame frame_around(std::mt19937_64& random, const Integer* p) {
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

}  // namespace flaunay::testing
