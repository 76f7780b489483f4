// What holds in every space: results are proven, depend on nothing but the set of points, and each set is as
// if it were alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "tests/spaces/spaces.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing::spaces {
namespace {

using Ids = std::vector<std::int32_t>;

template <typename Space>
auto triangulated(const Numbers& points, const Offsets& offsets) {
  return Space::triangulate(triangulator(), points, offsets);
}
template <typename Space>
auto triangulated(const Numbers& points) {
  return triangulated<Space>(points, {0, points.size() / Space::kWidth});
}

template <typename Mesh>
constexpr bool has_periods() {
  return std::is_base_of_v<PeriodicTriangulation, Mesh>;
}

/// The triangles, each from its smallest corner on and with the periods between its corners; points by other
/// names.
template <typename Mesh>
std::multiset<std::array<int, 9>> triangles_of(const Mesh& mesh, const Ids& names) {
  std::multiset<std::array<int, 9>> all;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    std::array<std::array<int, 3>, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k][0] = names[static_cast<std::size_t>(mesh.triangles[t + k])];
      if constexpr (has_periods<Mesh>()) {
        corners[k][1] = mesh.offsets[2 * (t + k)];
        corners[k][2] = mesh.offsets[2 * (t + k) + 1];
      }
    }
    // A corner that is there twice comes first as it lies in either.
    std::array<int, 9> least{};
    for (std::size_t first = 0; first < 3; ++first) {
      std::array<int, 9> row{};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto& corner = corners[(first + k) % 3];
        row[k] = corner[0];
        for (std::size_t axis = 1; axis < 3; ++axis)
          row[1 + 2 * k + axis] = corner[axis] - corners[first][axis];
      }
      least = first == 0 ? row : std::min(least, row);
    }
    all.insert(least);
  }
  return all;
}

template <typename Space>
class Laws : public ::testing::Test {
 protected:
  const std::vector<Case> cases_ = cases(Space::kWidth);
};
using Spaces = ::testing::Types<Plane, Weighted, Torus, Cylinder, UprightCylinder, Sphere, WeightedTorus,
                                WeightedCylinder>;
template <typename Space, typename = void>
constexpr bool kHasQueries = false;
template <typename Space>
constexpr bool kHasQueries<Space, std::void_t<decltype(&Space::answers)>> = true;
TYPED_TEST_SUITE(Laws, Spaces, );

TYPED_TEST(Laws, ResultsAreProven) {
  for (const Case& given : this->cases_) {
    SCOPED_TRACE(given.name);
    const Offsets offsets = {0, given.numbers.size() / TypeParam::kWidth};
    EXPECT_EQ("", TypeParam::verify(given.numbers, offsets, triangulated<TypeParam>(given.numbers)));
  }
}

TYPED_TEST(Laws, TheOrderOfPointsAndBlocksChangeNothing) {
  for (const Case& given : this->cases_) {
    SCOPED_TRACE(given.name);
    const auto mesh = triangulated<TypeParam>(given.numbers);
    const std::size_t n = mesh.representatives.size();
    Numbers turned;
    Ids names;
    for (std::size_t i = n; i-- > 0;) {
      const auto row = given.numbers.begin() + static_cast<std::ptrdiff_t>(TypeParam::kWidth * i);
      turned.insert(turned.end(), row, row + TypeParam::kWidth);
      names.push_back(mesh.representatives[i]);
    }
    const auto other = TypeParam::triangulate(triangulator_with("block_points=8"), turned, {0, n});
    EXPECT_EQ(triangles_of(mesh, mesh.representatives), triangles_of(other, names));
  }
}

TYPED_TEST(Laws, EqualPointsAreOne) {
  for (const Case& given : this->cases_) {
    SCOPED_TRACE(given.name);
    const auto mesh = triangulated<TypeParam>(given.numbers);
    Numbers twice = given.numbers;
    twice.insert(twice.end(), given.numbers.begin(), given.numbers.end());
    const auto other = triangulated<TypeParam>(twice);
    EXPECT_EQ(triangles_of(mesh, mesh.representatives), triangles_of(other, other.representatives));
    Ids expected = mesh.representatives;
    expected.insert(expected.end(), mesh.representatives.begin(), mesh.representatives.end());
    EXPECT_EQ(expected, other.representatives);
  }
}

