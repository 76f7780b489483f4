#include "app/files/generate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <utility>

#include "flaunay/flaunay.hpp"

namespace flaunay::io {
namespace {

// The points are the same, byte for byte, on every machine. So this file uses only + - * / and sqrt, which
// IEEE 754 fixes to the last bit, and the raw output of mt19937_64, which the standard fixes. It has its own
// logarithm, sine and cosine, because the C library's differ between versions and processors.

double portable_log(double x) {
  constexpr double kLog2 = 0x1.62e42fefa39efp-1, kHalfRoot = 0x1.6a09e667f3bcdp-1;
  int exponent;
  double mantissa = std::frexp(x, &exponent);
  if (mantissa < kHalfRoot) {
    mantissa *= 2;
    --exponent;
  }
  // log((1 + s) / (1 - s)) = 2 (s + s^3/3 + s^5/5 + ...), |s| < 0.172
  const double s = (mantissa - 1) / (mantissa + 1);
  double sum = 0;
  for (int k = 23; k >= 1; k -= 2) sum = sum * (s * s) + 1.0 / k;
  return exponent * kLog2 + 2 * s * sum;
}

/// Cosine and sine of `turns` full turns.
GeneratedPoint direction(double turns) {
  constexpr double kTau = 0x1.921fb54442d18p+2;
  const double fraction = turns - std::floor(turns);
  const int quarter = static_cast<int>(std::floor(4 * fraction + 0.5));
  const double angle = kTau * (fraction - 0.25 * quarter);  // at most an eighth of a turn
  const double square = angle * angle;
  double cosine = 1, sine = 1;
  for (int k = 18; k >= 2; k -= 2) {
    cosine = 1 - cosine * square / (k * (k - 1));
    sine = 1 - sine * square / (k * (k + 1));
  }
  sine *= angle;
  GeneratedPoint at = {cosine, sine};
  for (int k = 0; k < quarter % 4; ++k) at = {-at.y, at.x};
  return at;
}

}  // namespace

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1).
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  /// In [0, bound); the bias of the remainder is below bound / 2^64.
  std::uint64_t below(std::uint64_t bound) { return engine_() % bound; }
  /// In the unit square.
  GeneratedPoint in_square() { return {unit(), unit()}; }  // in this order, as in all lists in braces
  GeneratedPoint integers_below(std::uint64_t bound) {
    return {static_cast<double>(below(bound)), static_cast<double>(below(bound))};
  }
  /// Two independent N(0, 1), by Box and Muller.
  GeneratedPoint normal_pair() {
    const double radius = std::sqrt(-2 * portable_log(1 - unit()));
    const GeneratedPoint d = direction(unit());
    return {radius * d.x, radius * d.y};
  }
  template <typename Value>
  void shuffle(std::vector<Value>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[below(i)]);
  }

 private:
  std::mt19937_64 engine_;
};

