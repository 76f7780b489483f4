// Regular triangulations against rational arithmetic and brute force.
#include "flaunay/weighted.hpp"

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/support/fixtures.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::weighted {
namespace {

using Numbers = std::vector<double>;
using Ids = std::vector<std::int32_t>;

struct WeightedPoints {
  std::string name;
  Numbers coordinates, weights;

  std::size_t size() const { return weights.size(); }
  void add(double x, double y, double weight) {
    coordinates.insert(coordinates.end(), {x, y});
    weights.push_back(weight);
  }
};

struct Exact {
  mpq_class x, y, lift;
};

std::vector<Exact> exactly(const WeightedPoints& points) {
  std::vector<Exact> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const mpq_class x = points.coordinates[2 * i], y = points.coordinates[2 * i + 1];
    all.push_back({x, y, x * x + y * y - mpq_class(points.weights[i])});
  }
  return all;
}

int orient(const Exact& a, const Exact& b, const Exact& c) {
  const mpq_class det = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  return sgn(det);
}

/// Of a, b, c counter-clockwise: 1 if d is below their plane, -1 if above.
int below(const Exact& a, const Exact& b, const Exact& c, const Exact& d) {
  const auto row = [&](const Exact& p) {
    return std::array<mpq_class, 3>{p.x - d.x, p.y - d.y, p.lift - d.lift};
  };
  const auto p = row(a), q = row(b), r = row(c);
  const mpq_class det = p[2] * (q[0] * r[1] - q[1] * r[0]) - q[2] * (p[0] * r[1] - p[1] * r[0]) +
                        r[2] * (p[0] * q[1] - p[1] * q[0]);
  return sgn(det);
}

/// Whether others in its place, on a line with it or around it hide a point.
bool is_hidden(const std::vector<Exact>& all, std::size_t v) {
  const std::size_t n = all.size();
  const Exact& p = all[v];
  for (std::size_t a = 0; a < n; ++a) {
    const Exact& pa = all[a];
    if (pa.x == p.x && pa.y == p.y && pa.lift < p.lift) return true;
    if (a == v || (pa.x == p.x && pa.y == p.y)) continue;
    for (std::size_t b = 0; b < n; ++b) {
      const Exact& pb = all[b];
      const mpq_class dot = (pa.x - p.x) * (pb.x - p.x) + (pa.y - p.y) * (pb.y - p.y);
      if (a < b && orient(pa, p, pb) == 0 && dot < 0) {
        const mpq_class ta = abs(pa.x - p.x) + abs(pa.y - p.y), tb = abs(pb.x - p.x) + abs(pb.y - p.y);
        if (pa.lift * tb + pb.lift * ta <= p.lift * (ta + tb)) return true;
      }
      if (orient(pa, pb, p) <= 0) continue;
      for (std::size_t c = a + 1; c < n; ++c) {
        if (b > a && orient(pb, all[c], p) > 0 && orient(all[c], pa, p) > 0 && below(pa, pb, all[c], p) <= 0)
          return true;
      }
    }
  }
  return false;
}

/// That triangles are counter-clockwise and lie below all points, that they are as many as there must be, and
/// that everything else belongs to them.
void expect_regular(const WeightedPoints& points, const WeightedTriangulation& mesh, bool by_brute_force) {
  SCOPED_TRACE(points.name);
  const std::vector<Exact> all = exactly(points);
  const std::size_t n = points.size();
  std::map<std::array<double, 3>, std::int32_t> first;
  std::vector<Exact> different;
  Ids numbers;
  for (std::size_t i = 0; i < n; ++i) {
    const std::array<double, 3> key = {points.coordinates[2 * i], points.coordinates[2 * i + 1],
                                       points.weights[i]};
    const auto [at, is_new] = first.insert({key, static_cast<std::int32_t>(i)});
    if (is_new) {
      different.push_back(all[i]);
      numbers.push_back(at->second);
    }
  }
  ASSERT_TRUE(std::is_sorted(mesh.hidden.begin(), mesh.hidden.end()));
  std::set<std::int32_t> hidden(mesh.hidden.begin(), mesh.hidden.end());
  std::set<std::int32_t> vertices(mesh.hull.begin(), mesh.hull.end());
  vertices.insert(mesh.triangles.begin(), mesh.triangles.end());
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    ASSERT_NE(hidden.count(numbers[k]), vertices.count(numbers[k])) << numbers[k];
    if (by_brute_force) ASSERT_EQ(hidden.count(numbers[k]), is_hidden(different, k)) << numbers[k];
  }
  ASSERT_EQ(mesh.statistics.triangles, mesh.triangles.size() / 3);
  ASSERT_EQ(mesh.neighbors.size(), mesh.triangles.size());
  if (!mesh.triangles.empty()) {
    ASSERT_EQ(mesh.triangles.size() / 3, 2 * vertices.size() - 2 - mesh.hull.size());
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    const Exact &a = all[mesh.triangles[t]], &b = all[mesh.triangles[t + 1]], &c = all[mesh.triangles[t + 2]];
    ASSERT_GT(orient(a, b, c), 0);
    for (const Exact& p : different) ASSERT_LE(below(a, b, c, p), 0);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t other = mesh.neighbors[t + k];
      if (other < 0) continue;
      std::set<std::int32_t> shared(&mesh.triangles[t], &mesh.triangles[t] + 3);
      shared.erase(mesh.triangles[t + k]);
      for (int m = 0; m < 3; ++m) shared.erase(mesh.triangles[3 * static_cast<std::size_t>(other) + m]);
      ASSERT_TRUE(shared.empty());
    }
  }
}