TYPED_TEST(Laws, SetsAreEachAsAlone) {
  Offsets offsets;
  const Numbers points = joined(this->cases_, TypeParam::kWidth, offsets);
  const auto all = triangulated<TypeParam>(points, offsets);
  EXPECT_EQ("", TypeParam::verify(points, offsets, all));
  ASSERT_EQ(offsets.size(), all.triangle_offsets.size());
  const auto expect_part = [](const auto& whole, std::size_t first, const auto& own, std::size_t shift) {
    ASSERT_LE(first + own.size(), whole.size());
    for (std::size_t i = 0; i < own.size(); ++i)
      ASSERT_EQ(own[i] < 0 ? own[i] : own[i] + static_cast<std::int32_t>(shift), whole[first + i]) << i;
  };
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    const std::size_t first = all.triangle_offsets[s];
    const auto own = triangulated<TypeParam>(s % 2 == 0 ? this->cases_[s / 2].numbers : Numbers());
    SCOPED_TRACE(s);
    ASSERT_EQ(own.triangles.size(), 3 * (all.triangle_offsets[s + 1] - first));
    expect_part(all.triangles, 3 * first, own.triangles, offsets[s]);
    expect_part(all.neighbors, 3 * first, own.neighbors, first);
    expect_part(all.representatives, offsets[s], own.representatives, offsets[s]);
    if constexpr (has_periods<decltype(all)>()) expect_part(all.offsets, 6 * first, own.offsets, 0);
  }
}

TYPED_TEST(Laws, PointsAreNearestToThemselves) {
  if constexpr (kHasQueries<TypeParam>) {
    for (const Case& given : this->cases_) {
      SCOPED_TRACE(given.name);
      const auto mesh = triangulated<TypeParam>(given.numbers);
      const std::size_t n = mesh.representatives.size();
      NeighborOptions options;
      options.count = 4;
      // Of no points, too.
      const Numbers queries = n > 0 ? given.numbers : Numbers(3 * TypeParam::kWidth, 0.5);
      const Answers found = TypeParam::answers(triangulator(), given.numbers, mesh, queries, options);
      for (std::size_t q = 0; q < queries.size() / TypeParam::kWidth; ++q) {
        const std::int32_t self = n > 0 ? mesh.representatives[q] : -1;
        ASSERT_EQ(self, found.nearest[q]);
        ASSERT_EQ(self, found.several.points[options.count * q]);
        const auto row = found.several.points.begin() + static_cast<std::ptrdiff_t>(options.count * q);
        std::set<std::int32_t> near(row, row + static_cast<std::ptrdiff_t>(options.count));
        near.erase(-1);
        ASSERT_EQ(std::min(options.count, n), near.size());
        ASSERT_TRUE(std::is_sorted(&found.several.distances[options.count * q],
                                   &found.several.distances[options.count * q] + options.count));
        const std::int32_t t = found.triangles[q];
        if (t < 0) continue;
        const std::int32_t* const corners = &mesh.triangles[3 * static_cast<std::size_t>(t)];
        ASSERT_TRUE(std::count(corners, corners + 3, self) > 0);
      }
    }
  }
}

TYPED_TEST(Laws, EveryWrongIndexIsFound) {
  for (const Case& given : {this->cases_[6], this->cases_[8]}) {
    const Offsets offsets = {0, given.numbers.size() / TypeParam::kWidth};
    const auto right = triangulated<TypeParam>(given.numbers);
    const auto is_found = [&](const auto& wrong) {
      std::string problem;
      try {
        problem = TypeParam::verify(given.numbers, offsets, wrong);
      } catch (const Error& error) {
        problem = error.what();
      }
      return !problem.empty();
    };
    const auto expect_all = [&](auto array, std::size_t end) {
      for (std::size_t i = 0; i < (right.*array).size(); ++i) {
        auto wrong = right;
        auto& index = (wrong.*array)[i];
        index = static_cast<std::int32_t>((static_cast<std::size_t>(index + 1) + i % 5) % end);
        if (index == (right.*array)[i]) continue;
        EXPECT_TRUE(is_found(wrong)) << given.name << ", entry " << i;
      }
    };
    using Mesh = std::remove_const_t<decltype(right)>;
    expect_all(&Mesh::triangles, offsets[1]);
    expect_all(&Mesh::neighbors, right.triangles.size() / 3);
    expect_all(&Mesh::representatives, offsets[1]);
    EXPECT_FALSE(is_found(right));
  }
}

}  // namespace
}  // namespace flaunay::testing::spaces
