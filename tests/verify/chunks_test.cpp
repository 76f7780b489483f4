// The check in chunks must agree with the one in memory, however small its windows and ranges are.
#include "app/verify/chunks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>

#include "app/files/generate.hpp"
#include "app/verify/external_sort.hpp"
#include "app/verify/vertex_index.hpp"
#include "flaunay/research.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/reference.hpp"

namespace flaunay {
namespace {

using testing::flat_triangles;
using testing::grid_points;
using testing::random_integer_points;
using testing::reference_delaunay;
using testing::reference_neighbors;

using Coordinates = std::vector<double>;
using Indices = std::vector<std::int32_t>;

class VectorPoints : public PointSource {
 public:
  explicit VectorPoints(const Coordinates& coordinates) : coordinates_(coordinates) {}
  std::uint64_t size() const override { return coordinates_.size() / 2; }
  void read(std::uint64_t first, std::size_t count, double* to) override {
    ASSERT_LE(first + count, size());
    std::copy_n(&coordinates_[2 * first], 2 * count, to);
  }

 private:
  const Coordinates& coordinates_;
};

class VectorRows : public io::RowSource {
 public:
  explicit VectorRows(const Indices& indices) : indices_(indices) {}
  std::uint64_t size() const override { return indices_.size() / 3; }
  void read(std::uint64_t first, std::size_t count, std::int64_t* to) override {
    ASSERT_LE(first + count, size());
    std::copy_n(&indices_[3 * first], 3 * count, to);
  }

