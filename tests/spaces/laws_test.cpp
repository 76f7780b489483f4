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
#include <vector>

#include "tests/spaces/spaces.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing::spaces {
namespace {

using Ids = std::vector<std::int32_t>;

/// The triangles, each from its smallest corner on and with the periods between its corners; points by other
/// names.
std::multiset<std::array<int, 9>> triangles_of(const Triangulation& mesh, const Ids& names) {
  std::multiset<std::array<int, 9>> all;
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    std::array<std::array<int, 3>, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k][0] = names[static_cast<std::size_t>(mesh.triangles[t + k])];
      if (!mesh.corner_offsets.empty()) {
        corners[k][1] = mesh.corner_offsets[2 * (t + k)];
        corners[k][2] = mesh.corner_offsets[2 * (t + k) + 1];
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

class Laws : public ::testing::TestWithParam<TestSpace> {
 protected:
  Triangulation triangulated(const Numbers& points, const Offsets& offsets) const {
    return space_.triangulate(triangulator(), points, offsets);
  }
  Triangulation triangulated(const Numbers& points) const {
    return triangulated(points, {0, points.size() / space_.width});
  }

  const TestSpace space_ = GetParam();
  const std::vector<Case> cases_ = cases(space_);
};
INSTANTIATE_TEST_SUITE_P(Spaces, Laws, ::testing::ValuesIn(all_spaces()),
                         [](const auto& of) { return of.param.name; });

TEST_P(Laws, ResultsAreProven) {
  for (const Case& given : cases_) {
    SCOPED_TRACE(given.name);
    const Offsets offsets = {0, given.numbers.size() / space_.width};
    EXPECT_EQ("", space_.verify(given.numbers, offsets, triangulated(given.numbers)));
  }
}

TEST_P(Laws, LargerResultsAreProven) {
  for (const Case& given : large_cases(space_)) {
    SCOPED_TRACE(given.name);
    const Offsets offsets = {0, given.numbers.size() / space_.width};
    EXPECT_EQ("", space_.verify(given.numbers, offsets, triangulated(given.numbers)));
  }
}

TEST_P(Laws, TheOrderOfPointsAndBlocksChangeNothing) {
  for (const Case& given : cases_) {
    SCOPED_TRACE(given.name);
    const auto mesh = triangulated(given.numbers);
    const std::size_t n = mesh.representatives.size();
    Numbers turned;
    Ids names;
    for (std::size_t i = n; i-- > 0;) {
      const auto row = given.numbers.begin() + static_cast<std::ptrdiff_t>(space_.width * i);
      turned.insert(turned.end(), row, row + space_.width);
      names.push_back(mesh.representatives[i]);
    }
    const auto other = space_.triangulate(triangulator_with("block_points=8"), turned, {0, n});
    EXPECT_EQ(triangles_of(mesh, mesh.representatives), triangles_of(other, names));
  }
}

TEST_P(Laws, EqualPointsAreOne) {
  for (const Case& given : cases_) {
    SCOPED_TRACE(given.name);
    const auto mesh = triangulated(given.numbers);
    Numbers twice = given.numbers;
    twice.insert(twice.end(), given.numbers.begin(), given.numbers.end());
    const auto other = triangulated(twice);
    EXPECT_EQ(triangles_of(mesh, mesh.representatives), triangles_of(other, other.representatives));
    Ids expected = mesh.representatives;
    expected.insert(expected.end(), mesh.representatives.begin(), mesh.representatives.end());
    EXPECT_EQ(expected, other.representatives);
  }
}

TEST_P(Laws, SetsAreEachAsAlone) {
  Offsets offsets;
  const Numbers points = joined(cases_, space_.width, offsets);
  const auto all = triangulated(points, offsets);
  EXPECT_EQ("", space_.verify(points, offsets, all));
  ASSERT_EQ(offsets.size(), all.triangle_offsets.size());
  const auto expect_part = [](const auto& whole, std::size_t first, const auto& own, std::size_t shift) {
    ASSERT_LE(first + own.size(), whole.size());
    for (std::size_t i = 0; i < own.size(); ++i)
      ASSERT_EQ(own[i] < 0 ? own[i] : own[i] + static_cast<std::int32_t>(shift), whole[first + i]) << i;
  };
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    const std::size_t first = all.triangle_offsets[s];
    const auto own = triangulated(s % 2 == 0 ? cases_[s / 2].numbers : Numbers());
    SCOPED_TRACE(s);
    ASSERT_EQ(own.triangles.size(), 3 * (all.triangle_offsets[s + 1] - first));
    expect_part(all.triangles, 3 * first, own.triangles, offsets[s]);
    expect_part(all.neighbors, 3 * first, own.neighbors, first);
    expect_part(all.representatives, offsets[s], own.representatives, offsets[s]);
    if (!all.corner_offsets.empty()) expect_part(all.corner_offsets, 6 * first, own.corner_offsets, 0);
  }
}

TEST_P(Laws, PointsAreNearestToThemselves) {
  if (space_.has_weights) return;  // has no locator
  for (const Case& given : cases_) {
    SCOPED_TRACE(given.name);
    const auto mesh = triangulated(given.numbers);
    const std::size_t n = mesh.representatives.size();
    NeighborOptions options;
    options.count = 4;
    // Of no points, too.
    const Numbers queries = n > 0 ? given.numbers : Numbers(3 * space_.width, 0.5);
    const Answers found = space_.answers(triangulator(), given.numbers, mesh, queries, options);
    for (std::size_t q = 0; q < queries.size() / space_.width; ++q) {
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

TEST_P(Laws, EveryWrongIndexIsFound) {
  for (const Case& given : {cases_[6], cases_[8]}) {
    const Offsets offsets = {0, given.numbers.size() / space_.width};
    const auto right = triangulated(given.numbers);
    const auto is_found = [&](const auto& wrong) {
      std::string problem;
      try {
        problem = space_.verify(given.numbers, offsets, wrong);
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
    using Mesh = Triangulation;
    expect_all(&Mesh::triangles, offsets[1]);
    expect_all(&Mesh::neighbors, right.triangles.size() / 3);
    expect_all(&Mesh::representatives, offsets[1]);
    EXPECT_FALSE(is_found(right));
  }
}

}  // namespace
}  // namespace flaunay::testing::spaces