std::set<std::array<std::int32_t, 3>> triangle_set(const Ids& triangles, const Ids& numbers) {
  std::set<std::array<std::int32_t, 3>> set;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    std::array<std::int32_t, 3> row = {numbers[triangles[t]], numbers[triangles[t + 1]],
                                       numbers[triangles[t + 2]]};
    std::rotate(row.begin(), std::min_element(row.begin(), row.end()), row.end());
    set.insert(row);
  }
  return set;
}

WeightedTriangulation triangulated(Triangulator& triangulator, const WeightedPoints& points) {
  Options options;
  options.neighbors = true;
  return triangulate_weighted(triangulator, points.coordinates.data(), points.weights.data(), points.size(),
                              options);
}

/// Small integers, so that many are in one place, on a line, or on one plane when they are lifted.
WeightedPoints lattice_points(std::mt19937& random, std::size_t n, int size, int weights) {
  WeightedPoints points{
      "lattice of " + std::to_string(n) + ", " + std::to_string(size) + ", " + std::to_string(weights),
      {},
      {}};
  std::uniform_int_distribution<int> place(0, size), weight(-weights, weights);
  for (std::size_t i = 0; i < n; ++i) points.add(place(random), place(random), weight(random));
  return points;
}

WeightedPoints random_points(std::mt19937& random, std::size_t n, double share) {
  WeightedPoints points{"random", {}, {}};
  std::uniform_real_distribution<double> unit(0, 1);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = unit(random), y = unit(random);
    points.add(x, y, unit(random) * share / static_cast<double>(n));
  }
  return points;
}

class WeightedTest : public ::testing::Test {
 protected:
  Triangulator& triangulator_ = testing::triangulator();
};

TEST_F(WeightedTest, SmallSetsAreAsByBruteForce) {
  std::mt19937 random(1);
  for (int round = 0; round < 1500; ++round) {
    const std::size_t n = 1 + random() % 12;
    const int size = 1 + static_cast<int>(random() % 6);
    const WeightedPoints points =
        lattice_points(random, n, size, static_cast<int>(random() % (2 * size * size + 1)));
    expect_regular(points, triangulated(triangulator_, points), true);
    if (HasFatalFailure()) {
      for (std::size_t i = 0; i < n; ++i)
        ADD_FAILURE() << points.coordinates[2 * i] << " " << points.coordinates[2 * i + 1] << " "
                      << points.weights[i];
      return;
    }
  }
}

TEST_F(WeightedTest, AnyOrderAndAnyBlocksGiveOneResult) {
  std::mt19937 random(2);
  Triangulator& small_blocks = testing::triangulator_with("block_points=8");
  for (int round = 0; round < 150; ++round) {
    const std::size_t n = 20 + random() % 80;
    const int size = 2 + static_cast<int>(random() % 20);
    WeightedPoints points = round % 3 == 0
                                ? random_points(random, n, 0.1 * static_cast<double>(random() % 100))
                                : lattice_points(random, n, size, static_cast<int>(random() % (size * size)));
    const WeightedTriangulation mesh = triangulated(triangulator_, points);
    if (round % 5 == 0) expect_regular(points, mesh, false);
    Ids numbers(n);
    std::iota(numbers.begin(), numbers.end(), 0);
    const auto expected = triangle_set(mesh.triangles, mesh.representatives);
    std::shuffle(numbers.begin(), numbers.end(), random);
    WeightedPoints shuffled{"shuffled", {}, {}};
    Ids names;
    for (const std::int32_t i : numbers) {
      shuffled.add(points.coordinates[2 * i], points.coordinates[2 * i + 1], points.weights[i]);
      names.push_back(mesh.representatives[i]);
    }
    const WeightedTriangulation other = triangulated(small_blocks, shuffled);
    ASSERT_EQ(triangle_set(other.triangles, names), expected) << points.name;
    ASSERT_EQ(other.hull.size(), mesh.hull.size());
    if (HasFatalFailure()) return;
  }
}

TEST_F(WeightedTest, EqualWeightsGiveTheBytesOfTheDelaunayTriangulation) {
  std::mt19937 random(3);
  Options options;
  options.neighbors = options.halfedges = options.areas = true;
  for (const double weight : {0.0, -3.5, 0x1p40}) {
    for (const std::size_t n : {0, 1, 2, 3, 50, 5000}) {
      for (const int size : {3, 60, 1'000'000}) {
        const WeightedPoints points = lattice_points(random, n, size, 0);
        const Numbers weights(n, weight);
        const WeightedTriangulation mesh =
            triangulate_weighted(triangulator_, points.coordinates.data(), weights.data(), n, options);
        const Triangulation plain = triangulator_.triangulate(points.coordinates.data(), n, options);
        EXPECT_EQ(mesh.triangles, plain.triangles);
        EXPECT_EQ(mesh.neighbors, plain.neighbors);
        EXPECT_EQ(mesh.halfedges, plain.halfedges);
        EXPECT_EQ(mesh.hull, plain.hull);
        EXPECT_EQ(mesh.representatives, plain.representatives);
        EXPECT_EQ(mesh.areas, plain.areas);
        EXPECT_EQ(mesh.triangle_offsets, plain.triangle_offsets);
        EXPECT_EQ(mesh.hull_offsets, plain.hull_offsets);
        EXPECT_TRUE(mesh.hidden.empty());
      }
    }
  }
}

}  // namespace
}  // namespace flaunay::weighted