 private:
  const Indices& indices_;
};

/// From everything at once to a row or two at a time.
std::vector<VerifySizes> many_sizes() {
  return {{1000000, 1000000, 1000000, 1 << 20, 1 << 16, 65536, 1},
          {40, 100, 1000, 2000, 128, 16, 2},
          {7, 13, 11, 300, 64, 5, 2},
          {1, 1, 1, 1, 1, 1, 1}};
}

VerifyChunksReport check(const Coordinates& coordinates, const Indices& triangles, const Indices* neighbors,
                         const VerifySizes& sizes) {
  VectorPoints points(coordinates);
  VectorRows rows(triangles);
  VectorRows neighbor_rows(neighbors != nullptr ? *neighbors : triangles);
  return verify_chunks(points, rows, neighbors != nullptr ? &neighbor_rows : nullptr, sizes);
}

/// Rows in another order, and the neighbours with them.
void shuffle_rows(Indices& triangles, std::uint64_t seed) {
  std::vector<std::size_t> order(triangles.size() / 3);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937_64(seed));
  Indices shuffled;
  for (const std::size_t t : order) {
    shuffled.insert(shuffled.end(), triangles.begin() + 3 * t, triangles.begin() + 3 * t + 3);
  }
  triangles = shuffled;
}

/// Both checks accept, and count the same.
void expect_accepted(const Coordinates& coordinates, const Indices& triangles, const Indices& neighbors) {
  const VerifyReport expected = verify(coordinates.data(), coordinates.size() / 2, triangles, neighbors);
  ASSERT_EQ(expected.problem, "");
  for (const VerifySizes& sizes : many_sizes()) {
    for (const Indices* with : {static_cast<const Indices*>(nullptr), &neighbors}) {
      const VerifyChunksReport report = check(coordinates, triangles, with, sizes);
      EXPECT_TRUE(report.ok) << report.problem;
      EXPECT_EQ(report.problem, "");
      EXPECT_EQ(report.points, expected.points);
      EXPECT_EQ(report.distinct_points, expected.distinct_points);
      EXPECT_EQ(report.triangles, expected.triangles);
      EXPECT_EQ(report.hull_vertices, expected.hull_vertices);
      EXPECT_EQ(report.cocircular_edges, expected.cocircular_edges);
      if (sizes.window_rows == 1) {
        EXPECT_EQ(report.windows, expected.triangles);
        EXPECT_EQ(2 * report.edges_across + report.hull_vertices,
                  expected.triangles ? 3 * expected.triangles : report.hull_vertices);
      }
    }
  }
}

/// Both checks reject.
void expect_rejected(const Coordinates& coordinates, const Indices& triangles, const Indices* neighbors,
                     const std::string& damage, const std::string& part_of_problem = "") {
  const std::size_t n = coordinates.size() / 2;
  const VerifyReport expected = neighbors != nullptr ? verify(coordinates.data(), n, triangles, *neighbors)
                                                     : verify(coordinates.data(), n, triangles);
  ASSERT_FALSE(expected.ok) << damage;
  for (const VerifySizes& sizes : many_sizes()) {
    const VerifyChunksReport report = check(coordinates, triangles, neighbors, sizes);
    EXPECT_FALSE(report.ok) << damage << ", windows of " << sizes.window_rows;
    EXPECT_NE(report.problem.find(part_of_problem), std::string::npos) << damage << ": " << report.problem;
  }
}

// ------------------------------------------------------------------------------------------------ the parts

TEST(VertexIndex, NumbersIdsInOrder) {
  std::mt19937_64 random(1);
  prove::VertexIndex index(5000);
  for (const std::uint64_t first : {std::uint64_t{0}, std::uint64_t{77}, std::uint64_t{1} << 40}) {
    for (const std::uint64_t count : {1, 63, 64, 383, 384, 385, 5000}) {
      std::set<std::uint64_t> expected;
      for (int i = 0; i < 700; ++i) expected.insert(first + random() % count);
      index.clear(first, count);
      for (const std::uint64_t id : expected) index.insert(id);
      EXPECT_EQ(index.enumerate(5), 5 + expected.size());
      std::vector<std::uint64_t> visited;
      index.for_each([&](std::uint64_t id) { visited.push_back(id); });
      EXPECT_EQ(visited, std::vector<std::uint64_t>(expected.begin(), expected.end()));
      std::uint32_t number = 5;
      for (std::uint64_t id = first; id < first + count; ++id) {
        ASSERT_EQ(index.contains(id), expected.count(id) == 1);
        if (index.contains(id)) {
          ASSERT_EQ(index.number(id), number++);
        }
      }
    }
  }
}

TEST(ExternalSorter, SortsWhatFitsAndWhatDoesNot) {
  std::mt19937_64 random(2);
  for (const std::size_t bytes : {1, 100, 1000, 100000}) {
    for (const std::size_t count : {0, 1, 2, 12, 13, 1000}) {
      prove::ExternalSorter<std::uint64_t, std::less<std::uint64_t>> sorter("", bytes);
      std::vector<std::uint64_t> values(count), sorted;
      for (std::uint64_t& value : values) value = random() % 500;
      for (std::size_t i = 0; i < count; i += 7) sorter.add(&values[i], std::min<std::size_t>(7, count - i));
      sorter.for_each([&](std::uint64_t value) { sorted.push_back(value); });
      std::sort(values.begin(), values.end());
      EXPECT_EQ(sorted, values) << bytes << " bytes";
      EXPECT_EQ(sorter.scratch_bytes() > 0, count > std::max<std::size_t>(2, bytes / 8));
    }
  }
}

// ------------------------------------------------------------------------------------------------ accepting

TEST(VerifyChunksAccepts, AllDistributions) {
  for (const io::Distribution& distribution : io::distributions()) {
    const Coordinates coordinates = io::generate(distribution.name, 150, 3).coordinates;
    Indices triangles = flat_triangles(reference_delaunay(coordinates));
    SCOPED_TRACE(distribution.name);
    expect_accepted(coordinates, triangles, reference_neighbors(triangles));
    shuffle_rows(triangles, 1);
    expect_accepted(coordinates, triangles, reference_neighbors(triangles));
  }
}

TEST(VerifyChunksAccepts, SmallIntegerPointsWithDuplicatesAndTies) {
  for (int i = 0; i < 80; ++i) {
    const Coordinates coordinates = random_integer_points(3 + i % 50, 1 + i % 13, i);
    Indices triangles = flat_triangles(reference_delaunay(coordinates));
    shuffle_rows(triangles, i);
    SCOPED_TRACE(i);
    expect_accepted(coordinates, triangles, reference_neighbors(triangles));
  }
}

TEST(VerifyChunksAccepts, AnyRepresentativeAndNegativeZero) {
  const Coordinates coordinates = {0, 0, 1, 0, 0, 1, 1, 0, 0, 0, -0.0, 0, 2, 3, 2, 3};
  for (const int a : {0, 4, 5}) {
    for (const int b : {1, 3}) {
      const Indices triangles = {a, b, 2, b, 7, 2};
      expect_accepted(coordinates, triangles, reference_neighbors(triangles));
    }
  }
}

TEST(VerifyChunksAccepts, CollinearPointsAndNone) {
  const std::vector<Coordinates> sets = {{},
                                         {1, 2},
                                         {1, 2, 3, 4},
                                         {1, 2, 1, 2, 1, 2},
                                         {0, 0, 1, 1, 3, 3, 2, 2, 0, -0.0},
                                         {0, 1, 0, 5, 0, -3},
                                         {0, 0, 1e300, 1e300, 1e-310, 1e-310, -5, -5}};
  for (const Coordinates& coordinates : sets) expect_accepted(coordinates, {}, {});
}

TEST(VerifyChunksAccepts, WhatNeedsExactNumbers) {
  Coordinates tiny = grid_points(5, 4);
  for (double& value : tiny) value *= std::numeric_limits<double>::denorm_min();
  for (const Coordinates& coordinates :
       {tiny, Coordinates{0, 0, 1e300, 0, 0, 1e300, 1e-310, 1e-310, -1e308, 1e308, 1, 1, 1e-5, -1e-310}}) {
    const Indices triangles = flat_triangles(reference_delaunay(coordinates));
    expect_accepted(coordinates, triangles, reference_neighbors(triangles));
  }
}

// ------------------------------------------------------------------------------------------------ rejecting

class VerifyChunksRejects : public ::testing::Test {
 protected:
  VerifyChunksRejects() {
    triangles_ = flat_triangles(reference_delaunay(coordinates_));
    neighbors_ = reference_neighbors(triangles_);
  }
  std::size_t rows() const { return triangles_.size() / 3; }

