// Segments that are hard for triangulators, and that cross at points alone: by name, size and seed, the same
// on every machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "prove/exact.hpp"
#include "tests/constrained/check.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::testing {

struct SegmentInput {
  Coordinates points;
  Segments segments;

  std::int32_t size() const { return static_cast<std::int32_t>(points.size() / 2); }
  /// Adds a point. Returns its index.
  std::int32_t point(double x, double y) {
    points.insert(points.end(), {x, y});
    return size() - 1;
  }
  void segment(std::int32_t a, std::int32_t b) { segments.insert(segments.end(), {a, b}); }
  void segment(double ax, double ay, double bx, double by) {
    const std::int32_t a = point(ax, ay);
    segment(a, point(bx, by));
  }
  /// Joins the points from `first` on, one after the other.
  void chain(std::int32_t first, bool is_closed) {
    for (std::int32_t v = first + 1; v < size(); ++v) segment(v - 1, v);
    if (is_closed && size() - first > 2) segment(size() - 1, first);
  }
  /// Adds another input with points of its own.
  void add(const SegmentInput& other) {
    const std::int32_t first = size();
    points.insert(points.end(), other.points.begin(), other.points.end());
    for (const std::int32_t v : other.segments) segments.push_back(first + v);
  }
};

struct NastySegments {
  std::string name;
  /// About n points.
  std::function<SegmentInput(int n, std::uint64_t seed)> make;
};

