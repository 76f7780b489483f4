// Dwyer's algorithm on the host: against the brute-force reference where n allows, else against the exact
// checker; its work by hand.
#include "modes/dwyer/dwyer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/sort.hpp"
#include "prove/delaunay_proof.hpp"
#include "statistics/costs.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"

namespace flaunay::testing {
namespace {

using research::Component;
using research::kComponents;
using research::Mode;
using research::OperationCounts;
using research::Options;
using research::Work;

Options dwyer_options() {
  Options options;
  options.mode = Mode::dwyer;
  return options;
}

research::Triangulation triangulate(const Coordinates& points, const Options& options = dwyer_options()) {
  return research::triangulate_on_host(points.data(), {0, points.size() / 2}, options);
}

void expect_reference(const Coordinates& points) {
  SCOPED_TRACE(text_of(points));
  const Triangulation result = triangulate(points);
  EXPECT_EQ(sorted_triangles(result.triangles), reference_delaunay(points));
  EXPECT_EQ(result.neighbors, reference_neighbors(result.triangles));
}

Coordinates random_box(FixtureRandom& random, std::size_t n, int side) {
  Coordinates points;
  for (std::size_t i = 0; i < 2 * n; ++i) points.push_back(static_cast<double>(random.integer(0, side)));
  return points;
}

TEST(Dwyer, SmallIntegersInSmallBoxes) {
  FixtureRandom random(1);
  for (int round = 0; round < 1500; ++round) {
    const auto n = static_cast<std::size_t>(random.integer(0, 24));
    expect_reference(random_box(random, n, static_cast<int>(random.integer(1, 6))));
  }
}

TEST(Dwyer, RandomDoublesOfAllMagnitudes) {
  FixtureRandom random(2);
  for (int round = 0; round < 300; ++round) {
    const double scale = std::ldexp(1, static_cast<int>(random.integer(-900, 900)));
    Coordinates points;
    for (int i = 0; i < 2 * 30; ++i) points.push_back((random.unit() - 0.5) * scale);
    expect_reference(points);
  }
}

TEST(Dwyer, SmallFixtures) {
  for (const Fixture& fixture : all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    for (const std::size_t n : {1, 2, 3, 4, 5, 6, 7, 8, 9, 13, 16, 33, 64}) {
      expect_reference(fixture.make(n, n));
      expect_reference(perturbed(fixture.make(n, n), n));
    }
  }
}

TEST(Dwyer, FixturesAreExact) {
  for (const Fixture& fixture : all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    for (const std::size_t n : {1000, 2500}) {
      const Coordinates points = fixture.make(n, 7);
      const Triangulation result = triangulate(points);
      const VerifyReport report = verify(points.data(), n, result.triangles, result.neighbors);
      EXPECT_TRUE(report.ok) << report.problem;
      EXPECT_EQ(report.hull_vertices, result.hull.size());
    }
  }
}

TEST(Dwyer, OrderOfThePointsDoesNotMatter) {
  for (const Fixture& fixture : all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Coordinates points = fixture.make(600, 3);
    const TriangleSet expected = sorted_triangles(triangulate(points).triangles);
    std::vector<std::size_t> permutation(600);
    std::iota(permutation.begin(), permutation.end(), std::size_t{0});
    FixtureRandom(4).shuffle(permutation);
    const Triangulation result = triangulate(permuted(points, permutation));
    // Back to the first order's indices, of which the smallest represents its duplicates.
    const std::vector<std::int32_t> representatives = triangulate(points).representatives;
    std::vector<std::int32_t> triangles;
    for (const std::int32_t i : result.triangles) triangles.push_back(representatives[permutation[i]]);
    EXPECT_EQ(sorted_triangles(triangles), expected);
  }
}

/// Lexicographic order in any frame: rotations by quarter turns give the same edges, so alternating cuts see
/// the same ties from all sides.
TEST(Dwyer, QuarterTurns) {
  FixtureRandom random(5);
  for (int round = 0; round < 100; ++round) {
    Coordinates points = random_box(random, 40, 8);
    for (int turn = 0; turn < 4; ++turn) {
      for (std::size_t i = 0; i < points.size(); i += 2) {
        const double x = points[i];
        points[i] = -points[i + 1];
        points[i + 1] = x;
      }
      expect_reference(points);
    }
  }
}

TEST(Dwyer, ManySets) {
  FixtureRandom random(6);
  Coordinates points;
  std::vector<std::size_t> offsets{0};
  std::vector<Coordinates> sets;
  for (int s = 0; s < 60; ++s) {
    sets.push_back(random_box(random, static_cast<std::size_t>(random.integer(0, 12)), 3));
    points.insert(points.end(), sets.back().begin(), sets.back().end());
    offsets.push_back(points.size() / 2);
  }
  const Triangulation result = research::triangulate_on_host(points.data(), offsets, dwyer_options());
  ASSERT_EQ(result.triangle_offsets.size(), offsets.size());
  for (std::size_t s = 0; s < sets.size(); ++s) {
    const Triangulation alone = triangulate(sets[s]);
    std::vector<std::int32_t> triangles, hull;
    for (std::size_t k = 3 * result.triangle_offsets[s]; k < 3 * result.triangle_offsets[s + 1]; ++k) {
      triangles.push_back(result.triangles[k] - static_cast<std::int32_t>(offsets[s]));
      const std::int32_t neighbor = result.neighbors[k];
      const auto local = static_cast<std::int32_t>(k - 3 * result.triangle_offsets[s]);
      EXPECT_EQ(neighbor < 0 ? -1 : neighbor - static_cast<std::int32_t>(result.triangle_offsets[s]),
                alone.neighbors[local]);
    }
    for (std::size_t k = result.hull_offsets[s]; k < result.hull_offsets[s + 1]; ++k) {
      hull.push_back(result.hull[k] - static_cast<std::int32_t>(offsets[s]));
    }
    EXPECT_EQ(triangles, alone.triangles);
    EXPECT_EQ(hull, alone.hull);
  }
}

TEST(Dwyer, StatisticsAndErrors) {
  const Coordinates points = make_fixture("half-duplicates", 1000, 1);
  Options options = dwyer_options();
  double last = 0;
  options.progress = [&](const std::string& stage, int, double done) {
    EXPECT_FALSE(stage.empty());
    EXPECT_GE(done, last);
    last = done;
  };
  const research::Triangulation result = triangulate(points, options);
  EXPECT_EQ(last, 1);
  EXPECT_EQ(result.statistics.device, "host");
  EXPECT_EQ(result.statistics.points, 1000U);
  EXPECT_GT(result.statistics.duplicates, 0U);
  EXPECT_EQ(result.statistics.triangles,
            2 * (1000 - result.statistics.duplicates) - 2 - result.statistics.hull_vertices);
  ASSERT_EQ(result.statistics.phases.size(), 3U);
  EXPECT_TRUE(result.work.levels.empty());
  options = dwyer_options();
  options.neighbors = false;
  EXPECT_TRUE(triangulate(points, options).neighbors.empty());

  const auto kind_of = [](const Coordinates& xy, const std::vector<std::size_t>& offsets, Mode mode) {
    Options with_mode;
    with_mode.mode = mode;
    try {
      research::triangulate_on_host(xy.data(), offsets, with_mode);
    } catch (const Error& error) {
      return error.kind();
    }
    return ErrorKind::internal;
  };
  EXPECT_EQ(kind_of(points, {0, 1000}, Mode::flattened), ErrorKind::usage);
  EXPECT_EQ(kind_of(points, {0, 1000}, Mode::partition), ErrorKind::usage);
  EXPECT_EQ(kind_of(points, {1, 1000}, Mode::dwyer), ErrorKind::usage);
  EXPECT_EQ(kind_of({0, 0, 1, std::numeric_limits<double>::infinity()}, {0, 2}, Mode::dwyer),
            ErrorKind::input);
  EXPECT_EQ(kind_of({1e300, 0, 1e-300, 1}, {0, 2}, Mode::dwyer), ErrorKind::input);
  EXPECT_EQ(kind_of(points, {0, std::size_t{1} << 30}, Mode::dwyer), ErrorKind::input);
}

constexpr auto kCut = static_cast<std::size_t>(Component::cut);
constexpr auto kMerge = static_cast<std::size_t>(Component::merge);

Work work_of(const Coordinates& points) {
  Options options = dwyer_options();
  options.count = true;
  return triangulate(points, options).work;
}

TEST(Work, ThreePointsByHand) {
  const Work work = work_of({0, 0, 1, 3, 2, 0});
  // Two sorts of three points.
  EXPECT_EQ(work.start[kCut].arithmetic, 2U * 3U);
  EXPECT_EQ(work.start[kCut].critical_path, 2U * 3U);
  ASSERT_EQ(work.levels.size(), 1U);
  EXPECT_EQ(work.levels[0][kCut].operations(), 0U);
  // A leaf that turns right, hence two orientations; 3 comparisons for its lowest and highest points.
  EXPECT_EQ(work.levels[0][kMerge].orientations, 2U);
  EXPECT_EQ(work.levels[0][kMerge].circles, 0U);
  EXPECT_EQ(work.levels[0][kMerge].arithmetic, 3U);
  EXPECT_EQ(work.levels[0][kMerge].critical_path, work.levels[0][kMerge].operations());
}

TEST(Work, FourPointsByHand) {
  // The halves are the edges 0-1 and 2-3; the tangents are horizontal, and the diagonal is tied: 0-1 to 2.
  const Work work = work_of({0, 0, 0, 2, 5, 0, 5, 2});
  ASSERT_EQ(work.levels.size(), 2U);
  EXPECT_EQ(work.levels[0][kCut].arithmetic, 4U);
  EXPECT_EQ(work.levels[0][kCut].critical_path, 1U + 2 * 2);
  EXPECT_EQ(work.levels[1][kCut].operations(), 0U);
  EXPECT_EQ(work.levels[1][kMerge].arithmetic, 2U) << "lowest and highest of two leaves, one comparison each";
  EXPECT_EQ(work.levels[1][kMerge].critical_path, 1U);
  EXPECT_EQ(work.levels[1][kMerge].orientations, 0U);
  const OperationCounts& merge = work.levels[0][kMerge];
  // Lower tangent: down on the left, no further on either side. Then three bases, two candidates each.
  EXPECT_EQ(merge.orientations, 3U + 3U * 2U);
  // Which of the first base's candidates; then whether the first point rules the second base's only one out.
  EXPECT_EQ(merge.circles, 2U);
  EXPECT_EQ(merge.arithmetic, 2U);
}

TEST(Work, RepeatsAndAddsUp) {
  for (const char* name : {"uniform", "kuzmin", "grid", "line"}) {
    SCOPED_TRACE(name);
    const std::size_t n = 4000;
    const Coordinates points = make_fixture(name, n, 1);
    const std::size_t distinct = n - triangulate(points).statistics.duplicates;
    const Work work = work_of(points), again = work_of(points);
    ASSERT_EQ(work.levels.size(), again.levels.size());
    EXPECT_LE(work.levels.size(), statistics::log2_ceiling(n));
    EXPECT_EQ(work.start[kCut].arithmetic,
              geometry::comparisons_to_sort(n) + geometry::comparisons_to_sort(distinct));
    std::uint64_t operations = 0;
    for (std::size_t l = 0; l < work.levels.size(); ++l) {
      for (std::size_t c = 0; c < kComponents; ++c) {
        const OperationCounts &counts = work.levels[l][c], &others = again.levels[l][c];
        EXPECT_EQ(counts.operations(), others.operations());
        EXPECT_EQ(counts.critical_path, others.critical_path);
        operations += counts.operations();
        if (c != kCut && c != kMerge) {
          EXPECT_EQ(counts.operations(), 0U);
        }
      }
      EXPECT_LE(work.levels[l][kMerge].critical_path, work.levels[l][kMerge].operations());
      EXPECT_LE(work.levels[l][kCut].arithmetic, distinct);
    }
    EXPECT_EQ(work.levels[0][kCut].arithmetic, distinct);
    EXPECT_EQ(work.levels[0][kMerge].critical_path, work.levels[0][kMerge].operations()) << "one node";
    EXPECT_GT(operations, 30 * distinct);
    EXPECT_LT(operations, 1000 * distinct);
  }
}

TEST(Work, CountingChangesNothing) {
  const Coordinates points = make_fixture("grid", 2000, 1);
  Options options = dwyer_options();
  options.count = true;
  EXPECT_EQ(triangulate(points, options).triangles, triangulate(points).triangles);
}

TEST(Work, SetsAreSideBySide) {
  const Coordinates one = make_fixture("uniform", 500, 1);
  Coordinates two = one;
  two.insert(two.end(), one.begin(), one.end());
  Options options = dwyer_options();
  options.count = true;
  const Work work = research::triangulate_on_host(two.data(), {0, 500, 1000}, options).work;
  const Work alone = work_of(one);
  ASSERT_EQ(work.levels.size(), alone.levels.size());
  EXPECT_EQ(work.start[kCut].operations(), 2 * alone.start[kCut].operations());
  EXPECT_EQ(work.start[kCut].critical_path, alone.start[kCut].critical_path);
  for (std::size_t l = 0; l < work.levels.size(); ++l) {
    EXPECT_EQ(work.levels[l][kMerge].operations(), 2 * alone.levels[l][kMerge].operations());
    EXPECT_EQ(work.levels[l][kMerge].critical_path, alone.levels[l][kMerge].critical_path);
  }
}

}  // namespace
}  // namespace flaunay::testing