  const Coordinates coordinates_ = io::generate("uniform", 40, 5).coordinates;
  Indices triangles_, neighbors_;
};

TEST_F(VerifyChunksRejects, NothingInTheUndamagedExample) {
  expect_accepted(coordinates_, triangles_, neighbors_);
}

TEST_F(VerifyChunksRejects, IndexOutOfRange) {
  for (const std::int32_t bad : {-1, 40, -2147483647}) {
    Indices triangles = triangles_;
    triangles[10] = bad;
    expect_rejected(coordinates_, triangles, nullptr, "index",
                    "triangle 3 has a corner " + std::to_string(bad));
  }
  expect_rejected({}, {0, 1, 2}, nullptr, "no points", "triangle 0 has a corner 0");
}

TEST_F(VerifyChunksRejects, PointsThatAreNotFinite) {
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), -std::numeric_limits<double>::infinity()}) {
    Coordinates coordinates = coordinates_;
    coordinates[2 * 33 + 1] = bad;
    const auto expect_error = [&](const Indices& triangles, const VerifySizes& sizes) {
      try {
        check(coordinates, triangles, nullptr, sizes);
        ADD_FAILURE() << "accepted";
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_NE(std::string(error.what()).find("point 33 at ("), std::string::npos) << error.what();
      }
    };
    for (const VerifySizes& sizes : many_sizes()) expect_error(triangles_, sizes);
    expect_error({}, many_sizes().front());
  }
}

TEST_F(VerifyChunksRejects, SwappedVertices) {
  for (std::size_t h = 0; h < triangles_.size(); h += 5) {
    Indices triangles = triangles_;
    std::swap(triangles[h], triangles[h - h % 3 + (h + 1) % 3]);
    expect_rejected(coordinates_, triangles, nullptr, "swapped",
                    "triangle " + std::to_string(h / 3) + " with points");
  }
}

TEST_F(VerifyChunksRejects, RepeatedVertexInARow) {
  Indices triangles = triangles_;
  triangles[7] = triangles[6];
  expect_rejected(coordinates_, triangles, nullptr, "degenerate", "is degenerate");
}

TEST_F(VerifyChunksRejects, OtherVertex) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 200; ++i) {
    Indices triangles = triangles_;
    std::int32_t& corner = triangles[random() % triangles.size()];
    const std::int32_t before = corner;
    corner = static_cast<std::int32_t>(random() % 40);
    if (corner != before) expect_rejected(coordinates_, triangles, nullptr, "other vertex");
  }
}

TEST_F(VerifyChunksRejects, FlippedEdges) {
  for (std::size_t h = 0; h < triangles_.size(); ++h) {
    const std::int32_t s = neighbors_[h];
    if (s < 0) continue;
    const std::size_t t = h / 3;
    const std::int32_t a = triangles_[h], b = triangles_[3 * t + (h + 1) % 3],
                       c = triangles_[3 * t + (h + 2) % 3];
    std::int32_t d = -1;
    for (int k = 0; k < 3; ++k) {
      if (triangles_[3 * s + k] != b && triangles_[3 * s + k] != c) d = triangles_[3 * s + k];
    }
    Indices flipped = triangles_;
    const std::int32_t first[] = {a, b, d}, second[] = {a, d, c};
    std::copy_n(first, 3, &flipped[3 * t]);
    std::copy_n(second, 3, &flipped[3 * s]);
    expect_rejected(coordinates_, flipped, nullptr, "flipped edge");
  }
  const Coordinates kite = {0, 0, 4, -1, 8, 0, 4, 1};
  expect_rejected(kite, {0, 1, 2, 0, 2, 3}, nullptr, "flipped kite",
                  "is not Delaunay: its circle contains point");
}

