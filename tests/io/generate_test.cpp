#include "app/files/generate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "flaunay/flaunay.hpp"

namespace flaunay::io {
namespace {

using Pair = std::pair<double, double>;

Pair point(const Points& points, std::size_t i) {
  return {points.coordinates[2 * i], points.coordinates[2 * i + 1]};
}

std::set<Pair> distinct(const Points& points) {
  std::set<Pair> set;
  for (std::size_t i = 0; i < points.size(); ++i) set.insert(point(points, i));
  return set;
}

/// FNV-1a over the bytes of the coordinates.
std::uint64_t fingerprint(const Points& points) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const double value : points.coordinates) {
    unsigned char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 0x100000001b3;
  }
  return hash;
}

/// The share of the points for which holds(x, y).
template <typename Condition>
double share(const Points& points, Condition holds) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    count += holds(points.coordinates[2 * i], points.coordinates[2 * i + 1]);
  }
  return static_cast<double>(count) / static_cast<double>(points.size());
}

__int128 squared_radius(Pair p) {
  const auto x = static_cast<__int128>(p.first), y = static_cast<__int128>(p.second);
  return x * x + y * y;
}

TEST(Generate, KnowsTheDistributionsOfItsHeader) {
  std::vector<std::string> names;
  for (const Distribution& d : distributions()) {
    names.push_back(d.name);
    EXPECT_FALSE(d.description.empty()) << d.name;
  }
  const std::vector<std::string> expected = {
      "uniform",      "normal",         "kuzmin",          "line",           "grid",
      "rotated-grid", "hexagonal",      "circle",          "integer-circle", "nested-circles",
      "columns",      "small-integers", "half-duplicates", "collinear",      "parabola",
      "clusters",     "spiral",         "horizontal",      "thirty-lines",   "power-of-two-span",
      "one-ulp",      "mostly-equal",   "two-clusters"};
  EXPECT_EQ(names, expected);
}

TEST(Generate, GivesAsManyFinitePointsAsAskedFor) {
  for (const Distribution& d : distributions()) {
    for (const std::size_t n : {0, 1, 2, 3, 7, 1000}) {
      const Points points = generate(d.name, n, 5);
      EXPECT_EQ(points.size(), n) << d.name;
      EXPECT_EQ(points.coordinates.size(), 2 * n) << d.name;
      EXPECT_TRUE(std::all_of(points.coordinates.begin(), points.coordinates.end(),
                              [](double value) { return std::isfinite(value); }))
          << d.name << " " << n;
    }
  }
}

TEST(Generate, UnknownNameListsTheKnownOnes) {
  try {
    generate("unifrom", 3, 0);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    const std::string message = error.what();
    for (const char* part : {"unifrom", "uniform, normal", "spiral"}) {
      EXPECT_NE(message.find(part), std::string::npos) << message;
    }
  }
}

TEST(Generate, SeedDecidesThePoints) {
  const std::set<std::string> without_chance = {"grid", "rotated-grid", "hexagonal", "parabola"};
  for (const Distribution& d : distributions()) {
    const Points first = generate(d.name, 500, 1);
    EXPECT_EQ(first.coordinates, generate(d.name, 500, 1).coordinates) << d.name;
    EXPECT_EQ(first.coordinates == generate(d.name, 500, 2).coordinates, without_chance.count(d.name) == 1)
        << d.name;
  }
}

// Recorded once: every machine and compiler must give these bytes.
TEST(Generate, SameBytesOnEveryMachine) {
  const std::map<std::string, std::uint64_t> recorded = {
      {"uniform", 0xaea23479f0a69af3},
      {"normal", 0x732852eed1ac728f},
      {"kuzmin", 0x6ebb0f646679f400},
      {"line", 0xade65d036dc7e3ca},
      {"grid", 0xa77765271d0114d5},
      {"rotated-grid", 0x349f7fcc0fe9d7df},
      {"hexagonal", 0x81d3788566ee1799},
      {"circle", 0x23532a4166d965c0},
      {"integer-circle", 0x41ddcff3819bd516},
      {"nested-circles", 0xf9d36e1a5dca8be7},
      {"columns", 0x799ada0937a2a765},
      {"small-integers", 0xdb3199625b6e43ef},
      {"half-duplicates", 0x9963abd6bab584ec},
      {"collinear", 0x1792ef23a8428d0e},
      {"parabola", 0x7dc9dcd94a8c3f50},
      {"clusters", 0x2b5f9350a489977c},
      {"spiral", 0xdedaf1dbe81557ed},
      {"horizontal", 0xbaee1a9c57305568},
      {"thirty-lines", 0x4de8fc3071f2e36e},
      {"power-of-two-span", 0x35343ae89c50e74a},
      {"one-ulp", 0xac2935e42991bafb},
      {"mostly-equal", 0xc96ceb4753918e59},
      {"two-clusters", 0x32a89030b06e9199},
  };
  for (const Distribution& d : distributions()) {
    ASSERT_EQ(recorded.count(d.name), 1u) << d.name;
    EXPECT_EQ(fingerprint(generate(d.name, 1000, 1)), recorded.at(d.name))
        << d.name << " gave " << fingerprint(generate(d.name, 1000, 1));
  }
}