namespace {

using Point = GeneratedPoint;
using MakePoints = Distribution::MakePoints;

/// Makes points one by one.
template <typename MakePoint>
MakePoints each(MakePoint make) {
  return [make = std::move(make)](std::size_t first, std::size_t count, double* coordinates) mutable {
    for (std::size_t i = 0; i < count; ++i) {
      const Point p = make(first + i);
      coordinates[2 * i] = p.x;
      coordinates[2 * i + 1] = p.y;
    }
  };
}

/// Columns of the smallest square grid that has n nodes.
std::size_t grid_width(std::size_t n) {
  auto width = static_cast<std::size_t>(std::sqrt(static_cast<double>(n)));
  while (width * width < n) ++width;
  while (width > 1 && (width - 1) * (width - 1) >= n) --width;
  return width;
}

/// Its node i, row by row.
Point grid_node(std::size_t width, std::size_t i) {
  return {static_cast<double>(i % width), static_cast<double>(i / width)};
}

MakePoints grid(std::size_t n, Random&) {
  return each([width = grid_width(n)](std::size_t i) { return grid_node(width, i); });
}

MakePoints rotated_grid(std::size_t n, Random&) {
  const double cosine = 3 / std::sqrt(10.0), sine = 1 / std::sqrt(10.0);  // by atan(1/3)
  return each([width = grid_width(n), cosine, sine](std::size_t i) {
    const auto [x, y] = grid_node(width, i);
    return Point{cosine * x - sine * y, sine * x + cosine * y};
  });
}

MakePoints hexagonal(std::size_t n, Random&) {
  return each([width = grid_width(n), row_distance = std::sqrt(3.0) / 2](std::size_t i) {
    const auto [x, y] = grid_node(width, i);
    return Point{x + (i / width % 2 ? 0.5 : 0.0), row_distance * y};
  });
}

MakePoints uniform(std::size_t, Random& random) {
  return each([&random](std::size_t) { return random.in_square(); });
}

MakePoints normal(std::size_t, Random& random) {
  return each([&random](std::size_t) { return random.normal_pair(); });
}

MakePoints kuzmin(std::size_t, Random& random) {
  return each([&random](std::size_t) {
    // M(r) = 1 - 1 / sqrt(1 + r^2), inverted.
    const double rest = 1 - random.unit();
    const double radius = std::sqrt(1 / (rest * rest) - 1);
    const Point d = direction(random.unit());
    return Point{radius * d.x, radius * d.y};
  });
}

MakePoints line(std::size_t, Random& random) {
  return each([&random](std::size_t) {
    constexpr double b = 0.001;
    const double u = random.unit();
    return Point{b / (u - b * u + b), random.unit()};
  });
}

MakePoints circle(std::size_t n, Random& random) {
  return each([n, start = random.unit()](std::size_t i) {
    return direction((static_cast<double>(i) + start) / static_cast<double>(n));
  });
}

struct IntegerPoint {
  std::int64_t x, y;
  IntegerPoint times(IntegerPoint other) const {  // as complex numbers
    return {x * other.x - y * other.y, x * other.y + y * other.x};
  }
};

/// 5, 13, 17, ...: primes that are 1 mod 4, as x^2 + y^2.
constexpr IntegerPoint kPrimes[] = {{2, 1}, {3, 2}, {4, 1}, {5, 2}, {6, 1},
                                    {5, 4}, {7, 2}, {6, 5}, {8, 3}, {8, 5}};

/// All points of the integer circle whose squared radius is the product of the first primes to these powers:
/// the Gaussian integers of that norm. z^k conj(z)^(power - k) for each prime, times the four units, gives
/// each once.
std::vector<IntegerPoint> integer_circle_points(const std::vector<int>& powers) {
  std::vector<IntegerPoint> points = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (std::size_t j = 0; j < powers.size(); ++j) {
    const IntegerPoint z = kPrimes[j], conjugate = {z.x, -z.y};
    std::vector<IntegerPoint> products;
    for (int k = 0; k <= powers[j]; ++k) {
      IntegerPoint factor = {1, 0};
      for (int i = 0; i < powers[j]; ++i) factor = factor.times(i < k ? z : conjugate);
      for (const IntegerPoint& p : points) products.push_back(p.times(factor));
    }
    points = std::move(products);
  }
  return points;
}

MakePoints integer_circle(std::size_t n, Random& random) {
  // Each circle has more points than the one before, 4 to 36,864.
  const std::vector<std::vector<int>> circles = {
      {}, {1, 1}, {2, 1, 1}, {2, 2, 1, 1, 1}, {2, 2, 2, 1, 1, 1, 1}, {3, 3, 2, 2, 1, 1, 1, 1, 1, 1}};
  std::vector<IntegerPoint> points;
  for (const std::vector<int>& powers : circles) {
    points = integer_circle_points(powers);
    if (points.size() >= n) break;
  }
  // Scaled by 1, 2, 3, ..., the largest circle gives more circles of as many exactly cocircular points.
  return each([&random, points, scale = std::int64_t{0}](std::size_t i) mutable {
    const std::size_t k = i % points.size();
    if (k == 0) {
      random.shuffle(points);
      ++scale;
    }
    return Point{static_cast<double>(scale * points[k].x), static_cast<double>(scale * points[k].y)};
  });
}

MakePoints nested_circles(std::size_t n, Random& random) {
  return each([n, circles = grid_width(n) / 4 + 1, start = random.unit()](std::size_t i) {
    const std::size_t c = i % circles, on_circle = (n - c + circles - 1) / circles;
    const double radius = static_cast<double>(c + 1) / static_cast<double>(circles);
    const Point d = direction((static_cast<double>(i / circles) + start) / static_cast<double>(on_circle));
    return Point{radius * d.x, radius * d.y};
  });
}

MakePoints columns(std::size_t, Random& random) {
  return each([&random](std::size_t i) {
    constexpr std::size_t kColumns = 8;
    const std::size_t column = i % kColumns, row = i / kColumns;
    // Even columns are equally spaced, odd ones irregular. All numbers are integers, and no two are equal.
    const std::uint64_t shift = column % 2 ? random.below(4) : 0;
    return Point{static_cast<double>(column), static_cast<double>(4 * row + shift)};
  });
}

/// Most of n points with integer coordinates below this occur several times.
std::uint64_t small_bound(std::size_t n) {
  return static_cast<std::uint64_t>(std::sqrt(static_cast<double>(n)) / 2) + 2;
}

MakePoints small_integers(std::size_t n, Random& random) {
  return each([&random, bound = small_bound(n)](std::size_t) { return random.integers_below(bound); });
}

MakePoints one_ulp(std::size_t n, Random& random) {
  return each([&random, bound = small_bound(n)](std::size_t) {
    const auto [x, y] = random.integers_below(bound);
    return Point{1 + x * 0x1p-52, 1 + y * 0x1p-52};
  });
}

MakePoints half_duplicates(std::size_t n, Random& random) {
  const std::size_t originals = n - n / 2;
  std::vector<Point> all;
  all.reserve(n);
  while (all.size() < originals) all.push_back(random.in_square());
  while (all.size() < n) all.push_back(all[random.below(originals)]);
  random.shuffle(all);
  return each([all = std::move(all)](std::size_t i) { return all[i]; });
}

MakePoints collinear(std::size_t n, Random& random) {
  return each([&random, n](std::size_t) {
    const auto position = static_cast<double>(random.below(8 * n));
    return Point{position, 3 * position};
  });
}

MakePoints horizontal(std::size_t n, Random& random) {
  return each([&random, n](std::size_t) { return Point{static_cast<double>(random.below(8 * n)), 7}; });
}

MakePoints parabola(std::size_t n, Random&) {
  // Scaled by a power of two, so that x is within [-1, 1] and x^2 as exact as the integer's square.
  int bits = 0;
  while ((n / 2) >> bits > 0) ++bits;
  return each([middle = static_cast<double>(n / 2), bits](std::size_t i) {
    const double x = std::ldexp(static_cast<double>(i) - middle, -bits);
    return Point{x, x * x};
  });
}

MakePoints clusters(std::size_t, Random& random) {
  std::array<Point, 12> centers;
  for (Point& center : centers) center = random.in_square();
  return each([&random, centers](std::size_t) {
    // Each cluster a quarter the width of the one before: 1/8 down to 3e-8.
    const std::size_t c = random.below(centers.size());
    const double width = std::ldexp(0.125, -2 * static_cast<int>(c));
    const Point d = random.normal_pair();
    return Point{centers[c].x + width * d.x, centers[c].y + width * d.y};
  });
}

MakePoints spiral(std::size_t n, Random& random) {
  // Archimedes' spiral. The distance between its arms equals the distance between points along an arm.
  const double pi = 0x1.921fb54442d18p+1;
  const double arms = std::sqrt(static_cast<double>(n) / pi);
  return each([n, arms, start = random.unit()](std::size_t i) {
    const double radius = std::sqrt((static_cast<double>(i) + 0.5) / static_cast<double>(n));
    const Point d = direction(arms * radius + start);
    return Point{radius * d.x, radius * d.y};
  });
}

MakePoints thirty_lines(std::size_t n, Random& random) {
  constexpr std::size_t kLines = 30;
  // No two of the directions are parallel; each line goes through a random node of a grid as wide as it is
  // long, so that all of them cross.
  static constexpr std::int64_t kDirections[kLines][2] = {
      {1, 0}, {0, 1},  {1, 1}, {1, -1}, {2, 1}, {2, -1}, {1, 2}, {1, -2}, {3, 1}, {3, -1},
      {1, 3}, {1, -3}, {3, 2}, {3, -2}, {2, 3}, {2, -3}, {4, 1}, {4, -1}, {1, 4}, {1, -4},
      {4, 3}, {4, -3}, {3, 4}, {3, -4}, {5, 1}, {5, -1}, {1, 5}, {1, -5}, {5, 2}, {5, -2}};
  const std::uint64_t length = 8 * n;
  std::array<Point, kLines> starts;
  for (Point& start : starts) start = random.integers_below(length + 1);
  return each([&random, length, starts](std::size_t) {
    const std::size_t l = random.below(kLines);
    const double position = static_cast<double>(random.below(length)) - static_cast<double>(length / 2);
    return Point{starts[l].x + static_cast<double>(kDirections[l][0]) * position,
                 starts[l].y + static_cast<double>(kDirections[l][1]) * position};
  });
}

MakePoints power_of_two_span(std::size_t n, Random& random) {
  std::uint64_t span = 4;
  while (span * span / 16 < n) span *= 2;
  return each([&random, span](std::size_t i) {
    // Two opposite corners, so that the span is exact.
    const auto coordinate = [&] { return static_cast<double>(i < 2 ? i * span : random.below(span + 1)); };
    return Point{coordinate(), coordinate()};
  });
}

MakePoints mostly_equal(std::size_t n, Random& random) {
  constexpr std::size_t kOthers = 10;
  return each([&random, stride = n / kOthers + 1, usual = random.in_square()](std::size_t i) {
    return i % stride == stride / 2 ? random.in_square() : usual;
  });
}

MakePoints two_clusters(std::size_t, Random& random) {
  return each([&random](std::size_t) {
    constexpr double kDistance = 1e9;
    const double center = random.below(2) ? kDistance : 0;
    const Point d = random.normal_pair();
    return Point{center + d.x, center + d.y};
  });
}

}  // namespace

