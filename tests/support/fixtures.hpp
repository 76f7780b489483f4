// Point sets that have broken triangulators, or might: by name, size and seed, the same on every machine.
#pragma once

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "app/files/generate.hpp"
#include "app/files/points.hpp"

namespace flaunay::testing {

/// x0 y0 x1 y1 ...
using Coordinates = std::vector<double>;

/// Raw output of the engine only: the standard's distributions differ between libraries.
class FixtureRandom {
 public:
  explicit FixtureRandom(std::uint64_t seed) : engine_(seed) {}
  /// In [0, 1).
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// In [low, high], both included.
  std::int64_t integer(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(high - low + 1));
  }
  template <typename Value>
  void shuffle(std::vector<Value>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[engine_() % i]);
  }

 private:
  std::mt19937_64 engine_;
};

struct Fixture {
  std::string name;
  std::function<Coordinates(std::size_t n, std::uint64_t seed)> make;
};

namespace fixtures_detail {

inline void add(Coordinates& points, double x, double y) {
  points.push_back(x);
  points.push_back(y);
}

inline void add(Coordinates& points, std::int64_t x, std::int64_t y) {
  add(points, static_cast<double>(x), static_cast<double>(y));
}

/// Integers on `lines` random lines of small integer direction; exactly collinear on each.
inline Coordinates on_lines(std::size_t n, std::uint64_t seed, std::size_t lines) {
  FixtureRandom random(seed);
  std::vector<std::int64_t> x(lines), y(lines), dx(lines), dy(lines);
  for (std::size_t l = 0; l < lines; ++l) {
    x[l] = random.integer(-1000, 1000);
    y[l] = random.integer(-1000, 1000);
    do {
      dx[l] = random.integer(-5, 5);
      dy[l] = random.integer(-5, 5);
    } while (dx[l] == 0 && dy[l] == 0);
  }
  Coordinates points;
  const auto reach = static_cast<std::int64_t>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t l = i % lines;
    const std::int64_t t = random.integer(-reach, reach);
    add(points, x[l] + t * dx[l], y[l] + t * dy[l]);
  }
  return points;
}

/// One centre and a circle around it.
inline Coordinates star(std::size_t n, std::uint64_t seed) {
  Coordinates points = io::generate("circle", n > 0 ? n - 1 : 0, seed).coordinates;
  if (n > 0) add(points, 0.0, 0.0);
  return points;
}

/// A star of integers, exactly cocircular.
inline Coordinates integer_star(std::size_t n, std::uint64_t seed) {
  Coordinates points = io::generate("integer-circle", n > 0 ? n - 1 : 0, seed).coordinates;
  if (n > 0) add(points, 0.0, 0.0);
  return points;
}

/// A circle and up to ten points in it.
inline Coordinates circle_few_inside(std::size_t n, std::uint64_t seed) {
  FixtureRandom random(seed);
  const std::size_t inside = std::min<std::size_t>(10, n / 4);
  Coordinates points = io::generate("circle", n - inside, seed).coordinates;
  for (std::size_t i = 0; i < inside; ++i) {
    const double x = random.unit() - 0.5;
    add(points, x, random.unit() - 0.5);
  }
  return points;
}

/// Two equally spaced columns: a ladder of squares.
inline Coordinates ladder(std::size_t n, std::uint64_t) {
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    add(points, static_cast<std::int64_t>(i % 2), static_cast<std::int64_t>(i / 2));
  }
  return points;
}

/// All on one line but the last.
inline Coordinates apex(std::size_t n, std::uint64_t seed) {
  Coordinates points = io::generate("collinear", n, seed).coordinates;
  if (n > 0) points.back() -= 7;
  return points;
}

/// All on the edges of one triangle.
inline Coordinates triangle_edges(std::size_t n, std::uint64_t seed) {
  FixtureRandom random(seed);
  Coordinates points;
  const auto side = static_cast<std::int64_t>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t t = random.integer(0, side);
    if (i % 3 == 0) add(points, t, std::int64_t{0});
    if (i % 3 == 1) add(points, std::int64_t{0}, t);
    if (i % 3 == 2) add(points, t, side - t);
  }
  return points;
}

/// Radius from 2^-100 to 2^100: as uneven as the range of magnitudes allows comfortably.
inline Coordinates log_spiral(std::size_t n, std::uint64_t seed) {
  const Coordinates directions = io::generate("circle", n, seed).coordinates;
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const double exponent = 200 * (static_cast<double>(i) + 0.5) / static_cast<double>(n) - 100;
    const double whole = std::floor(exponent);
    const double radius = std::ldexp(1 + (exponent - whole), static_cast<int>(whole));  // piecewise linear
    const std::size_t d = (i * 1009) % n;
    add(points, radius * directions[2 * d], radius * directions[2 * d + 1]);
  }
  return points;
}

/// Uniform, but so far from the origin that hardly any bits are left: a coarse grid with duplicates.
inline Coordinates far_away(std::size_t n, std::uint64_t seed) {
  Coordinates points = io::generate("uniform", n, seed).coordinates;
  for (double& c : points) c += 0x1p45;
  return points;
}

/// Uniform, 1e120 times as high as wide.
inline Coordinates slender(std::size_t n, std::uint64_t seed) {
  Coordinates points = io::generate("uniform", n, seed).coordinates;
  for (std::size_t i = 0; i < points.size(); ++i) points[i] *= i % 2 ? 1e60 : 1e-60;
  return points;
}

/// Four uniform squares of size 2^-40 at the corners of the unit square.
inline Coordinates corners(std::size_t n, std::uint64_t seed) {
  Coordinates points = io::generate("uniform", n, seed).coordinates;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t corner = i / 2 % 4;
    points[i] = points[i] * 0x1p-40 + static_cast<double>(i % 2 ? corner / 2 : corner % 2);
  }
  return points;
}