TEST(Generate, UniformFillsTheUnitSquare) {
  const Points points = generate("uniform", 40000, 3);
  EXPECT_EQ(share(points, [](double x, double y) { return x >= 0 && x < 1 && y >= 0 && y < 1; }), 1);
  EXPECT_NEAR(share(points, [](double x, double y) { return x < 0.5 && y < 0.5; }), 0.25, 0.01);
  EXPECT_NEAR(share(points, [](double x, double y) { return x < y; }), 0.5, 0.012);
}

TEST(Generate, NormalHasTheNormalDistribution) {
  const Points points = generate("normal", 40000, 3);
  // P(|x| < 1) and P(r < 1) of the standard normal distribution.
  EXPECT_NEAR(share(points, [](double x, double) { return std::fabs(x) < 1; }), 0.6827, 0.01);
  EXPECT_NEAR(share(points, [](double, double y) { return std::fabs(y) < 1; }), 0.6827, 0.01);
  EXPECT_NEAR(share(points, [](double x, double y) { return x * x + y * y < 1; }), 1 - std::exp(-0.5), 0.01);
  EXPECT_NEAR(share(points, [](double x, double y) { return x > 0 && y > 0; }), 0.25, 0.01);
}

TEST(Generate, KuzminHasItsRadialDistribution) {
  const Points points = generate("kuzmin", 40000, 3);
  for (const double r : {0.5, 1.0, std::sqrt(3.0), 10.0, 100.0}) {
    EXPECT_NEAR(share(points, [r](double x, double y) { return std::hypot(x, y) < r; }),
                1 - 1 / std::sqrt(1 + r * r), 0.012);
  }
  EXPECT_NEAR(share(points, [](double x, double y) { return x > 0 && y > 0; }), 0.25, 0.01);
}

TEST(Generate, LineClustersAtItsLine) {
  const Points points = generate("line", 40000, 3);
  constexpr double b = 0.001;
  EXPECT_EQ(share(points, [](double x, double y) { return x >= b && x <= 1 && y >= 0 && y < 1; }), 1);
  // x < b / (u - b u + b) with probability 1 - u.
  for (const double u : {0.1, 0.5, 0.9}) {
    EXPECT_NEAR(share(points, [u](double x, double) { return x < b / (u - b * u + b); }), 1 - u, 0.012);
  }
  EXPECT_NEAR(share(points, [](double, double y) { return y < 0.5; }), 0.5, 0.012);
}

TEST(Generate, GridGoesRowByRow) {
  const Points points = generate("grid", 11, 0);  // 4 wide
  for (std::size_t i = 0; i < 11; ++i) EXPECT_EQ(point(points, i), Pair(i % 4, i / 4)) << i;
  const Points square = generate("grid", 1000000, 0);
  EXPECT_EQ(point(square, 999999), Pair(999, 999));
}

TEST(Generate, LatticesHaveTheirDistances) {
  const Points turned = generate("rotated-grid", 100, 0), hexagonal = generate("hexagonal", 100, 0);
  const auto distance = [](Pair p, Pair q) { return std::hypot(p.first - q.first, p.second - q.second); };
  for (const std::size_t i : {0, 12, 55, 88}) {
    for (const std::size_t step : {1, 10}) {
      EXPECT_NEAR(distance(point(turned, i), point(turned, i + step)), 1, 1e-14);
      EXPECT_NEAR(distance(point(hexagonal, i), point(hexagonal, i + step)), 1, 1e-14);
    }
  }
  EXPECT_NEAR(point(turned, 1).second / point(turned, 1).first, 1.0 / 3, 1e-15);
}