TEST_F(VerifyChunksRejects, MissingTriangle) {
  for (std::size_t t = 0; t < rows(); ++t) {
    Indices triangles = triangles_;
    triangles.erase(triangles.begin() + 3 * t, triangles.begin() + 3 * t + 3);
    expect_rejected(coordinates_, triangles, nullptr, "missing");
  }
  expect_rejected(coordinates_, {}, nullptr, "none",
                  "there are no triangles, but the points are not all collinear");
}

TEST_F(VerifyChunksRejects, DoubledTriangle) {
  for (std::size_t t = 0; t < rows(); ++t) {
    for (const std::size_t place : {std::size_t{0}, t, rows()}) {
      Indices triangles = triangles_;
      const Indices doubled(triangles.begin() + 3 * t, triangles.begin() + 3 * t + 3);
      triangles.insert(triangles.begin() + 3 * place, doubled.begin(), doubled.end());
      expect_rejected(coordinates_, triangles, nullptr, "doubled");
    }
  }
}

TEST_F(VerifyChunksRejects, EverythingDoubled) {
  Indices triangles = triangles_;
  triangles.insert(triangles.end(), triangles_.begin(), triangles_.end());
  expect_rejected(coordinates_, triangles, nullptr, "twice");
}

TEST_F(VerifyChunksRejects, WrongNeighbours) {
  std::mt19937_64 random(6);
  for (std::size_t h = 0; h < neighbors_.size(); ++h) {
    Indices neighbors = neighbors_;
    neighbors[h] = static_cast<std::int32_t>(random() % (rows() + 1)) - 1;
    if (neighbors[h] == neighbors_[h]) continue;
    expect_rejected(coordinates_, triangles_, &neighbors, "wrong neighbour",
                    "has neighbor " + std::to_string(neighbors[h]) + " opposite to point " +
                        std::to_string(triangles_[h]) + ", but it should be " +
                        std::to_string(neighbors_[h]));
  }
}

TEST_F(VerifyChunksRejects, NeighboursInWrongOrderOrNumber) {
  Indices rotated = neighbors_;
  std::rotate(&rotated[9], &rotated[10], &rotated[9] + 3);
  expect_rejected(coordinates_, triangles_, &rotated, "rotated", "triangle 3 with points");
  Indices few(neighbors_.begin(), neighbors_.end() - 3);
  expect_rejected(coordinates_, triangles_, &few, "few", "there should be 3 for each of");
}

TEST_F(VerifyChunksRejects, UnusedPoints) {
  for (const bool outside : {false, true}) {
    Coordinates coordinates = coordinates_;
    const double at = outside ? 7 : 0.4;
    coordinates.insert(coordinates.end(), {at, at});
    expect_rejected(coordinates, triangles_, nullptr, "unused", "point 40 at (");
  }
  // A corner of the hull, in whose place the next points are.
  const Coordinates square = {0, 0, 4, 0, 4, 4, 0, 4, 2.5, 2, 0, 0, 0, 4, 1, 1};
  expect_rejected(square, {0, 1, 4, 1, 2, 4, 2, 3, 4, 0, 4, 3}, nullptr, "unused",
                  "point 7 at (1, 1) is in no");
}

TEST_F(VerifyChunksRejects, UsedDuplicates) {
  for (std::size_t h = 0; h < triangles_.size(); h += 2) {
    Coordinates coordinates = coordinates_;
    const std::int32_t v = triangles_[h];
    coordinates.insert(coordinates.end(), {coordinates_[2 * v], coordinates_[2 * v + 1]});
    Indices triangles = triangles_;
    triangles[h] = 40;
    if (std::count(triangles.begin(), triangles.end(), v) > 0) {
      expect_rejected(coordinates, triangles, nullptr, "duplicate");
    }
  }
}

