// What holds in every space: results are proven, depend on nothing but the set of points, and each set is as
// if it were alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "tests/spaces/lloyd.hpp"
#include "tests/spaces/spaces.hpp"
#include "tests/support/errors.hpp"
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

  Numbers relaxed(const Numbers& points, std::size_t steps) const {
    return space_.relax(triangulator(), points, steps, box_);
  }
  Lloyd lloyd(const Numbers& points, const Triangulation& mesh) const {
    return is_sphere() ? lloyd_on_sphere(mesh) : lloyd_of_polygons(space_, points, mesh, box_);
  }
  bool is_sphere() const { return space_.space.kind == SpaceKind::sphere; }
  // How far points are from places or directions, as Lloyd has them; on a torus from the nearest images.
  Numbers distances(const Numbers& points, const Numbers& places) const {
    const std::size_t n = points.size() / space_.width;
    const Period period = space_.space.kind == SpaceKind::torus ? space_.space.period : Period{0, 0};
    const Numbers directions =
        is_sphere() ? directions_of(places_of(points.data(), n, space_.space)) : Numbers();
    Numbers all(n, HUGE_VAL);
    for (std::size_t i = 0; i < n; ++i) {
      const double* const a = is_sphere() ? &directions[3 * i] : &points[space_.width * i];
      const double* const b = &places[(is_sphere() ? 3 : 2) * i];
      for (const int across : {-1, 0, 1}) {
        for (const int up : {-1, 0, 1}) {
          const double x = a[0] - b[0] + across * period.x + up * period.shear,
                       y = a[1] - b[1] + up * period.y;
          const double z = is_sphere() ? a[2] - b[2] : 0;
          all[i] = std::min(all[i], std::sqrt(x * x + y * y + z * z));
        }
      }
    }
    return all;
  }
  // Rows of points in an order, on the sphere their places: of equal ones the first moves.
  std::multiset<Numbers> rows_of(const Numbers& points) const {
    const std::size_t n = points.size() / space_.width;
    const Numbers all = is_sphere() ? places_of(points.data(), n, space_.space) : points;
    std::multiset<Numbers> rows;
    const auto columns = static_cast<std::ptrdiff_t>(is_sphere() ? 2 : space_.width);
    for (auto row = all.begin(); row != all.end(); row += columns) rows.emplace(row, row + columns);
    return rows;
  }

  const TestSpace space_ = GetParam();
  // Of cells in the plane.
  const Numbers box_ = {-0.75, -0.5, 1, -0.5, 1, 0.75, -0.75, 0.75};
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
  if (space_.has_weights) return;  // whose locators know no nearest points
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

TEST_P(Laws, QueriesOfSetsAreEachAsAlone) {
  Offsets offsets, of_queries = {0};
  const Numbers points = joined(cases_, space_.width, offsets);
  Numbers values, queries;
  for (std::size_t i = 0; i < offsets.back(); ++i) values.push_back(static_cast<double>(i * 7 % 13));
  const std::size_t width = space_.has_weights ? 2 : space_.width;
  // As many as points and one more, and none for every third set.
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    if (s % 3 != 2) {
      for (std::size_t i = offsets[s]; i < offsets[s + 1]; ++i)
        queries.insert(queries.end(), &points[space_.width * i], &points[space_.width * i] + width);
      queries.insert(queries.end(), width, 0.125);
    }
    of_queries.push_back(queries.size() / width);
  }
  const Triangulation mesh = triangulated(points, offsets);
  Locator locator = space_.locator(triangulator(), points, offsets, mesh);
  const Ids triangles = locator.locate(queries.data(), of_queries);
  Ids nearest;
  if (!space_.has_weights) nearest = locator.nearest(queries.data(), of_queries);
  InterpolationOptions filled;
  filled.fill = -1;
  // Natural neighbours of few points on a torus are refused.
  std::vector<Interpolation> methods = {Interpolation::linear, Interpolation::clough_tocher};
  if (!space_.has_weights) methods.push_back(Interpolation::nearest);
  if (!space_.has_weights && space_.space.kind != SpaceKind::torus)
    methods.insert(methods.end(), {Interpolation::sibson, Interpolation::laplace});
  std::vector<Numbers> between;
  for (const Interpolation method : methods) {
    filled.method = method;
    between.push_back(locator.interpolate(values.data(), queries.data(), of_queries, filled));
  }
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    SCOPED_TRACE(s);
    const Numbers own(points.begin() + static_cast<std::ptrdiff_t>(space_.width * offsets[s]),
                      points.begin() + static_cast<std::ptrdiff_t>(space_.width * offsets[s + 1]));
    Locator alone = space_.locator(triangulator(), own, {0, offsets[s + 1] - offsets[s]}, triangulated(own));
    const std::size_t first = of_queries[s], m = of_queries[s + 1] - first;
    const double* const asked = queries.data() + width * first;
    const auto shifted = [](Ids ids, std::size_t by) {
      for (std::int32_t& i : ids) i += i < 0 ? 0 : static_cast<std::int32_t>(by);
      return ids;
    };
    const auto part = [&](const auto& all) {
      return std::vector(all.begin() + static_cast<std::ptrdiff_t>(first),
                         all.begin() + static_cast<std::ptrdiff_t>(first + m));
    };
    const Ids own_triangles = alone.locate(asked, m);
    EXPECT_EQ(shifted(own_triangles, mesh.triangle_offsets[s]), part(triangles));
    if (!space_.has_weights) {
      EXPECT_EQ(shifted(alone.nearest(asked, m), offsets[s]), part(nearest));
    }
    for (std::size_t k = 0; k < methods.size(); ++k) {
      filled.method = methods[k];
      const Numbers found = alone.interpolate(values.data() + offsets[s], asked, m, filled);
      EXPECT_EQ(found, part(between[k]));
      for (std::size_t i = offsets[s]; i < offsets[s + 1] && m > 0; ++i) {
        const std::int32_t v = mesh.representatives[i];
        if (std::binary_search(mesh.hidden.begin(), mesh.hidden.end(), v)) continue;
        if (own_triangles[i - offsets[s]] >= 0 || methods[k] == Interpolation::nearest) {
          EXPECT_EQ(values[static_cast<std::size_t>(v)], found[i - offsets[s]]);
        }
      }
    }
  }
  EXPECT_THROW(locator.locate(queries.data(), queries.size() / width), Error);
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

