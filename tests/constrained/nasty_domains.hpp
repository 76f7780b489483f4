// Domains that are hard to refine: by name, size and seed, the same on every machine. Their segments meet at
// points alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/constrained/nasty.hpp"
#include "tests/constrained/refined.hpp"
#include "tests/constrained/segments.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::testing {

struct NastyDomain {
  std::string name;
  /// About n points.
  std::function<DomainToRefine(int n, std::uint64_t seed)> make;
};

namespace nasty_detail {

struct Direction {
  double x, y;
  explicit Direction(double degrees) : x(std::cos(degrees * M_PI / 180)), y(std::sin(degrees * M_PI / 180)) {}
};

inline void add_square(DomainToRefine& domain, double x, double y, double half) {
  const std::int32_t first = domain.size();
  domain.point(x - half, y - half);
  domain.point(x + half, y - half);
  domain.point(x + half, y + half);
  domain.point(x - half, y + half);
  domain.chain(first, true);
}

inline void add_hole(DomainToRefine& domain, double x, double y) {
  domain.holes.insert(domain.holes.end(), {x, y});
}

inline double power_of_ten(FixtureRandom& random, int low, int high) {
  return std::pow(10.0, static_cast<double>(random.integer(low, high)));
}

/// A closed curve around a place.
inline void add_blob(DomainToRefine& domain, FixtureRandom& random, double x, double y, double radius,
                     int n) {
  const std::int32_t first = domain.size();
  const double rough = random.integer(0, 1) == 0 ? std::min(0.4, 3.0 / n) : 0.4;
  for (int i = 0; i < std::max(n, 3); ++i) {
    const Direction d(360.0 * i / std::max(n, 3));
    const double r = radius * (1 + rough * (random.unit() - 1));
    domain.point(x + r * d.x, y + r * d.y);
  }
  domain.chain(first, true);
}

/// With other polygons inside of it, of which some are holes.
inline DomainToRefine polygon(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  domain.outside = Outside::hull;
  add_blob(domain, random, 0, 0, 10, n / 2);
  for (int i = 0; i < 9; ++i) {
    const double x = 2.5 * (i % 3 - 1), y = 2.5 * (i / 3 - 1);
    const auto kind = random.integer(0, 3);
    if (kind > 0) add_blob(domain, random, x, y, 1, n / 18);
    if (kind > 1) add_hole(domain, x, y);
  }
  return domain;
}

/// Wedges of few degrees around a point, of different lengths, with their ends joined or not.
inline DomainToRefine wedges(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  const double step = static_cast<double>(random.integer(1, 20));
  const double start = 90 * random.unit();
  const bool is_joined = random.integer(0, 2) > 0;
  const int count = std::min(n, static_cast<int>(120 / step));
  domain.point(random.unit(), random.unit());
  for (int i = 0; i <= count; ++i) {
    const Direction d(start + step * i);
    const double r = 1 + 0.3 * random.unit();
    domain.segment(0, domain.point(domain.points[0] + r * d.x, domain.points[1] + r * d.y));
    if (i > 0 && is_joined) domain.segment(i, i + 1);
  }
  return domain;
}

/// Rays around a point in a square.
inline DomainToRefine rays(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  domain.point(0.1, 0.05);
  const int count = std::max(3, std::min(n, 100));
  for (int i = 0; i < count; ++i) {
    const Direction d(360 * (i + 0.7 * random.unit()) / count);
    const double r = 0.2 + 0.7 * random.unit();
    domain.segment(0, domain.point(0.1 + r * d.x, 0.05 + r * d.y));
  }
  add_square(domain, 0, 0, 2);
  return domain;
}

/// Thin triangles in a square.
inline DomainToRefine needles(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  add_square(domain, 0, 0, 2);
  const int count = std::max(1, std::min(n / 3, 20));
  const double angle = 3 * random.unit() + 0.01;
  for (int i = 0; i < count; ++i) {
    const double degrees = 360 * random.unit(), x = -1.7 + 3.4 * (i + 0.5) / count,
                 y = 2.4 * random.unit() - 1.2, w = 0.5 / count;
    const Direction d(degrees), e(degrees + angle);
    const std::int32_t first = domain.size();
    domain.point(x, y);
    domain.point(x + w * d.x, y + w * d.y);
    domain.point(x + w * e.x, y + w * e.y);
    domain.chain(first, true);
  }
  return domain;
}

/// Nearly parallel segments close to each other in a square.
inline DomainToRefine parallels(int, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  add_square(domain, 0, 0, 2);
  const double gap = power_of_ten(random, -9, -2), tilt = random.integer(0, 1) == 0 ? 0 : gap / 3;
  const auto count = random.integer(2, 4);
  for (std::int64_t i = 0; i < count; ++i) {
    const double y = static_cast<double>(i) * gap, cut = 0.1 * static_cast<double>(i);
    domain.segment(-1 + cut, y, 1 - cut * random.unit(), y + tilt * random.unit());
  }
  return domain;
}

/// Holes of very different sizes next to each other, and points that are as close.
inline DomainToRefine tiny_holes(int, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  domain.outside = Outside::hull;
  add_square(domain, 0.5, 0.5, 0.5);
  double x = 0.3 + 0.1 * random.unit(), size = 0.01;
  const auto count = random.integer(1, 5);
  for (std::int64_t i = 0; i < count; ++i) {
    add_square(domain, x, 0.4, size);
    add_hole(domain, x, 0.4);
    const double next = size * power_of_ten(random, -3, 0), gap = size * power_of_ten(random, -3, 0);
    x += size + gap + next;
    size = next;
  }
  domain.point(0.7, 0.2);
  domain.point(0.7 + power_of_ten(random, -9, -4), 0.2);
  return domain;
}

/// Points of an integer grid, and segments along it.
inline DomainToRefine lattice(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  const auto side = std::max<std::int32_t>(2, static_cast<std::int32_t>(std::sqrt(n)));
  const auto one_in = random.integer(1, 6);
  for (std::int32_t i = 0; i < side * side; ++i) domain.point(i % side, static_cast<double>(i / side));
  for (std::int32_t i = 0; i < side * side; ++i) {
    if (i % side + 1 < side && random.integer(1, one_in) == 1) domain.segment(i, i + 1);
    if (i / side + 1 < side && random.integer(1, one_in) == 1) domain.segment(i, i + side);
    const bool is_inside = i % side + 1 < side && i / side + 1 < side;
    if (is_inside && random.integer(1, 3 * one_in) == 1) domain.segment(i, i + side + 1);
  }
  return domain;
}

/// Points on a few lines, joined along them; two lines share an end.
inline DomainToRefine collinear_chains(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  const auto lines = random.integer(1, 4);
  const std::int32_t each = std::max(2, std::min(n, 60) / static_cast<int>(lines));
  for (std::int64_t l = 0; l < lines; ++l) {
    const std::int32_t first = domain.size();
    const auto rise = static_cast<double>(l * random.integer(1, 3));
    for (std::int32_t i = 0; i < each; ++i) {
      if (l > 0 && i == 0) continue;  // all begin at the first point
      const double x = i + (random.integer(0, 3) == 0 ? 0x1p-20 * random.unit() : 0);
      domain.point(x, rise * x);
    }
    if (l > 0) domain.segment(0, first);
    domain.chain(first, false);
  }
  domain.point(each, -1.0 - 5 * random.unit());
  return domain;
}

/// One triangle, of any shape.
inline DomainToRefine one_triangle(int, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  const double flatness = power_of_ten(random, -9, 0);
  domain.point(random.unit(), 0);
  domain.point(1 + random.unit(), 0.1 * random.unit() * flatness);
  domain.point(2 * random.unit(), flatness * (0.2 + random.unit()));
  domain.chain(0, true);
  return domain;
}

/// A regular polygon, with or without its sides, middle and chords through it.
inline DomainToRefine circle(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  const int count = std::max(3, n);
  for (int i = 0; i < count; ++i) {
    const Direction d(360.0 * i / count);
    domain.point(d.x, d.y);
  }
  if (random.integer(0, 1) == 0) domain.chain(0, true);
  if (random.integer(0, 1) == 0) {
    const std::int32_t middle = domain.point(0, 0);
    for (int i = 0; i < count; ++i) {
      if (random.integer(0, 4) == 0) domain.segment(i, middle);
    }
  }
  return domain;
}

/// Outlines of letters.
inline DomainToRefine letter(int, std::uint64_t seed) {
  using Ring = std::vector<std::pair<int, int>>;
  struct Outline {
    std::vector<Ring> rings;
    std::vector<std::pair<double, double>> holes;
  };
  static const std::vector<Outline> letters = {
      {{{{0, 0}, {2, 0}, {3, 4}, {7, 4}, {8, 0}, {10, 0}, {6, 14}, {4, 14}}, {{4, 6}, {5, 10}, {6, 6}}},
       {{5, 7}}},
      {{{{0, 0}, {7, 0}, {9, 2}, {9, 5}, {7, 7}, {9, 9}, {9, 12}, {7, 14}, {0, 14}},
        {{2, 2}, {6, 2}, {7, 3}, {6, 6}, {2, 6}},
        {{2, 8}, {6, 8}, {7, 11}, {6, 12}, {2, 12}}},
       {{3, 3}, {3, 9}}},
      {{{{0, 0}, {2, 0}, {2, 11}, {8, 0}, {10, 0}, {10, 14}, {8, 14}, {8, 3}, {2, 14}, {0, 14}}}, {}},
      {{{{1, 0}, {9, 0}, {9, 2}, {3, 2}, {9, 12}, {9, 14}, {1, 14}, {1, 12}, {7, 12}, {1, 2}}}, {}},
      {{{{4, 0}, {6, 0}, {6, 6}, {10, 14}, {8, 14}, {5, 8}, {2, 14}, {0, 14}, {4, 6}}}, {}}};
  FixtureRandom random(seed);
  DomainToRefine domain;
  domain.outside = Outside::hull;
  const auto& outline = letters[static_cast<std::size_t>(random.integer(0, std::ssize(letters) - 1))];
  const double slant = 0.5 * random.unit(), width = 0.1 + random.unit();
  for (const Ring& ring : outline.rings) {
    const std::int32_t first = domain.size();
    for (const auto& [x, y] : ring) domain.point(width * x + slant * y, y);
    domain.chain(first, true);
  }
  for (const auto& [x, y] : outline.holes) add_hole(domain, width * x + slant * y, y);
  return domain;
}

/// A square with cracks: segments that end inside, at its sides, and at each other.
inline DomainToRefine cracks(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  const int teeth = std::max(1, std::min(n / 2, 30));
  domain.point(0, 1);
  domain.point(0, 0);
  for (int i = 0; i < teeth; ++i) domain.point((i + random.unit()) / teeth, 0);
  domain.point(1, 0);
  domain.point(1, 1);
  domain.chain(0, true);
  for (int i = 0; i < teeth; ++i) {
    const double x = domain.points[2 * static_cast<std::size_t>(i) + 4];
    domain.segment(i + 2, domain.point(x, 0.1 + 0.85 * random.unit()));
  }
  return domain;
}

/// Rings around each other that nearly touch.
inline DomainToRefine shells(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  domain.outside = Outside::hull;
  const auto rings = random.integer(2, 4);
  const double gap = power_of_ten(random, -6, -2);
  const int each = std::max(3, std::min(n, 90) / static_cast<int>(rings));
  double radius = 1;
  for (std::int64_t r = 0; r < rings; ++r) {
    const std::int32_t first = domain.size();
    for (int i = 0; i < each; ++i) {
      const Direction d(360.0 * i / each);
      domain.point(radius * d.x, radius * d.y);
    }
    domain.chain(first, true);
    radius *= 1 - gap;
  }
  if (random.integer(0, 1) == 0) add_hole(domain, 0, 0);
  return domain;
}

/// A polygon, or edges, between points with few bits.
inline DomainToRefine few_bits(int n, std::uint64_t seed) {
  FixtureRandom random(seed);
  DomainToRefine domain;
  const auto side = random.integer(2, 12);
  domain.points =
      random_integer_points(static_cast<std::size_t>(std::min(n, 40)) + 3, static_cast<int>(side), seed);
  const double factor = std::ldexp(1, static_cast<int>(random.integer(-3, 3)));
  domain.segments = edges_of_stretched(domain.points, factor, static_cast<int>(random.integer(1, 4)), seed);
  return domain;
}

/// Edges of a stretched triangulation of a fixture, most of which meet at small angles.
inline DomainToRefine stretched(int n, std::uint64_t seed) {
  static const char* const names[] = {"uniform", "clusters", "kuzmin", "random-integers",
                                      "nearly-cocircular"};
  FixtureRandom random(seed);
  DomainToRefine domain;
  domain.points = make_fixture(names[random.integer(0, 4)], static_cast<std::size_t>(std::max(n, 4)), seed);
  const double factor = std::ldexp(1, static_cast<int>(random.integer(-4, 4)));
  domain.segments = edges_of_stretched(domain.points, factor, static_cast<int>(random.integer(1, 6)), seed);
  return domain;
}

/// Points alone.
inline DomainToRefine points_alone(int n, std::uint64_t seed) {
  DomainToRefine domain;
  domain.points =
      make_fixture(seed % 2 == 0 ? "uniform" : "kuzmin", static_cast<std::size_t>(std::max(n, 4)), seed);
  return domain;
}

}  // namespace nasty_detail

