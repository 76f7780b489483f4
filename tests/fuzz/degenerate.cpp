#include "tests/fuzz/degenerate.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace flaunay::fuzz {
namespace {

using testing::FixtureRandom;
using testing::fixtures_detail::add;

std::size_t size_between(FixtureRandom& random, std::int64_t low, std::int64_t high) {
  return static_cast<std::size_t>(random.integer(low, high));
}
bool once_in(FixtureRandom& random, std::int64_t times) { return random.integer(1, times) == 1; }

/// Random points of a small grid: many are equal, collinear and cocircular.
Coordinates small_grid(FixtureRandom& random, std::size_t n) {
  const std::int64_t width = random.integer(0, 9), height = random.integer(1, 9);
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t x = random.integer(0, width);
    add(points, x, random.integer(0, height));
  }
  return points;
}

/// Rows of a grid, each shifted against the one below.
Coordinates sheared_grid(FixtureRandom& random, std::size_t n) {
  const std::int64_t width = random.integer(1, 1 + static_cast<std::int64_t>(std::sqrt(n))),
                     shear = random.integer(-3, 3);
  Coordinates points;
  for (std::int64_t i = 0; i < static_cast<std::int64_t>(n); ++i)
    add(points, i % width + shear * (i / width), i / width);
  return points;
}

/// Integer points of one circle around the origin, sometimes with points of the grid inside.
Coordinates on_a_circle(FixtureRandom& random, std::size_t n) {
  // The squares of radii with 4, 12, 16, 32 and 64 integer points.
  constexpr std::int64_t kSquares[] = {1, 25, 65, 1105, 32045};
  const std::int64_t square = kSquares[random.integer(0, std::ssize(kSquares) - 1)];
  const bool others = once_in(random, 3);
  std::vector<std::pair<std::int64_t, std::int64_t>> circle;
  const auto radius = static_cast<std::int64_t>(std::sqrt(static_cast<double>(square)));
  for (std::int64_t x = -radius; x <= radius; ++x) {
    const auto y = static_cast<std::int64_t>(std::lround(std::sqrt(static_cast<double>(square - x * x))));
    if (x * x + y * y != square) continue;
    circle.emplace_back(x, y);
    circle.emplace_back(x, -y);
  }
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    if (others && once_in(random, 4)) {
      const std::int64_t x = random.integer(-radius, radius);
      add(points, x, random.integer(-radius, radius));
    } else {
      const auto& [x, y] = circle[size_between(random, 0, std::ssize(circle) - 1)];
      add(points, x, y);
    }
  }
  return points;
}

/// Points of one line, sometimes all but one.
Coordinates on_a_line(FixtureRandom& random, std::size_t n) {
  const std::int64_t dx = random.integer(-4, 4), dy = random.integer(-4, 4),
                     reach = random.integer(1, 2 * static_cast<std::int64_t>(n) + 1);
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t t = random.integer(-reach, reach);
    add(points, t * dx, t * dy);
  }
  if (n > 0 && once_in(random, 2)) points[size_between(random, 0, std::ssize(points) - 1)] += 1;
  return points;
}

/// Integers along x, and along y 0 or the smallest steps: triangles as flat as they can be.
Coordinates nearly_on_a_line(FixtureRandom& random, std::size_t n) {
  const double step = std::ldexp(1, static_cast<int>(-random.integer(1, 400)));
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const auto x = static_cast<double>(random.integer(0, static_cast<std::int64_t>(n)));
    add(points, x, step * static_cast<double>(random.integer(-1, 1)));
  }
  return points;
}

/// Powers of two of either sign, and 0. Rarely out of the range of magnitudes.
Coordinates powers_of_two(FixtureRandom& random, std::size_t n) {
  const std::int64_t most = once_in(random, 20) ? 1000 : random.integer(1, 240);
  const auto power = [&] {
    const double magnitude = std::ldexp(1, static_cast<int>(random.integer(-most, most)));
    return magnitude * static_cast<double>(random.integer(-1, 1));
  };
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = power();
    add(points, x, power());
  }
  return points;
}