namespace nasty_detail {

constexpr double kUlp = 0x1p-52;  // of coordinates from 1 to 2

/// Two arms that wind around each other: every line between far points crosses all of their turns.
inline SegmentInput spirals(int n, std::uint64_t) {
  SegmentInput input;
  for (const double start : {0.0, M_PI}) {
    const std::int32_t first = input.size();
    for (int i = 0; i < n / 2; ++i) {
      const double angle = 2 * M_PI * std::sqrt(i / 16.0), radius = 1 + angle;
      input.point(radius * std::cos(angle + start), radius * std::sin(angle + start));
    }
    input.chain(first, false);
  }
  return input;
}

/// A spiral along the lines of a grid, with points of the grid on its sides and between them.
inline SegmentInput square_spiral(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  SegmentInput input;
  const int turns = std::max(1, static_cast<int>(std::sqrt(n / 2.0) / 4));
  double x = 0, y = 0;
  input.point(x, y);
  for (int k = 0; k < 4 * turns; ++k) {
    const double length = 2 * (k / 2 + 1);
    x += k % 4 == 0 ? length : k % 4 == 2 ? -length : 0;
    y += k % 4 == 1 ? length : k % 4 == 3 ? -length : 0;
    input.point(x, y);
  }
  input.chain(0, false);
  const std::int64_t reach = 2 * turns + 2;
  while (input.size() < n) {
    const auto column = static_cast<double>(random.integer(-reach, reach));
    input.point(column, static_cast<double>(random.integer(-reach, reach)));
  }
  return input;
}

/// Rays from one point, of two lengths in turn.
inline SegmentInput star(int n, std::uint64_t) {
  SegmentInput input;
  input.point(0, 0);
  for (int i = 1; i < n; ++i) {
    const double angle = 2 * M_PI * i / n, radius = i % 2 ? 1 : 2;
    input.segment(0, input.point(radius * std::cos(angle), radius * std::sin(angle)));
  }
  return input;
}

/// Diameters through one point, which all of them cross, and parts of them.
inline SegmentInput diameters(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  SegmentInput input;
  input.point(0, 0);
  while (input.size() < n) {
    const auto dx = static_cast<double>(random.integer(-n, n)),
               dy = static_cast<double>(random.integer(1, n));
    input.segment(-3 * dx, -3 * dy, 2 * dx, 2 * dy);
    const std::int32_t v = input.point(dx, dy);
    input.segment(v, random.integer(0, 1) == 0 ? 0 : v - 2);
  }
  return input;
}

/// Teeth from both sides, each between two of the other side, and one segment between the tips of both.
inline SegmentInput combs(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  SegmentInput input;
  input.segment(-1.0, 0.0, n + 1.0, 0.0);
  for (int i = 0; i < n / 2; ++i) {
    const double tip = std::ldexp(1, static_cast<int>(-random.integer(0, 40))), side = i % 2 ? 1 : -1;
    input.segment(double(i), side * tip, double(i), side * n);
  }
  return input;
}

/// Parts of the rows, columns and ascending diagonals of a grid, nested, overlapping and equal.
inline SegmentInput grid_lines(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  SegmentInput input;
  const std::int64_t side = std::max(1, static_cast<int>(std::sqrt(n)));
  for (std::int64_t i = 0; i < side * side; ++i) input.point(double(i % side), double(i / side));
  for (std::int64_t k = 0; k < side * side / 2; ++k) {
    const std::int64_t a = random.integer(0, side - 1), b = random.integer(0, side - 1),
                       c = random.integer(0, side - 1), kind = random.integer(0, 2);
    const auto at = [side](std::int64_t x, std::int64_t y) {
      return static_cast<std::int32_t>(y * side + x);
    };
    if (kind == 0) input.segment(at(b, a), at(c, a));
    if (kind == 1) input.segment(at(a, b), at(a, c));
    const std::int64_t length = random.integer(0, side - 1 - std::max(a, b));
    if (kind == 2) input.segment(at(a, b), at(a + length, b + length));
  }
  return input;
}

/// Segments on few lines: nested, one within the next, and shifted; and points beside the lines.
inline SegmentInput overlaps(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  SegmentInput input;
  const int on_line = std::max(2, n / 4);
  for (int line = 0; line < 3; ++line) {
    const std::int32_t first = input.size();
    for (int i = 0; i < on_line; ++i) input.point(2.0 * i + 7 * line, i - 5.0 * line);
    for (int i = 0; i < on_line / 2; ++i) {
      if (line == 0) input.segment(first + i, first + on_line - 1 - i);
      if (line == 1) input.segment(first + i, first + i + on_line / 2);
      if (line == 2) input.segment(first + on_line - 1 - i, first);
    }
  }
  while (input.size() < n) {
    const auto x = static_cast<double>(random.integer(0, 2 * on_line));
    input.point(x, static_cast<double>(random.integer(-on_line, on_line)));
  }
  return input;
}

/// A segment with ones that begin inside of it, on either side, with ones that begin inside of those.
inline void branch(SegmentInput& input, double x, double y, double dx, double dy, int depth) {
  input.segment(x, y, x + 4 * dx, y + 4 * dy);
  for (int k = 1; k < 4 && depth > 0; ++k) {
    const double side = k % 2 ? 0.25 : -0.25;
    branch(input, x + k * dx, y + k * dy, -side * dy, side * dx, depth - 1);
  }
}
inline SegmentInput junctions(int n, std::uint64_t) {
  SegmentInput input;
  int depth = 0;
  for (int size = 2; size * 3 < n; size = 3 * size + 2) ++depth;
  branch(input, 0, 0, 3, 5, depth);
  return input;
}

/// A segment, points exactly on it, and points that miss it by one unit in the last place, with segments
/// away.
inline SegmentInput one_ulp(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  SegmentInput input;
  input.segment(1.0, 1.0, 2.0, 1.5);
  for (int k = 0; input.size() + 2 <= n; ++k) {
    // The line is y = (x + 1) / 2, so multiples of 2^-51 are exact.
    const double x = 1 + std::ldexp(static_cast<double>(random.integer(0, (std::int64_t{1} << 51) - 1)), -51);
    const auto miss = static_cast<double>(random.integer(-1, 1));
    const double y = (x + 1) / 2 + miss * kUlp;
    const std::int32_t near = input.point(x, y);
    const double away = miss == 0 ? (k % 2 ? 1 : -1) : miss;
    // Upright, so no two of them meet unless they are on one line.
    input.segment(near, input.point(x, y + away * (1 + k % 3)));
  }
  return input;
}

/// Nearly horizontal segments, one unit in the last place from each other, and points between their ends.
inline SegmentInput bundle(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  SegmentInput input;
  const double rise = static_cast<double>(random.integer(-3, 3)) * kUlp;
  for (int i = 0; i < n / 3; ++i) {
    const double y = 1.5 + i * kUlp;
    input.segment(1.0, y, 2.0, y + rise);
    input.point(1 + random.unit(), 1.5 + static_cast<double>(random.integer(0, n / 3)) * kUlp);
  }
  return input;
}

/// Segments that leave a bundle for places far from each other.
inline SegmentInput brush(int n, std::uint64_t) {
  SegmentInput input;
  for (int i = 0; i < n / 2; ++i) input.segment(1.0, 1 + i * kUlp, 2.0, 1.0 + i);
  return input;
}

inline void koch(SegmentInput& input, double ax, double ay, double bx, double by, int depth) {
  if (depth == 0) {
    input.point(ax, ay);
    return;
  }
  const double dx = (bx - ax) / 3, dy = (by - ay) / 3, height = std::sqrt(3.0) / 2;
  const double tip_x = ax + 1.5 * dx + height * dy, tip_y = ay + 1.5 * dy - height * dx;
  koch(input, ax, ay, ax + dx, ay + dy, depth - 1);
  koch(input, ax + dx, ay + dy, tip_x, tip_y, depth - 1);
  koch(input, tip_x, tip_y, bx - dx, by - dy, depth - 1);
  koch(input, bx - dx, by - dy, bx, by, depth - 1);
}

/// Koch's snowflake, with smaller ones inside of each other.
inline SegmentInput koch_rings(int n, std::uint64_t) {
  SegmentInput input;
  int depth = 0;
  while (3 << (2 * depth + 2) <= n / 2 && depth < 7) ++depth;
  for (double size = 1; size > 0.01 && (size == 1 || input.size() + (3 << (2 * depth)) <= n); size /= 3) {
    const std::int32_t first = input.size();
    for (int side = 0; side < 3; ++side) {
      const double from = 2 * M_PI * side / 3, to = 2 * M_PI * (side + 1) / 3;
      koch(input, size * std::cos(from), size * std::sin(from), size * std::cos(to), size * std::sin(to),
           depth);
    }
    input.chain(first, true);
  }
  return input;
}

/// Points of one circle with chords that do not cross; some circles have the same points.
inline void chords(SegmentInput& input, FixtureRandom& random, const std::vector<std::int32_t>& circle,
                   std::size_t first, std::size_t last) {
  if (last - first < 2) return;
  const auto middle = static_cast<std::size_t>(
      random.integer(static_cast<std::int64_t>(first) + 1, static_cast<std::int64_t>(last) - 1));
  if (random.integer(0, 2) > 0) input.segment(circle[first], circle[middle]);
  if (random.integer(0, 2) == 0) input.segment(circle[last], circle[middle]);
  chords(input, random, circle, first, middle);
  chords(input, random, circle, middle, last);
}
inline SegmentInput circle_with_chords(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  SegmentInput input;
  // Radii with 12, 36 and 108 integer points.
  const std::int64_t radius = n < 30 ? 5 : n < 100 ? 65 : 1105;
  std::vector<std::pair<std::int64_t, std::int64_t>> places;
  for (std::int64_t x = -radius; x <= radius; ++x) {
    const auto y =
        static_cast<std::int64_t>(std::lround(std::sqrt(static_cast<double>(radius * radius - x * x))));
    if (x * x + y * y != radius * radius) continue;
    places.emplace_back(x, y);
    if (y != 0) places.emplace_back(x, -y);
  }
  std::sort(places.begin(), places.end(), [](const auto& p, const auto& q) {
    return std::atan2(p.second, p.first) < std::atan2(q.second, q.first);
  });
  std::vector<std::int32_t> circle;
  circle.reserve(places.size());
  for (const auto& [x, y] : places) circle.push_back(input.point(double(x), double(y)));
  chords(input, random, circle, 0, circle.size() - 1);
  return input;
}

}  // namespace nasty_detail