TEST(Generate, CirclesAreRoundToTheLastBits) {
  const Points points = generate("circle", 5000, 3);
  EXPECT_EQ(share(points, [](double x, double y) { return std::fabs(std::hypot(x, y) - 1) < 4e-16; }), 1);
  EXPECT_EQ(distinct(points).size(), 5000u);
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Pair p = point(points, i), q = point(points, i + 1);
    ASSERT_NEAR(p.first * q.second - p.second * q.first, std::sin(2 * std::acos(-1.0) / 5000), 1e-14) << i;
  }
  const Points nested = generate("nested-circles", 5000, 3);
  std::set<long long> radii;
  for (std::size_t i = 0; i < nested.size(); ++i) {
    const Pair p = point(nested, i);
    radii.insert(std::llround(std::hypot(p.first, p.second) * 1e12));
  }
  EXPECT_EQ(radii.size(), 18u);  // sqrt(5000) / 4 + 1
  EXPECT_EQ(distinct(nested).size(), 5000u);
}

TEST(Generate, IntegerCircleIsExactlyCocircular) {
  for (const std::size_t n : {4, 5, 16, 100, 3000, 36864}) {
    const Points points = generate("integer-circle", n, 7);
    EXPECT_EQ(distinct(points).size(), n);
    EXPECT_EQ(share(points, [](double x, double y) { return x == std::rint(x) && y == std::rint(y); }), 1);
    const __int128 radius = squared_radius(point(points, 0));
    for (std::size_t i = 1; i < n; ++i)
      ASSERT_TRUE(squared_radius(point(points, i)) == radius) << n << " " << i;
  }
}

TEST(Generate, IntegerCircleOffersFurtherCircles) {
  const Points points = generate("integer-circle", 100000, 7);
  EXPECT_EQ(distinct(points).size(), 100000u);
  std::map<__int128, std::size_t> on_circle;
  for (std::size_t i = 0; i < points.size(); ++i) ++on_circle[squared_radius(point(points, i))];
  ASSERT_EQ(on_circle.size(), 3u);
  EXPECT_EQ(on_circle.begin()->second, 36864u);
  EXPECT_EQ(on_circle.rbegin()->second, 100000u - 2 * 36864u);
}

TEST(Generate, ColumnsAreEightAndWithoutDuplicates) {
  const Points points = generate("columns", 2000, 3);
  std::set<double> x;
  for (std::size_t i = 0; i < points.size(); ++i) x.insert(point(points, i).first);
  EXPECT_EQ(x.size(), 8u);
  EXPECT_EQ(distinct(points).size(), 2000u);
  EXPECT_EQ(share(points, [](double, double y) { return y == std::rint(y); }), 1);
}

TEST(Generate, DuplicatesAreAsManyAsPromised) {
  EXPECT_EQ(distinct(generate("half-duplicates", 1001, 3)).size(), 501u);
  const Points small = generate("small-integers", 10000, 3);
  EXPECT_EQ(share(small,
                  [](double x, double y) {
                    return x >= 0 && x < 52 && y >= 0 && y < 52 && x == std::rint(x) && y == std::rint(y);
                  }),
            1);
  EXPECT_LE(distinct(small).size(), 52u * 52u);
  EXPECT_GT(distinct(small).size(), 52u * 45u);
}

TEST(Generate, CollinearAndParabolaAreExact) {
  const Points line = generate("collinear", 1000, 3);
  EXPECT_EQ(share(line, [](double x, double y) { return y == 3 * x && x == std::rint(x); }), 1);
  EXPECT_GT(distinct(line).size(), 800u);

  const Points parabola = generate("parabola", 1001, 3);
  EXPECT_EQ(distinct(parabola).size(), 1001u);
  for (std::size_t i = 0; i < parabola.size(); ++i) {
    // In multiples of 2^-9 and 2^-18 both are integers.
    const auto [x, y] = point(parabola, i);
    const double integer = x * 512;
    ASSERT_EQ(integer, std::rint(integer)) << i;
    ASSERT_EQ(y * 512 * 512, integer * integer) << i;
    ASSERT_LE(std::fabs(x), 1) << i;
  }
}

TEST(Generate, HorizontalIsOneLine) {
  const Points points = generate("horizontal", 1000, 3);
  EXPECT_EQ(share(points, [](double x, double y) { return y == 7 && x == std::rint(x); }), 1);
  EXPECT_GT(distinct(points).size(), 800u);
}