TEST_P(Laws, RelaxationIsAStepOfBruteForce) {
  if (!space_.has_cells()) {
    for (const std::size_t steps : {0, 1})
      expect_error(ErrorKind::usage, "no end", [&] { relaxed(cases_[4].numbers, steps); });
    return;
  }
  for (const Case& given : cases_) {
    SCOPED_TRACE(given.name);
    const Triangulation mesh = triangulated(given.numbers);
    const Lloyd expected = lloyd(given.numbers, mesh);
    const Numbers moved = relaxed(given.numbers, 1), stay = relaxed(given.numbers, 0);
    ASSERT_EQ(given.numbers.size(), moved.size());
    const Numbers away = distances(moved, expected.centroids);
    for (std::size_t i = 0; i < away.size(); ++i) {
      const auto self = static_cast<std::int32_t>(i);
      if (expected.sizes[i] > 1e-6) ASSERT_GT(1e-9, away[i]) << i;
      if (mesh.representatives[i] == self &&
          !std::binary_search(mesh.hidden.begin(), mesh.hidden.end(), self))
        continue;
      for (std::size_t k = space_.width * i; k < space_.width * (i + 1); ++k)
        ASSERT_EQ(stay[k], moved[k]) << i;
    }
  }
}

TEST_P(Laws, RelaxedPointsDependOnTheirSetAlone) {
  if (!space_.has_cells()) return;
  std::vector<Case> cases = cases_;
  cases.push_back(large_cases(space_)[0]);  // in several blocks, whose borders depend on the order of points
  for (const Case& given : cases) {
    SCOPED_TRACE(given.name);
    Numbers turned;
    for (std::size_t i = given.numbers.size() / space_.width; i-- > 0;) {
      const auto row = given.numbers.begin() + static_cast<std::ptrdiff_t>(space_.width * i);
      turned.insert(turned.end(), row, row + static_cast<std::ptrdiff_t>(space_.width));
    }
    EXPECT_TRUE(rows_of(relaxed(given.numbers, 3)) == rows_of(relaxed(turned, 3)));
    EXPECT_EQ(relaxed(given.numbers, 3), relaxed(relaxed(relaxed(given.numbers, 1), 1), 1));
  }
}

TEST_P(Laws, RelaxationNamesThePoint) {
  if (!space_.has_cells()) return;
  Numbers points = cases_[6].numbers;
  points[13 * space_.width] = std::nan("");
  expect_error(ErrorKind::input, "point 13 is not finite", [&] { relaxed(points, 1); });
}

TEST_P(Laws, RelaxationNeverAddsEnergy) {
  if (!space_.has_cells()) return;
  for (const Case& given : cases_) {
    SCOPED_TRACE(given.name);
    Numbers points = given.numbers;
    double energy = lloyd(points, triangulated(points)).energy;
    for (int step = 0; step < 3; ++step) {
      points = relaxed(points, 1);
      const double after = lloyd(points, triangulated(points)).energy;
      EXPECT_LE(after, energy + 1e-9);
      energy = after;
    }
  }
}

TEST_P(Laws, RelaxedLatticesStay) {
  if (!space_.has_cells()) return;
  const Period& period = space_.space.period;
  const bool is_torus = space_.space.kind == SpaceKind::torus;
  Numbers lattice;
  for (int i = 0; i < 16; ++i) {
    const double across = (i % 4 + 0.5) / 4, up = (i / 4 + 0.5) / 4;
    if (is_torus) {
      lattice.insert(lattice.end(), {across * period.x + up * period.shear, up * period.y});
    } else {
      lattice.insert(lattice.end(), {-0.75 + across * 1.75, -0.5 + up * 1.25});
    }
    if (space_.has_weights) lattice.push_back(0.25);
  }
  // The corners of an octahedron.
  const Numbers degrees = {0, 0, 90, 0, 180, 0, -90, 0, 0, 90, 0, -90};
  if (is_sphere()) lattice = space_.width == 2 ? degrees : cases_[9].numbers;
  const Numbers at = is_sphere()
                         ? directions_of(places_of(lattice.data(), 6, space_.space))
                         : space_.with_columns(lattice, [](const Numbers& xy, const Space&) { return xy; });
  for (const double away : distances(relaxed(lattice, 5), at)) EXPECT_GT(1e-14, away);
}

}  // namespace
}  // namespace flaunay::testing::spaces
