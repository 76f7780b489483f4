// The stage `canonical`: fans of cocircular points from their smallest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/flattened/support.hpp"
#include "tests/support/border_twin.hpp"
#include "tests/support/neighbors_twin.hpp"

namespace flaunay::flattened {
namespace {

/// Some triangulation of a convex polygon, counter-clockwise.
void add_random_triangles(const std::vector<int>& polygon, FixtureRandom& random,
                          std::vector<cl_int>& triangles) {
  // Ears in random order.
  std::vector<int> rest = polygon;
  while (rest.size() >= 3) {
    const auto k = static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(rest.size()) - 1));
    const std::size_t size = rest.size();
    triangles.insert(triangles.end(), {rest[(k + size - 1) % size], rest[k], rest[(k + 1) % size]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

/// Canonicalizes and returns the rows, with the twins held against those of the new triangles.
std::vector<cl_int> canonical(Call& call, const std::vector<cl_double2>& places,
                              const std::vector<cl_int>& triangles) {
  PointTable table;
  table.count = places.size();
  table.points = testing::upload(call.runtime, places);
  const auto rows = testing::upload(call.runtime, triangles);
  const auto twins = testing::guarded<cl_int>(call.runtime, triangles.size());
  match_edges(call.work, rows, triangles.size() / 3, twins);
  canonicalize(call.work, table, rows, triangles.size() / 3, twins);
  auto result = testing::download(call.runtime, rows, triangles.size());
  EXPECT_TRUE(same(testing::download(call.runtime, twins, triangles.size()), testing::twins_twin(result)));
  return result;
}

}  // namespace

/// Cells of cocircular points, given in counter-clockwise order of ids, become fans from their smallest ids.
void check_cells(Runtime& runtime, const std::vector<cl_double2>& places,
                 const std::vector<std::vector<int>>& cells, const Bounds& bounds, FixtureRandom& random) {
  std::vector<cl_int> triangles;
  TriangleSet expected;
  for (std::vector<int> cell : cells) {
    add_random_triangles(cell, random, triangles);
    std::rotate(cell.begin(), std::min_element(cell.begin(), cell.end()), cell.end());
    for (std::size_t i = 1; i + 1 < cell.size(); ++i) expected.push_back({cell[0], cell[i], cell[i + 1]});
  }
  std::sort(expected.begin(), expected.end());
  Call call(runtime);
  call.work.bounds = bounds;
  const auto found = canonical(call, places, triangles);
  EXPECT_TRUE(testing::sorted_triangles(found) == expected);
  EXPECT_NE(testing::sorted_triangles(triangles), expected);  // so there was something to do
  EXPECT_EQ(call.broken(), 0);
}

/// Cells of k points each of one circle, as sets of points of their own.
void make_cells(std::int64_t square, const std::vector<std::size_t>& sizes, FixtureRandom& random,
                std::vector<cl_double2>& places, std::vector<std::vector<int>>& cells) {
  const auto circle = integer_circle(square);
  for (const std::size_t size : sizes) {
    std::vector<int> chosen(circle.size());
    std::iota(chosen.begin(), chosen.end(), 0);
    random.shuffle(chosen);
    chosen.resize(size);
    std::sort(chosen.begin(), chosen.end());
    std::vector<cl_double2> own;
    for (const int id : chosen) own.push_back(circle[static_cast<std::size_t>(id)]);
    std::vector<int> ids(size);
    std::iota(ids.begin(), ids.end(), 0);
    bool collinear = false;
    std::vector<int> cell = testing::border_twin(ExactPoints(own), ids, collinear);
    for (int& id : cell) id += static_cast<int>(places.size());
    places.insert(places.end(), own.begin(), own.end());
    cells.push_back(cell);
  }
}

namespace {

TEST(SmallCanonical, Cells) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(17);
    std::vector<cl_double2> places;
    std::vector<std::vector<int>> cells;
    make_cells(25 * 13, {4, 7, 9, 12}, random, places, cells);
    check_cells(runtime, places, cells, {0, 0, 0}, random);
    check_cells(runtime, places, cells, kUndecided, random);
  });
}

TEST(Canonical, CellsOfFourToThirtyPointsAndOneOfAThousand) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(18);
    for (const Bounds& bounds : {Bounds{1.2e-15, 1.2e-15, 1.2e-15}, kUndecided}) {
      std::vector<cl_double2> places;
      std::vector<std::vector<int>> cells;
      std::vector<std::size_t> sizes(27);
      std::iota(sizes.begin(), sizes.end(), 4);
      make_cells(std::int64_t{25} * 13 * 17 * 29, sizes, random, places, cells);
      check_cells(runtime, places, cells, bounds, random);
      places.clear();
      cells.clear();
      const std::int64_t square =
          std::int64_t{125} * 169 * 289 * 29 * 37;  // 4 * 4 * 3 * 3 * 2 * 2 = 576 points
      make_cells(square * 41, {1152}, random, places, cells);
      check_cells(runtime, places, cells, bounds, random);
    }
  });
}