/// The number of lines through two of the points that hold at least so many of the distinct ones.
std::size_t lines_with(const Points& points, std::size_t least) {
  const std::set<Pair> set = distinct(points);
  const std::vector<Pair> all(set.begin(), set.end());
  std::set<std::set<Pair>> lines;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::map<std::pair<long, long>, std::set<Pair>> by_direction;
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (j == i) continue;
      long x = std::lround(all[j].first - all[i].first), y = std::lround(all[j].second - all[i].second);
      const long divisor = (x < 0 || (x == 0 && y < 0) ? -1 : 1) * std::gcd(x, y);
      by_direction[{x / divisor, y / divisor}].insert(all[j]);
    }
    for (auto& [direction, line] : by_direction) {
      line.insert(all[i]);
      if (line.size() >= least) lines.insert(line);
    }
  }
  return lines.size();
}

TEST(Generate, ThirtyLinesAreExactlyThirty) {
  EXPECT_EQ(lines_with(generate("thirty-lines", 600, 3), 8), 30u);
}

TEST(Generate, PowerOfTwoSpanIsExact) {
  for (const std::size_t n : {2, 1000, 100000}) {
    const Points points = generate("power-of-two-span", n, 3);
    const auto [low, high] = std::minmax_element(points.coordinates.begin(), points.coordinates.end());
    int exponent;
    EXPECT_EQ(*low, 0) << n;
    EXPECT_EQ(std::frexp(*high, &exponent), 0.5) << n;
    EXPECT_GT(distinct(points).size(), n * 9 / 10);
    EXPECT_EQ(share(points, [](double x, double y) { return x == std::rint(x) && y == std::rint(y); }), 1);
  }
}

TEST(Generate, OneUlpIsRoundingErrorsWide) {
  const Points points = generate("one-ulp", 10000, 3);
  const auto within = [](double v) { return v >= 1 && v < 1 + 52 * 0x1p-52; };
  EXPECT_EQ(share(points, [&](double x, double y) { return within(x) && within(y); }), 1);
  EXPECT_EQ(distinct(points).size(), distinct(generate("small-integers", 10000, 3)).size());
}

TEST(Generate, MostlyEqualHasFewOthers) {
  for (const std::size_t n : {100, 1003, 100000}) {
    const std::size_t others = distinct(generate("mostly-equal", n, 3)).size() - 1;
    EXPECT_GE(others, 9u) << n;
    EXPECT_LE(others, 10u) << n;
  }
}

TEST(Generate, TwoClustersAreFarApart) {
  const Points points = generate("two-clusters", 10000, 3);
  const auto near = [](double x, double y, double center) { return std::hypot(x - center, y - center) < 8; };
  EXPECT_EQ(share(points, [&](double x, double y) { return near(x, y, 0) || near(x, y, 1e9); }), 1);
  EXPECT_NEAR(share(points, [&](double x, double y) { return near(x, y, 0); }), 0.5, 0.02);
}

TEST(Generate, ClustersDifferInSizeByOrders) {
  const Points points = generate("clusters", 12000, 3);
  // The distance to the nearest of a few neighbours in the order along x tells how dense a point's place is.
  std::vector<Pair> sorted;
  for (std::size_t i = 0; i < points.size(); ++i) sorted.push_back(point(points, i));
  std::sort(sorted.begin(), sorted.end());
  std::vector<double> nearest;
  for (std::size_t i = 20; i + 20 < sorted.size(); ++i) {
    double least = INFINITY;
    for (std::size_t j = i - 20; j <= i + 20; ++j) {
      if (j == i) continue;
      least =
          std::min(least, std::hypot(sorted[i].first - sorted[j].first, sorted[i].second - sorted[j].second));
    }
    nearest.push_back(least);
  }
  std::sort(nearest.begin(), nearest.end());
  EXPECT_GT(nearest[nearest.size() * 19 / 20] / nearest[nearest.size() / 20], 1e4);
}

TEST(Generate, SpiralFillsTheDiskEvenly) {
  const Points points = generate("spiral", 10000, 3);
  EXPECT_NEAR(share(points, [](double x, double y) { return std::hypot(x, y) < 0.5; }), 0.25, 0.001);
  EXPECT_EQ(share(points, [](double x, double y) { return std::hypot(x, y) < 1; }), 1);
  EXPECT_NEAR(share(points, [](double x, double y) { return x > 0 && y > 0; }), 0.25, 0.01);
}

}  // namespace
}  // namespace flaunay::io