/// All of the above, and segments that are nasty to insert.
inline const std::vector<NastyDomain>& nasty_domains() {
  static const std::vector<NastyDomain> all = [] {
    namespace detail = nasty_detail;
    std::vector<NastyDomain> list = {{"polygon", detail::polygon},
                                     {"wedges", detail::wedges},
                                     {"rays", detail::rays},
                                     {"needles", detail::needles},
                                     {"parallels", detail::parallels},
                                     {"tiny-holes", detail::tiny_holes},
                                     {"lattice", detail::lattice},
                                     {"collinear-chains", detail::collinear_chains},
                                     {"one-triangle", detail::one_triangle},
                                     {"circle", detail::circle},
                                     {"letter", detail::letter},
                                     {"cracks", detail::cracks},
                                     {"shells", detail::shells},
                                     {"few-bits", detail::few_bits},
                                     {"stretched", detail::stretched},
                                     {"points", detail::points_alone}};
    for (const NastySegments& nasty : nasty_segments()) {
      list.push_back({nasty.name, [&nasty](int n, std::uint64_t seed) {
                        DomainToRefine domain;
                        static_cast<SegmentInput&>(domain) = nasty.make(n, seed);
                        return domain;
                      }});
    }
    return list;
  }();
  return all;
}

/// Turned, made larger or smaller, and moved: by such amounts that coordinates are coarse, or tiny.
inline void move_and_scale(FixtureRandom& random, DomainToRefine& domain) {
  static const struct {
    double scale, shift;
  } kinds[] = {{1, 0}, {1, 0}, {1e13, 0}, {1e-30, 0}, {0.05, 1e13}, {1, 1e10}, {1e-3, 1}, {0x1p40, 0}};
  const auto& kind = kinds[random.integer(0, 7)];
  const nasty_detail::Direction d(random.integer(0, 1) == 0 ? 0 : 360 * random.unit());
  const double shift_x = kind.shift * (1 - random.unit()), shift_y = kind.shift * random.unit();
  for (std::vector<double>* places : {&domain.points, &domain.holes}) {
    for (std::size_t i = 0; i < places->size(); i += 2) {
      const double x = (*places)[i], y = (*places)[i + 1];
      (*places)[i] = kind.scale * (d.x * x - d.y * y) + shift_x;
      (*places)[i + 1] = kind.scale * (d.y * x + d.x * y) + shift_y;
    }
  }
}

}  // namespace flaunay::testing
