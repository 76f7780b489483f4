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
#include <random>
#include <set>
#include <string>
#include <vector>

#include "flaunay/verify.hpp"
#include "predicates/power.h"
#include "tests/support/errors.hpp"
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
void expect_regular(const WeightedPoints& points, const Triangulation& mesh, bool by_brute_force) {
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
    ASSERT_EQ(mesh.representatives[i], at->second);
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
    if (!by_brute_force) continue;
    ASSERT_EQ(hidden.count(numbers[k]), is_hidden(different, k)) << numbers[k];
  }
  ASSERT_EQ(
      verify(points.coordinates.data(), {0, n}, Space::plane().with_weights(points.weights.data()), mesh),
      "");
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

Triangulation triangulated(Triangulator& triangulator, const WeightedPoints& points) {
  Options options;
  options.neighbors = true;
  return triangulator.triangulate(points.coordinates.data(), points.size(),
                                  Space::plane().with_weights(points.weights.data()), options);
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

TEST_F(WeightedTest, FewPointsAreAsByBruteForce) {
  std::mt19937 random(1);
  for (int round = 0; round < 700; ++round) {
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

TEST_F(WeightedTest, EqualWeightsGiveTheBytesOfTheDelaunayTriangulation) {
  std::mt19937 random(3);
  Options options;
  options.neighbors = options.halfedges = options.areas = true;
  for (const double weight : {0.0, -3.5, 0x1p40}) {
    for (const std::size_t n : {0, 1, 2, 3, 50, 5000}) {
      for (const int size : {3, 60, 1'000'000}) {
        const WeightedPoints points = lattice_points(random, n, size, 0);
        const Numbers weights(n, weight);
        const Triangulation mesh = triangulator_.triangulate(
            points.coordinates.data(), n, Space::plane().with_weights(weights.data()), options);
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

TEST_F(WeightedTest, PredicatesAgreeWithRationalArithmetic) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 4000; ++round) {
    // Lifted points near one plane, or on it: with coordinates of few bits or of many.
    const double grid = round % 2 == 0 ? 0x1p-6 : 0x1p-50;
    const auto coordinate = [&] { return std::round(unit(random) / grid) * grid; };
    const double slope = coordinate(), scale = std::ldexp(1.0, static_cast<int>(random() % 200) - 100);
    WeightedPoints points{"near a plane", {}, {}};
    for (int k = 0; k < 4; ++k) {
      const double x = coordinate(), y = coordinate();
      double weight = x * x + y * y - slope * x + y;
      if (random() % 3 == 0) weight += std::ldexp(unit(random), -static_cast<int>(random() % 80));
      points.add(x * scale, y * scale, weight * scale * scale);
    }
    std::vector<Exact> all = exactly(points);
    std::array<int, 3> corners = {0, 1, 2};
    if (orient(all[0], all[1], all[2]) < 0) std::swap(corners[1], corners[2]);
    if (orient(all[corners[0]], all[corners[1]], all[corners[2]]) == 0) continue;
    const auto weighted = [&](std::size_t i) {
      return kernel::weighted_point{{points.coordinates[2 * i], points.coordinates[2 * i + 1]},
                                    points.weights[i]};
    };
    const auto a = weighted(corners[0]), b = weighted(corners[1]), c = weighted(corners[2]), d = weighted(3);
    const int expected = below(all[corners[0]], all[corners[1]], all[corners[2]], all[3]);
    ASSERT_EQ(kernel::power_exact(a, b, c, d), expected);
    const int filtered = kernel::power_filtered(a, b, c, d);
    if (filtered != UNDECIDED) {
      ASSERT_EQ(filtered, expected);
    }
    // Three on a line, of which the lifts may be, too.
    const double step = coordinate(), rise = random() % 2 == 0 ? coordinate() : 0;
    if (step == 0) continue;
    WeightedPoints line{"line", {}, {}};
    for (const int k : {-1, 0, 3}) {
      const double x = k * step, y = k * rise;
      line.add(x, y, x * x + y * y - slope * x + (random() % 4 == 0 ? coordinate() * grid : 0));
    }
    const std::vector<Exact> three = exactly(line);
    const mpq_class sum = three[0].lift * 3 + three[2].lift - 4 * three[1].lift;
    const auto at = [&](std::size_t i) {
      return kernel::weighted_point{{line.coordinates[2 * i], line.coordinates[2 * i + 1]}, line.weights[i]};
    };
    ASSERT_EQ(kernel::is_hidden_between(at(0), at(1), at(2)), sgn(sum) <= 0);
    ASSERT_EQ(kernel::is_hidden_between(at(2), at(1), at(0)), sgn(sum) <= 0);
  }
}

TEST_F(WeightedTest, OnAPlaneOnlyCornersAreVertices) {
  WeightedPoints flat{"flat", {}, {}};
  for (int x = 0; x < 30; ++x) {
    for (int y = 0; y < 30; ++y) flat.add(x, y, x * x + y * y);
  }
  const Triangulation mesh = triangulated(triangulator_, flat);
  EXPECT_EQ(mesh.hull, (Ids{0, 29 * 30, 899, 29}));
  EXPECT_EQ(mesh.hidden.size(), 896u);
  expect_regular(flat, mesh, false);
  const Ids hiding = hiding_triangles(triangulator_, flat.coordinates.data(), {0, 900}, mesh);
  EXPECT_TRUE(std::all_of(hiding.begin(), hiding.end(), [](std::int32_t t) { return t == 0 || t == 1; }));
}

TEST_F(WeightedTest, OneHeavyPointHidesAllButTheHullBeyondIt) {
  std::mt19937 random(5);
  for (const double weight : {0.5, 100.0}) {
    WeightedPoints points = random_points(random, 1000, 0);
    points.add(0.5, 0.5, weight);
    const Triangulation mesh = triangulated(triangulator_, points);
    expect_regular(points, mesh, false);
    EXPECT_GT(mesh.hidden.size(), 500u);
    EXPECT_EQ(std::count(mesh.hidden.begin(), mesh.hidden.end(), 1000), 0);
  }
}

TEST_F(WeightedTest, PointsAreHiddenByTheirSets) {
  std::mt19937 random(6);
  WeightedPoints all{"sets", {}, {}};
  std::vector<std::size_t> offsets = {0};
  std::vector<WeightedPoints> sets;
  for (int s = 0; s < 60; ++s) {
    const std::size_t n = random() % 40;
    sets.push_back(s % 2 == 0 ? lattice_points(random, n, 6, 12) : random_points(random, n, 2));
    for (std::size_t i = 0; i < n; ++i) {
      all.add(sets.back().coordinates[2 * i], sets.back().coordinates[2 * i + 1], sets.back().weights[i]);
    }
    offsets.push_back(all.size());
  }
  Options options;
  options.neighbors = true;
  const Triangulation mesh = triangulator_.triangulate(
      all.coordinates.data(), offsets, Space::plane().with_weights(all.weights.data()), options);
  const Ids hiding = hiding_triangles(triangulator_, all.coordinates.data(), offsets, mesh);
  std::size_t hidden = 0;
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const Triangulation own = triangulated(triangulator_, sets[s]);
    const auto first = static_cast<std::int32_t>(offsets[s]);
    ASSERT_EQ(mesh.hull_offsets[s + 1] - mesh.hull_offsets[s], own.hull.size());
    const Ids own_hiding =
        hiding_triangles(triangulator_, sets[s].coordinates.data(), {0, sets[s].size()}, own);
    for (std::size_t k = 0; k < own.hidden.size(); ++k, ++hidden) {
      ASSERT_EQ(mesh.hidden[hidden], own.hidden[k] + first);
      const auto shift = static_cast<std::int32_t>(mesh.triangle_offsets[s]);
      ASSERT_EQ(hiding[hidden], own_hiding[k] < 0 ? -1 : own_hiding[k] + shift);
    }
  }
  EXPECT_EQ(hidden, mesh.hidden.size());
  EXPECT_GT(hidden, 100u);
}

TEST_F(WeightedTest, TheTriangleThatHidesAPointHasItBelow) {
  std::mt19937 random(7);
  for (const WeightedPoints& points : {random_points(random, 500, 3), lattice_points(random, 300, 12, 40)}) {
    const Triangulation mesh = triangulated(triangulator_, points);
    const Ids hiding = hiding_triangles(triangulator_, points.coordinates.data(), {0, points.size()}, mesh);
    const std::vector<Exact> all = exactly(points);
    ASSERT_EQ(hiding.size(), mesh.hidden.size());
    ASSERT_GT(hiding.size(), 50u);
    for (std::size_t k = 0; k < hiding.size(); ++k) {
      ASSERT_GE(hiding[k], 0);
      const std::int32_t* const t = &mesh.triangles[3 * static_cast<std::size_t>(hiding[k])];
      const Exact& p = all[mesh.hidden[k]];
      for (int c = 0; c < 3; ++c) ASSERT_GE(orient(all[t[c]], all[t[(c + 1) % 3]], p), 0);
      ASSERT_LE(below(all[t[0]], all[t[1]], all[t[2]], p), 0);
    }
  }
}

TEST_F(WeightedTest, VerificationFindsWhatIsWrong) {
  std::mt19937 random(9);
  const auto problem = [&](const WeightedPoints& points, const Triangulation& mesh) {
    return verify(points.coordinates.data(), {0, points.size()},
                  Space::plane().with_weights(points.weights.data()), mesh);
  };
  for (int round = 0; round < 60; ++round) {
    const WeightedPoints points =
        round % 2 == 0 ? random_points(random, 60, 2) : lattice_points(random, 50, 6, 9);
    const Triangulation good = triangulated(triangulator_, points);
    ASSERT_EQ(problem(points, good), "");
    // Another weight of a vertex hides it or, if it is greater, hides others or moves edges.
    WeightedPoints other = points;
    other.weights[good.triangles[0]] += round % 4 < 2 ? 50 : -50;
    const auto v = static_cast<std::size_t>(good.triangles[0]);
    if (std::find(good.hull.begin(), good.hull.end(), good.triangles[0]) == good.hull.end()) {
      ASSERT_NE(problem(other, good), "") << v;
    }
    Triangulation bad = good;
    std::swap(bad.triangles[1], bad.triangles[2]);
    ASSERT_NE(problem(points, bad), "");
    bad = good;
    bad.neighbors[static_cast<std::size_t>(random() % bad.neighbors.size())] = 0;
    if (bad.neighbors != good.neighbors) {
      ASSERT_NE(problem(points, bad), "");
    }
    bad = good;
    if (!bad.hidden.empty()) {
      bad.hidden.pop_back();
      ASSERT_NE(problem(points, bad), "");
      bad.hidden = good.hidden;
      bad.representatives[static_cast<std::size_t>(bad.hidden[0])] = bad.triangles[0];
      ASSERT_NE(problem(points, bad), "");
    }
    bad = good;
    bad.hidden.insert(std::lower_bound(bad.hidden.begin(), bad.hidden.end(), bad.hull[0]), bad.hull[0]);
    ASSERT_NE(problem(points, bad), "");
    bad = good;
    std::rotate(bad.hull.begin(), bad.hull.begin() + 1, bad.hull.end());
    bad.hull.pop_back();
    --bad.hull_offsets[1];
    ASSERT_NE(problem(points, bad), "");
  }
  // One of two diagonals, which weights alone tell apart.
  const WeightedPoints square{"square", {0, 0, 2, 0, 2, 2, 0, 2}, {0, 1, 0, 1}};
  Triangulation mesh = triangulated(triangulator_, square);
  ASSERT_EQ(mesh.triangles, (Ids{0, 1, 3, 1, 2, 3}));
  ASSERT_EQ(problem(square, mesh), "");
  WeightedPoints turned = square;
  turned.weights = {1, 0, 1, 0};
  EXPECT_NE(problem(turned, mesh).find("is not regular"), std::string::npos);
  // Equal weights: the fan from the first point is the other one.
  turned.weights = {0, 0, 0, 0};
  EXPECT_NE(problem(turned, mesh).find("is not regular"), std::string::npos);
}

TEST_F(WeightedTest, CellsAreWhereThePowerIsLeast) {
  std::mt19937 random(8);
  const Numbers corners = {-0.5, -0.25, 1.5, -0.25, 1.25, 1.5, 0, 1.25};
  const double area = 0.5 * ((-0.5 * -0.25 - 1.5 * -0.25) + (1.5 * 1.5 - 1.25 * -0.25) +
                             (1.25 * 1.25 - 0 * 1.5) + (0 * -0.25 - -0.5 * 1.25));
  for (const double share : {0.0, 2.5}) {
    const WeightedPoints points = random_points(random, 200, share);
    const Triangulation mesh = triangulated(triangulator_, points);
    const ClippedVoronoi cells =
        triangulator_.clipped_voronoi(points.coordinates.data(), points.weights.data(), points.size(), mesh,
                                      corners.data(), corners.size() / 2);
    EXPECT_NEAR(std::accumulate(cells.areas.begin(), cells.areas.end(), 0.0), area, 1e-12);
    const auto power = [&](std::size_t i, double x, double y) {
      const double dx = points.coordinates[2 * i] - x, dy = points.coordinates[2 * i + 1] - y;
      return dx * dx + dy * dy - points.weights[i];
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      const bool is_hidden = std::binary_search(mesh.hidden.begin(), mesh.hidden.end(), i);
      // Cells may also lie beside the polygon.
      const bool has_cell = cells.areas[i] > 0;
      ASSERT_FALSE(has_cell && is_hidden);
      ASSERT_EQ(cells.offsets[i] < cells.offsets[i + 1], has_cell);
      if (!has_cell) {
        ASSERT_TRUE(std::isnan(cells.centroids[2 * i]));
        continue;
      }
      for (std::size_t j = 0; j < points.size(); ++j) {
        ASSERT_LE(power(i, cells.centroids[2 * i], cells.centroids[2 * i + 1]),
                  power(j, cells.centroids[2 * i], cells.centroids[2 * i + 1]) + 1e-12);
        for (std::int32_t v = cells.offsets[i]; v < cells.offsets[i + 1]; ++v) {
          ASSERT_LE(power(i, cells.vertices[2 * v], cells.vertices[2 * v + 1]),
                    power(j, cells.vertices[2 * v], cells.vertices[2 * v + 1]) + 1e-12);
        }
      }
    }
    if (share > 0) continue;
    const Triangulation plain = triangulator_.triangulate(points.coordinates.data(), points.size());
    const ClippedVoronoi voronoi = triangulator_.clipped_voronoi(points.coordinates.data(), points.size(),
                                                                 plain, corners.data(), corners.size() / 2);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_NEAR(cells.areas[i], voronoi.areas[i], 1e-13);
  }
}

TEST_F(WeightedTest, CellsOfPointsOnALine) {
  const Numbers points = {0, 0, 2, 0, 1, 0, 2, 0}, weights = {0, 0, -5, 1},
                corners = {-1, -1, 4, -1, 4, 1, -1, 1};
  const Triangulation mesh =
      triangulator_.triangulate(points.data(), 4, Space::plane().with_weights(weights.data()));
  EXPECT_EQ(mesh.hull, (Ids{0, 3}));
  EXPECT_EQ(mesh.hidden, (Ids{1, 2}));
  EXPECT_EQ(mesh.representatives, (Ids{0, 1, 2, 3}));
  EXPECT_EQ(hiding_triangles(triangulator_, points.data(), {0, 4}, mesh), (Ids{-1, -1}));
  const ClippedVoronoi cells =
      triangulator_.clipped_voronoi(points.data(), weights.data(), 4, mesh, corners.data(), 4);
  EXPECT_EQ(cells.areas, (Numbers{3.5, 0, 0, 6.5}));
}

TEST_F(WeightedTest, DuplicatesAreOfPlaceAndWeight) {
  const Numbers points = {0, 0, 4, 0, 0, 4, 0, 0, 0, 0, 4, 0, 0, 0}, weights = {1, 1, 1, 2, 2, 1, 1};
  const Triangulation mesh =
      triangulator_.triangulate(points.data(), 7, Space::plane().with_weights(weights.data()));
  EXPECT_EQ(mesh.representatives, (Ids{0, 1, 2, 3, 3, 1, 0}));
  EXPECT_EQ(mesh.hidden, (Ids{0}));
  EXPECT_EQ(mesh.triangles, (Ids{1, 2, 3}));
  EXPECT_EQ(mesh.statistics.duplicates, 3u);
}

// Also where no point is hidden, regular triangles are not taken for Delaunay ones: the lifts of points 0 and
// 2 are low, so that these are joined, though 1 and 3 are nearer to each other.
TEST_F(WeightedTest, MeshesSayThatTheyHaveWeights) {
  const Numbers points = {0, 0, 4, -1, 8, 0, 4, 1}, weights = {20, 0, 20, 0},
                box = {0, -4.5, 8, -4.5, 8, 4.5, 0, 4.5};
  Options options;
  options.neighbors = true;
  const Triangulation mesh =
      triangulator_.triangulate(points.data(), 4, Space::plane().with_weights(weights.data()), options);
  EXPECT_EQ(mesh.triangles, (Ids{0, 1, 2, 0, 2, 3}));
  EXPECT_TRUE(mesh.hidden.empty() && mesh.is_weighted);
  EXPECT_FALSE(triangulator_.triangulate(points.data(), 4).is_weighted);
  const auto need_weights = [](const auto& call) {
    testing::expect_error(ErrorKind::usage, {"weights"}, call);
  };
  need_weights([&] { (void)triangulator_.voronoi(points.data(), 4, mesh); });
  need_weights([&] { (void)triangulator_.clipped_voronoi(points.data(), 4, mesh, box.data(), 4); });
  need_weights([&] { (void)verify(points.data(), {0, 4}, Space::plane(), mesh); });
  Triangulation made = mesh;
  made.is_weighted = false;
  made.hidden = {1};
  need_weights([&] { (void)triangulator_.voronoi(points.data(), 4, made); });
  need_weights([&] { (void)verify(points.data(), {0, 4}, Space::plane(), made); });
  // Power cells: those of 1 and 3 begin at (4, -2.5) and (4, 2.5).
  const ClippedVoronoi cells =
      triangulator_.clipped_voronoi(points.data(), weights.data(), 4, mesh, box.data(), 4);
  EXPECT_EQ(cells.areas, (Numbers{35, 1, 35, 1}));
  Locator locator(triangulator_, points.data(), 4, mesh);
  const Numbers query = {3, 0.25}, values = {0, 1, 2, 3};
  EXPECT_EQ(locator.locate(query.data(), 1), (Ids{1}));
  need_weights([&] { (void)locator.nearest(query.data(), 1); });
  need_weights([&] { (void)locator.natural_weights(query.data(), 1); });
  const Triangulation on_torus = triangulator_.triangulate(
      points.data(), 4, Space::torus({16, 16}).with_weights(weights.data()), options);
  EXPECT_TRUE(on_torus.hidden.empty());
  need_weights([&] { (void)triangulator_.clipped_voronoi(on_torus); });
  need_weights([&] { (void)Locator(triangulator_, on_torus); });
}

TEST_F(WeightedTest, WrongWeightsAreNamed) {
  const Numbers points = {0, 0, 1, 0, 0, 1};
  const auto with = [&](double weight) {
    const Numbers weights = {0, weight, 0};
    triangulator_.triangulate(points.data(), 3, Space::plane().with_weights(weights.data()));
  };
  testing::expect_error(ErrorKind::input, {"point 1 has a weight that is not finite"}, [&] { with(NAN); });
  testing::expect_error(ErrorKind::input, {"point 1 has a weight", "too large"}, [&] { with(1e300); });
  testing::expect_error(ErrorKind::input, {"point 1 has a weight", "too fine"}, [&] { with(1e-300); });
  with(0x1p490);
  const Numbers weights = {0, 1, 2};
  Options options;
  options.neighbors = false;
  const Triangulation mesh =
      triangulator_.triangulate(points.data(), 3, Space::plane().with_weights(weights.data()), options);
  testing::expect_error(ErrorKind::usage, {"neighbours"}, [&] {
    triangulator_.clipped_voronoi(points.data(), weights.data(), 3, mesh, points.data(), 3);
  });
  testing::expect_error(ErrorKind::usage, {"not one of these points"}, [&] {
    triangulator_.clipped_voronoi(points.data(), weights.data(), 2, mesh, points.data(), 3);
  });
}

}  // namespace
}  // namespace flaunay::weighted