/// A ring through points, in the order of their angles around about their middle, and the same ring half as
/// large inside of it, and so on, `rings` times. Points behind others are in no ring. With an angle of more
/// than a half turn between two points the ring stays open there.
inline SegmentInput rings_through(const Coordinates& points, int rings) {
  double middle[2] = {0, 0};
  for (std::size_t i = 0; i < points.size(); ++i)
    middle[i % 2] += points[i] / (static_cast<double>(points.size()) / 2);
  std::vector<std::pair<double, double>> around;
  const double origin[2] = {0, 0};
  for (std::size_t i = 0; i < points.size(); i += 2) {
    const double x = points[i] - middle[0], y = points[i + 1] - middle[1];
    if (x != 0 || y != 0) around.emplace_back(x, y);
  }
  ExactPredicates exact;
  const auto turn = [&](const auto& p, const auto& q) {
    const double a[2] = {p.first, p.second}, b[2] = {q.first, q.second};
    return exact.orient2d(origin, a, b);
  };
  const auto is_lower = [](const auto& p) { return p.second < 0 || (p.second == 0 && p.first < 0); };
  const auto comes_before = [&](const auto& p, const auto& q) {
    if (is_lower(p) != is_lower(q)) return is_lower(p);
    return turn(p, q) > 0;
  };
  std::sort(around.begin(), around.end());
  std::stable_sort(around.begin(), around.end(), comes_before);
  SegmentInput input;
  for (int r = 0; r < rings; ++r) {
    std::vector<std::pair<std::int32_t, std::pair<double, double>>> ring;
    for (std::size_t i = 0; i < around.size(); ++i) {
      const auto& p = around[i];
      const std::int32_t v = input.point(std::ldexp(p.first, -r), std::ldexp(p.second, -r));
      if (i == 0 || comes_before(around[i - 1], p)) ring.emplace_back(v, p);
    }
    for (std::size_t i = 0; ring.size() > 2 && i < ring.size(); ++i) {
      const auto& [v, p] = ring[i];
      const auto& [w, q] = ring[i + 1 == ring.size() ? 0 : i + 1];
      if (turn(p, q) > 0) input.segment(v, w);
    }
  }
  return input;
}

