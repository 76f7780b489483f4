// What C++ programs have around the calls: points of their own types, and walks through meshes.
#include "flaunay/points.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <complex>
#include <cstdint>
#include <deque>
#include <set>
#include <utility>
#include <vector>

#include "flaunay/constrained.hpp"
#include "flaunay/walk.hpp"
#include "tests/support/integer_points.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay {
namespace {

using testing::triangulator;

struct Tree {
  int age;
  float x, y;
  const char* kind;
};
struct WithFunctions {
  double place[2];
  double x() const { return place[0]; }
  double y() const { return place[1]; }
};

TEST(Points, MayBeOfManyTypes) {
  const std::vector<double> numbers = {0, 0, 4, 0, 4, 3, 0, 4};
  const std::vector<std::int32_t> expected = triangulator().triangulate(numbers.data(), 4).triangles;
  const auto expect = [&](const Points& points) {
    ASSERT_EQ(points.size(), 4u);
    EXPECT_TRUE(std::equal(numbers.begin(), numbers.end(), points.data()));
    EXPECT_EQ(triangulate(triangulator(), points).triangles, expected);
  };
  expect(numbers);
  EXPECT_EQ(Points(numbers).data(), numbers.data()) << "no copy";
  const double array[] = {0, 0, 4, 0, 4, 3, 0, 4};
  EXPECT_EQ(Points(array).data(), array);
  expect(std::vector<float>(numbers.begin(), numbers.end()));
  expect(std::deque<double>(numbers.begin(), numbers.end()));
  expect(std::array<int, 8>{0, 0, 4, 0, 4, 3, 0, 4});
  expect(std::vector<std::array<double, 2>>{{0, 0}, {4, 0}, {4, 3}, {0, 4}});
  expect(std::vector<std::pair<int, double>>{{0, 0}, {4, 0}, {4, 3}, {0, 4}});
  expect(std::vector<std::complex<double>>{{0, 0}, {4, 0}, {4, 3}, {0, 4}});
  expect(std::vector<Tree>{{1, 0, 0, "oak"}, {2, 4, 0, "elm"}, {3, 4, 3, "fir"}, {4, 0, 4, "yew"}});
  expect(std::vector<WithFunctions>{{{0, 0}}, {{4, 0}}, {{4, 3}}, {{0, 4}}});
  EXPECT_EQ(Points(std::vector<Tree>()).size(), 0u);
  EXPECT_THROW(Points(std::vector<double>(3)), Error);
}

TEST(Walk, GoesAroundEachPoint) {
  const std::vector<double> coordinates = testing::random_integer_points(200, 12, 3);
  const Triangulation mesh = triangulator().triangulate(coordinates.data(), 200);
  const Corners corners(mesh);
  const std::set<std::int32_t> hull(mesh.hull.begin(), mesh.hull.end());
  std::size_t visited = 0;
  for (std::int32_t v = 0; v < 200; ++v) {
    ASSERT_EQ(corners.at(v).has_value(), mesh.representatives[static_cast<std::size_t>(v)] == v);
    if (!corners.at(v)) continue;
    std::vector<std::int32_t> triangles;
    std::optional<Corner> last;
    corners.around(v, [&](const Corner& corner) {
      EXPECT_EQ(corner.vertex(), v);
      EXPECT_EQ(corner.next().next().next(), corner);
      EXPECT_EQ(corner.next().previous(), corner);
      if (last) {
        EXPECT_EQ(corner.clockwise(), last);
      }
      if (const auto beyond = corner.across()) {
        EXPECT_EQ(beyond->across(), corner);
      }
      last = corner;
      triangles.push_back(corner.triangle());
    });
    visited += triangles.size();
    EXPECT_EQ(last->counter_clockwise().has_value(), hull.count(v) == 0);
    // The others of its triangles, each once, in the order around it.
    std::set<std::int32_t> others;
    for (const std::int32_t t : triangles) {
      for (int k = 0; k < 3; ++k) others.insert(Corner(mesh, t, k).vertex());
    }
    others.erase(v);
    const std::vector<std::int32_t> adjacent = corners.adjacent(v);
    EXPECT_EQ(std::set<std::int32_t>(adjacent.begin(), adjacent.end()), others);
    EXPECT_EQ(adjacent.size(), others.size());
  }
  EXPECT_EQ(visited, mesh.triangles.size()) << "each corner once";
  Options without;
  without.neighbors = false;
  const Triangulation plain = triangulator().triangulate(coordinates.data(), 200, without);
  EXPECT_THROW(Corners{plain}, Error);
}

}  // namespace
}  // namespace flaunay