Coordinates any_fixture(FixtureRandom& random, std::size_t n) {
  const auto& fixtures = testing::all_fixtures();
  const auto& fixture = fixtures[size_between(random, 0, std::ssize(fixtures) - 1)];
  return fixture.make(n, static_cast<std::uint64_t>(random.integer(0, 1'000'000)));
}

Coordinates shape(FixtureRandom& random, std::size_t n) {
  using Make = Coordinates (*)(FixtureRandom&, std::size_t);
  constexpr Make kShapes[] = {small_grid,       sheared_grid,  on_a_circle, on_a_line,
                              nearly_on_a_line, powers_of_two, any_fixture, any_fixture};
  return kShapes[random.integer(0, std::ssize(kShapes) - 1)](random, n);
}

/// Replaces points by equal ones, all of them by a few if it comes to it.
void duplicate(FixtureRandom& random, Coordinates& points) {
  const std::int64_t n = std::ssize(points) / 2;
  for (std::int64_t left = n > 0 ? random.integer(0, n) : 0; left > 0; --left) {
    const std::size_t from = size_between(random, 0, n - 1), to = size_between(random, 0, n - 1);
    points[2 * to] = points[2 * from];
    points[2 * to + 1] = points[2 * from + 1];
  }
}

bool all_finite(const Coordinates& points) {
  return std::all_of(points.begin(), points.end(), [](double value) { return std::isfinite(value); });
}

Coordinates degenerate_set(FixtureRandom& random, std::size_t n) {
  Coordinates points;
  if (once_in(random, 6)) {
    const std::size_t first = size_between(random, 0, static_cast<std::int64_t>(n));
    points = shape(random, first);
    const Coordinates second = shape(random, n - first);
    points.insert(points.end(), second.begin(), second.end());
  } else {
    points = shape(random, n);
  }
  if (once_in(random, 5)) duplicate(random, points);
  const Coordinates before = points;
  if (once_in(random, 8)) points = testing::scaled(std::move(points), 1.0 / 3);
  if (once_in(random, 8)) {
    const double shift = std::ldexp(1, static_cast<int>(random.integer(-60, 60)));
    for (double& value : points) value += shift;
  }
  if (once_in(random, 5))
    points = testing::perturbed(std::move(points), static_cast<std::uint64_t>(random.integer(0, 1'000'000)));
  return all_finite(points) ? points : before;
}

std::size_t any_size(FixtureRandom& random) {
  const std::int64_t kind = random.integer(1, 100);
  if (kind <= 5) return 0;
  if (kind <= 60) return size_between(random, 1, 12);
  if (kind <= 92) return size_between(random, 13, 100);
  if (kind <= 99) return size_between(random, 101, 1500);
  return size_between(random, 1501, 6000);
}

}  // namespace

Batch degenerate_batch(FixtureRandom& random) {
  const std::int64_t kind = random.integer(1, 10);
  const std::size_t sets = kind <= 6   ? 1
                           : kind <= 9 ? size_between(random, 2, 6)
                                       : size_between(random, 7, 40);
  Batch batch;
  for (std::size_t s = 0; s < sets; ++s) batch.push_back(degenerate_set(random, any_size(random)));
  if (!once_in(random, 6)) return batch;

  // All sets by the same power of two, or each by its own: every set has the whole range of magnitudes.
  const auto any_exponent = [&random] { return static_cast<int>(random.integer(-1060, 1000)); };
  const bool is_same = random.integer(0, 1) == 0;
  int exponent = any_exponent();
  Batch scaled = batch;
  for (Coordinates& set : scaled) {
    if (!is_same) exponent = any_exponent();
    for (double& value : set) value = std::ldexp(value, exponent);
  }
  return std::all_of(scaled.begin(), scaled.end(), all_finite) ? scaled : batch;
}

Batch large_set(FixtureRandom& random) {
  return {degenerate_set(random, static_cast<std::size_t>(5000 * std::pow(20, random.unit())))};
}

}  // namespace flaunay::fuzz