/// Canonical triangulations with edges of cocircular points flipped at random, which must come back.
TEST(Canonical, UndoesFlips) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(19);
    for (const char* const name : {"grid", "small-integers", "integer-circle", "ladder", "uniform"}) {
      SCOPED_TRACE(name);
      // In the order of ids, without duplicates: ids are indices.
      const Coordinates raw = make_fixture(name, 150, 20);
      std::set<std::pair<double, double>> distinct;
      for (std::size_t i = 0; i < raw.size(); i += 2) distinct.insert({raw[i], raw[i + 1]});
      Coordinates coordinates;
      std::vector<cl_double2> places;
      for (const auto& [x, y] : distinct) {
        coordinates.insert(coordinates.end(), {x, y});
        places.push_back({{x, y}});
      }
      const ExactPoints points(places);
      const TriangleSet expected = testing::reference_delaunay(coordinates);
      std::vector<cl_int> triangles = testing::flat_triangles(expected);
      std::size_t flips = 0;
      for (int attempt = 0; attempt < 400; ++attempt) {
        const auto twins = testing::twins_twin(triangles);
        const auto h =
            static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(triangles.size()) - 1));
        if (twins[h] < 0) continue;
        const auto g = static_cast<std::size_t>(twins[h]);
        const int a = triangles[h / 3 * 3 + (h + 2) % 3], b = triangles[h],
                  c = triangles[h / 3 * 3 + (h + 1) % 3];
        const int d = triangles[g / 3 * 3 + (g + 2) % 3];
        if (points.in_circle(a, b, c, d) != 0) continue;
        const int one[] = {a, b, d}, other[] = {a, d, c};
        std::copy(one, one + 3, triangles.begin() + static_cast<std::ptrdiff_t>(h / 3 * 3));
        std::copy(other, other + 3, triangles.begin() + static_cast<std::ptrdiff_t>(g / 3 * 3));
        ++flips;
      }
      EXPECT_EQ(flips > 0, std::string(name) != "uniform");
      for (const Bounds& bounds : {Bounds{1.2e-15, 1.2e-15, 1.2e-15}, kUndecided}) {
        Call call(runtime);
        call.work.bounds = bounds;
        EXPECT_TRUE(testing::sorted_triangles(canonical(call, places, triangles)) == expected);
        EXPECT_EQ(call.broken(), 0);
      }
    }
  });
}

/// An edge that is not Delaunay is found out.
TEST(SmallCanonical, ReportsAnEdgeThatIsNotDelaunay) {
  under_each_tuning([](Runtime& runtime) {
    const std::vector<cl_double2> places{{{0, 0}}, {{1, -1}}, {{1, 1}}, {{8, 0}}};
    for (const Bounds& bounds : {Bounds{0, 0, 0}, kUndecided}) {
      Call call(runtime);
      call.work.bounds = bounds;
      canonical(call, places, {0, 1, 2, 2, 1, 3});
      EXPECT_EQ(call.broken(), 0);
      canonical(call, places, {0, 1, 3, 0, 3, 2});
      EXPECT_EQ(call.broken(), 4);
      EXPECT_THROW(check_invariants(call.work), Error);
    }
  });
}

}  // namespace

}  // namespace flaunay::flattened