const std::vector<Distribution>& distributions() {
  static const std::vector<Distribution> all = {
      {"uniform", "uniform in the unit square", uniform},
      {"normal", "both coordinates standard normal", normal},
      {"kuzmin", "Kuzmin's disk: dense in the centre, heavy tails", kuzmin},
      {"line", "clustered along a vertical line", line},
      {"grid", "a square integer grid, row by row", grid},
      {"rotated-grid", "a square grid turned by atan(1/3), rounded: nearly cocircular, nearly collinear",
       rotated_grid},
      {"hexagonal", "a hexagonal lattice, rounded", hexagonal},
      {"circle", "equally spaced on a unit circle, rounded", circle},
      {"integer-circle", "integers exactly on a circle around 0, or on several if one has too few",
       integer_circle},
      {"nested-circles", "concentric circles, rounded", nested_circles},
      {"columns", "eight columns of exactly collinear integers", columns},
      {"small-integers", "random small integers: most points several times", small_integers},
      {"half-duplicates", "uniform, half of the points copies of others", half_duplicates},
      {"collinear", "random integers exactly on one slanted line", collinear},
      {"parabola", "exactly on a parabola: every point on the hull", parabola},
      {"clusters", "twelve Gaussian clusters, each a quarter as wide as the one before", clusters},
      {"spiral", "a spiral with evenly spaced arms", spiral},
      {"horizontal", "random integers exactly on one horizontal line", horizontal},
      {"thirty-lines", "integers exactly on thirty lines that cross", thirty_lines},
      {"power-of-two-span", "random integers from 0 to a power of two, both included", power_of_two_span},
      {"one-ulp", "rounding errors beside (1, 1): small integers times 2^-52; most points several times",
       one_ulp},
      {"mostly-equal", "all points equal but up to ten", mostly_equal},
      {"two-clusters", "two Gaussian clusters a billion times as far apart as wide", two_clusters},
  };
  return all;
}

void generate(const std::string& distribution, std::size_t n, std::uint64_t seed,
              const PointConsumer& consume) {
  std::string names;
  for (const Distribution& known : distributions()) {
    names += (names.empty() ? "" : ", ") + known.name;
    if (known.name != distribution) continue;
    Random random(seed);
    const MakePoints make = known.maker(n, random);
    constexpr std::size_t kPiece = std::size_t{1} << 16;
    std::vector<double> piece(2 * std::min(n, kPiece));
    for (std::size_t first = 0; first < n; first += kPiece) {
      const std::size_t count = std::min(n - first, kPiece);
      make(first, count, piece.data());
      consume(piece.data(), count);
    }
    return;
  }
  throw Error(ErrorKind::usage, "unknown distribution '" + distribution + "'; expected one of " + names);
}

Points generate(const std::string& distribution, std::size_t n, std::uint64_t seed) {
  Points points;
  points.coordinates.reserve(2 * n);
  generate(distribution, n, seed, [&points](const double* coordinates, std::size_t count) {
    points.coordinates.insert(points.coordinates.end(), coordinates, coordinates + 2 * count);
  });
  return points;
}

}  // namespace flaunay::io