/// Random points of a square of integers as wide as the number of points: general position, hardly.
inline Coordinates random_integers(std::size_t n, std::uint64_t seed) {
  FixtureRandom random(seed);
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t x = random.integer(0, static_cast<std::int64_t>(n));
    add(points, x, random.integer(0, static_cast<std::int64_t>(n)));
  }
  return points;
}

/// Six points nearly on a line, which a triangulator with rounded predicates refuses; then the same again,
/// each farther off along the line.
inline Coordinates nearly_collinear(std::size_t n, std::uint64_t) {
  constexpr double kPlaces[6][2] = {{-5.88538145, -4.29185831}, {6.16914963, 4.99256718},
                                    {-3.00473339, -2.71106304}, {-0.14600758, 1.82462075},
                                    {1.15481746, -0.56118624},  {0.41423983, 1.01326104}};
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const double shift = 16 * static_cast<double>(i / 6);
    add(points, kPlaces[i % 6][0] + shift, kPlaces[i % 6][1] + 0.75 * shift);
  }
  return points;
}

/// A lattice that is turned, so that its rounded squares are cocircular or not, with one point in eight moved
/// by one unit in the last place.
inline Coordinates nearly_cocircular(std::size_t n, std::uint64_t seed) {
  FixtureRandom random(seed);
  const auto width = static_cast<std::size_t>(std::sqrt(static_cast<double>(n))) + 1;
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = static_cast<double>(i % width) + 1, y = static_cast<double>(i / width) + 1;
    double across = 0.8 * x - 0.6 * y + 4096;
    if (random.integer(0, 7) == 0)
      across = std::nextafter(across, random.integer(0, 1) == 0 ? -HUGE_VAL : HUGE_VAL);
    add(points, across, 0.6 * x + 0.8 * y);
  }
  return points;
}

}  // namespace fixtures_detail

/// Every distribution of io::generate, and more. Each accepts any n and may hold duplicates.
inline const std::vector<Fixture>& all_fixtures() {
  static const std::vector<Fixture> all = [] {
    namespace detail = fixtures_detail;
    std::vector<Fixture> list;
    for (const io::Distribution& distribution : io::distributions()) {
      const std::string name = distribution.name;
      list.push_back({name, [name](std::size_t n, std::uint64_t seed) {
                        return io::generate(name, n, seed).coordinates;
                      }});
    }
    list.push_back({"two-lines", [](auto n, auto seed) { return detail::on_lines(n, seed, 2); }});
    list.push_back({"star", detail::star});
    list.push_back({"integer-star", detail::integer_star});
    list.push_back({"circle-few-inside", detail::circle_few_inside});
    list.push_back({"ladder", detail::ladder});
    list.push_back({"apex", detail::apex});
    list.push_back({"triangle-edges", detail::triangle_edges});
    list.push_back({"log-spiral", detail::log_spiral});
    list.push_back({"far-away", detail::far_away});
    list.push_back({"slender", detail::slender});
    list.push_back({"corners", detail::corners});
    list.push_back({"random-integers", detail::random_integers});
    list.push_back({"nearly-collinear", detail::nearly_collinear});
    list.push_back({"nearly-cocircular", detail::nearly_cocircular});
    return list;
  }();
  return all;
}

inline Coordinates make_fixture(const std::string& name, std::size_t n, std::uint64_t seed) {
  for (const Fixture& fixture : all_fixtures()) {
    if (fixture.name == name) return fixture.make(n, seed);
  }
  throw std::invalid_argument("no fixture " + name);
}

/// Each coordinate moved by one unit in the last place up or down, or not at all. Zeros move by 2^-52: their
/// own next doubles are out of any range of magnitudes.
inline Coordinates perturbed(Coordinates points, std::uint64_t seed) {
  FixtureRandom random(seed);
  for (double& c : points) {
    const auto step = static_cast<double>(random.integer(-1, 1));
    c = c == 0 ? step * 0x1p-52 : step == 0 ? c : std::nextafter(c, step * HUGE_VAL);
  }
  return points;
}

/// All coordinates times the factor, rounded.
inline Coordinates scaled(Coordinates points, double factor) {
  for (double& c : points) c *= factor;
  return points;
}

/// Small sets in full, so that a failure can be replayed.
inline std::string text_of(const Coordinates& points) {
  std::string text = std::to_string(points.size() / 2) + " points";
  for (std::size_t i = 0; i < points.size() && points.size() <= 80; ++i) {
    char buffer[40];
    std::snprintf(buffer, sizeof buffer, "%s%.17g", i % 2 ? " " : "\n  ", points[i]);
    text += buffer;
  }
  return text;
}

/// permutation[i] is where point i of the result comes from.
inline Coordinates permuted(const Coordinates& points, const std::vector<std::size_t>& permutation) {
  Coordinates result;
  for (const std::size_t i : permutation) fixtures_detail::add(result, points[2 * i], points[2 * i + 1]);
  return result;
}

inline std::vector<std::string> fixture_names() {
  std::vector<std::string> names;
  for (const Fixture& fixture : all_fixtures()) names.push_back(fixture.name);
  return names;
}

/// Names a test's instance by its parameter, in letters, digits and underscores.
inline constexpr auto instance_name = [](const auto& info) {
  std::string name = info.param;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
};

/// The files of tests/data.
inline const std::vector<std::string>& data_files() {
  static const std::vector<std::string> all = {"issue13.xy",     "issue43.xy",     "issue44.xy",
                                               "robustness1.xy", "robustness2.xy", "robustness3.xy",
                                               "robustness4.xy", "ukraine.xy",     "garden.las"};
  return all;
}

}  // namespace flaunay::testing