// Both meshes are right; their vertices are at the same places, or far from each other.
TEST_F(VerifyChunksRejects, TwoComponents) {
  for (const double distance : {0.0, 5.0}) {
    Coordinates coordinates = coordinates_;
    for (const double value : coordinates_) coordinates.push_back(value + distance);
    Indices triangles = triangles_;
    for (const std::int32_t v : triangles_) triangles.push_back(v + 40);
    expect_rejected(coordinates, triangles, nullptr, "components");
  }
}

TEST_F(VerifyChunksRejects, FoldedHulls) {
  // A notch: the square's last triangle is missing although all points are used.
  const Coordinates square = {0, 0, 4, 0, 4, 4, 0, 4, 2.5, 2};
  expect_rejected(square, {0, 1, 4, 1, 2, 4, 2, 3, 4}, nullptr, "notch",
                  "the boundary is not one convex cycle");
  // Two triangles that meet in a corner only.
  const Coordinates bow = {0, 0, 2, -1, 2, 1, 4, -1, 4, 1};
  expect_rejected({0, 0, 0, 2, 1, 1, 2, 0, 2, 2}, {0, 2, 1, 2, 3, 4}, nullptr, "bow tie", "boundary");
  // A fan that goes around its centre twice.
  Coordinates spiral = {0, 0};
  Indices fan;
  for (int i = 0; i < 10; ++i) {
    const double angle = 2 * 3.14159265358979 / 5 * i;
    spiral.insert(spiral.end(), {(1 + 0.001 * i) * std::cos(angle), (1 + 0.001 * i) * std::sin(angle)});
    fan.insert(fan.end(), {0, 1 + i, 1 + (i + 1) % 10});
  }
  expect_rejected(spiral, fan, nullptr, "spiral");
  expect_rejected(bow, {1, 3, 2, 3, 4, 2}, nullptr, "unused corner", "point 0 at (0, 0) is in no triangle");
}

TEST_F(VerifyChunksRejects, ManyRandomDamages) {
  std::mt19937_64 random(8);
  std::size_t accepted = 0, rejected = 0;
  for (int i = 0; i < 1500; ++i) {
    const Coordinates coordinates = random_integer_points(4 + i % 17, 2 + i % 7, 1000 + i);
    const auto n = static_cast<std::int32_t>(coordinates.size() / 2);
    Indices triangles = flat_triangles(reference_delaunay(coordinates));
    if (triangles.empty()) continue;
    for (int damages = 1 + i % 2; damages > 0; --damages) {
      const std::size_t h = random() % triangles.size(), other = random() % triangles.size();
      if (i % 3 == 0) triangles[h] = static_cast<std::int32_t>(random() % n);
      if (i % 3 == 1) std::swap(triangles[h], triangles[other]);
      if (i % 3 == 2) std::copy_n(&triangles[h - h % 3], 3, &triangles[other - other % 3]);
    }
    const bool right = verify(coordinates.data(), n, triangles).ok;
    for (const VerifySizes& sizes : many_sizes()) {
      const VerifyChunksReport report = check(coordinates, triangles, nullptr, sizes);
      ASSERT_EQ(report.ok, right) << i << ": " << report.problem;
    }
    ++(right ? accepted : rejected);
  }
  EXPECT_GT(accepted, 50u);
  EXPECT_GT(rejected, 500u);
}

TEST(VerifySizes, FitTheMemory) {
  EXPECT_THROW(verify_sizes(1 << 20, 1000, 2000, 2), Error);
  for (const std::uint64_t memory :
       {std::uint64_t{64} << 20, std::uint64_t{4} << 30, std::uint64_t{64} << 30}) {
    for (const std::uint64_t n : {std::uint64_t{0}, std::uint64_t{1000}, std::uint64_t{10000000000}}) {
      for (const int threads : {1, 2, 64}) {
        const VerifySizes sizes = verify_sizes(memory, n, 2 * n, threads);
        ASSERT_GE(sizes.threads, 1);
        ASSERT_LE(sizes.threads, threads);
        EXPECT_LE(
            sizes.threads * (sizes.window_rows * 132 + std::min(n, sizes.index_ids) / 6) + sizes.sort_bytes,
            memory);
        EXPECT_LE(sizes.range_points * 17 + sizes.filter_bits / 8, memory);
        EXPECT_LT(3 * sizes.window_rows, std::uint64_t{1} << 31);
        EXPECT_GE(sizes.window_rows, std::min<std::uint64_t>(2 * n, 1 << 17) / (2 * threads));
      }
    }
  }
}

}  // namespace
}  // namespace flaunay