/// All of the above, and rings through the fixtures.
inline const std::vector<NastySegments>& nasty_segments() {
  static const std::vector<NastySegments> all = [] {
    namespace detail = nasty_detail;
    std::vector<NastySegments> list = {{"spirals", detail::spirals},
                                       {"square-spiral", detail::square_spiral},
                                       {"star", detail::star},
                                       {"diameters", detail::diameters},
                                       {"combs", detail::combs},
                                       {"grid-lines", detail::grid_lines},
                                       {"overlaps", detail::overlaps},
                                       {"junctions", detail::junctions},
                                       {"one-ulp", detail::one_ulp},
                                       {"bundle", detail::bundle},
                                       {"brush", detail::brush},
                                       {"koch-rings", detail::koch_rings},
                                       {"circle-with-chords", detail::circle_with_chords}};
    for (const char* const name : {"uniform", "clusters", "star", "random-integers", "nearly-cocircular"}) {
      list.push_back({std::string("rings-through-") + name, [name](int n, std::uint64_t seed) {
                        return rings_through(make_fixture(name, static_cast<std::size_t>(n / 3), seed), 3);
                      }});
    }
    return list;
  }();
  return all;
}

/// Points in another order, each with an equal one, of which segments take either; segments in another order
/// and direction, some of them twice.
inline SegmentInput duplicated(const SegmentInput& input, std::uint64_t seed) {
  FixtureRandom random(seed);
  std::vector<std::size_t> order;
  for (std::int32_t v = 0; v < input.size(); ++v) order.insert(order.end(), 2, static_cast<std::size_t>(v));
  random.shuffle(order);
  SegmentInput result;
  std::vector<std::vector<std::int32_t>> copies(static_cast<std::size_t>(input.size()));
  for (const std::size_t v : order)
    copies[v].push_back(result.point(input.points[2 * v], input.points[2 * v + 1]));
  std::vector<std::size_t> numbers;
  for (std::size_t s = 0; s < input.segments.size() / 2; ++s) {
    numbers.insert(numbers.end(), static_cast<std::size_t>(random.integer(1, 2)), s);
  }
  random.shuffle(numbers);
  for (const std::size_t s : numbers) {
    const auto turned = static_cast<std::size_t>(random.integer(0, 1));
    const auto end = [&](std::size_t k) {
      const auto& of_point = copies[static_cast<std::size_t>(input.segments[2 * s + k])];
      return of_point[static_cast<std::size_t>(random.integer(0, 1))];
    };
    const std::int32_t a = end(turned);
    result.segment(a, end(1 - turned));
  }
  return result;
}

/// With x and y exchanged and one of them negated.
inline SegmentInput turned(SegmentInput input) {
  for (std::size_t i = 0; i < input.points.size(); i += 2) {
    const double x = input.points[i];
    input.points[i] = -input.points[i + 1];
    input.points[i + 1] = x;
  }
  return input;
}

}  // namespace flaunay::testing
