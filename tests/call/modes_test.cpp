// Every mode, hull variant and cut gives the same result as the flattened triangulator, degenerate input
// included.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/files/points.hpp"
#include "flaunay/flaunay.hpp"
#include "flaunay/research.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/same.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {
namespace {

using research::Cut;
using research::Finish;
using research::Hull;
using research::Mode;
using research::Options;
using research::Triangulation;

Triangulation triangulate(const Coordinates& points, const Options& options) {
  return research::triangulate(triangulator(), points.data(), points.size() / 2, options);
}

struct Execution {
  std::string name;
  Options options;
};

/// All executions but blocks, the default. one_by_one: also those that take a second for a thousand points.
std::vector<Execution> executions(bool one_by_one) {
  std::vector<Execution> all;
  const auto add = [&all](Mode mode, Hull hull, Cut cut, int levels) {
    Options options;
    options.mode = mode;
    options.hull = hull;
    options.cut = cut;
    options.partition_levels = levels;
    options.threads = levels % 3 + 1;
    std::string name = std::string(to_string(mode)) + " " + to_string(hull);
    if (cut == Cut::alternate) name += " alternate";
    if (levels > 0) name += " levels " + std::to_string(levels);
    all.push_back({name, options});
  };
  for (const Cut cut : {Cut::interquartile, Cut::alternate}) {
    for (const Hull hull : {Hull::prune, Hull::quickhull, Hull::balanced}) {
      add(Mode::flattened, hull, cut, 0);
      add(Mode::recursive, hull, cut, 0);
      if (one_by_one) add(Mode::recursive_device, hull, cut, 0);
    }
    add(Mode::recursive, Hull::monotone_chain, cut, 0);
    for (const int levels : {0, 1, 2, 5, 30}) add(Mode::partition, Hull::prune, cut, levels);
  }
  add(Mode::partition, Hull::balanced, Cut::interquartile, 3);
  add(Mode::dwyer, Hull::prune, Cut::interquartile, 0);
  // The levels of mode flattened end in blocks unless it is told otherwise.
  for (const Cut cut : {Cut::interquartile, Cut::alternate}) {
    add(Mode::flattened, Hull::prune, cut, 0);
    all.back().name += " to the bottom";
    all.back().options.finish = Finish::levels;
  }
  return all;
}

void expect_all_same(const Coordinates& points, bool one_by_one) {
  const Triangulation expected = triangulate(points, {});
  for (const Execution& execution : executions(one_by_one)) {
    SCOPED_TRACE(execution.name);
    expect_same_but_for_order(triangulate(points, execution.options), expected);
    if (::testing::Test::HasFailure()) return;
  }
}

class OnFixture : public ::testing::TestWithParam<std::string> {};

TEST_P(OnFixture, EveryModeIsTheSame) {
  for (const std::size_t n : {1, 2, 3, 4, 5, 7, 12, 60}) {
    SCOPED_TRACE(n);
    expect_all_same(make_fixture(GetParam(), n, n), true);
  }
  SCOPED_TRACE("perturbed");
  expect_all_same(perturbed(make_fixture(GetParam(), 50, 2), 3), true);
}

TEST_P(OnFixture, EveryModeIsTheSameAtThousands) {
  expect_all_same(make_fixture(GetParam(), 3000, 4), false);
}

// Tiny inputs take levels and blocks, with regions of all kinds: cocircular polygons across borders, borders
// that touch themselves, vertices with several corners.
TEST_P(OnFixture, FlattenedEndsInBlocks) {
  for (const std::size_t most : {1, 2, 6, 40}) {
    Triangulator& tuned = triangulator_with("small-blocks,region_points=" + std::to_string(most));
    for (const std::size_t n : {3, 7, 12, 30, 200, 900}) {
      // More levels than 200 points have, once: with the tiniest regions, each takes as many launches again.
      if (n == 900 && most != 6) continue;
      SCOPED_TRACE(std::to_string(n) + " points, regions of " + std::to_string(most));
      const Coordinates points = make_fixture(GetParam(), n, n);
      const Coordinates moved = perturbed(make_fixture(GetParam(), n, 2), 3);
      for (const Coordinates& input : {points, moved}) {
        const Triangulation expected = triangulate(input, {});
        for (const Cut cut : {Cut::interquartile, Cut::alternate}) {
          Options options;
          options.mode = Mode::flattened;
          options.cut = cut;
          expect_same_but_for_order(research::triangulate(tuned, input.data(), n, options), expected);
        }
      }
      if (HasFailure()) return;
    }
  }
}

TEST(Modes, FlattenedSetsEndInBlocks) {
  Coordinates points;
  std::vector<std::size_t> offsets{0, 0};
  std::size_t size = 1;
  for (int k = 0; k < 2; ++k) {
    for (const Fixture& fixture : all_fixtures()) {
      const Coordinates set = fixture.make(size % 97, size);
      points.insert(points.end(), set.begin(), set.end());
      offsets.push_back(points.size() / 2);
      size += 13;
    }
  }
  const Triangulation expected = research::triangulate(triangulator(), points.data(), offsets, {});
  Options options;
  options.mode = Mode::flattened;
  for (const char* const name : {"small-blocks", "small-blocks,region_points=30", "cpu,region_points=6"}) {
    SCOPED_TRACE(name);
    expect_same_but_for_order(research::triangulate(triangulator_with(name), points.data(), offsets, options),
                              expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Fixtures, OnFixture, ::testing::ValuesIn(fixture_names()), instance_name);

TEST(Modes, OnFiles) {
  for (const std::string& file : data_files()) {
    SCOPED_TRACE(file);
    Coordinates points = io::read_points(test_data() + "/" + file).coordinates;
    const bool is_small = points.size() < 300;
    points.resize(std::min<std::size_t>(points.size(), 20000));
    expect_all_same(points, is_small);
    if (is_small) expect_all_same(scaled(points, 1e-150), false);
  }
}

TEST(Modes, ManySets) {
  Coordinates points;
  std::vector<std::size_t> offsets{0, 0};
  for (const Fixture& fixture : all_fixtures()) {
    for (const std::size_t n : {0, 1, 3, 40}) {
      const Coordinates set = fixture.make(n, n + 1);
      points.insert(points.end(), set.begin(), set.end());
      offsets.push_back(points.size() / 2);
    }
  }
  const auto run = [&](const Options& options) {
    return research::triangulate(triangulator(), points.data(), offsets, options);
  };
  const Triangulation expected = run({});
  for (const Execution& execution : executions(false)) {
    SCOPED_TRACE(execution.name);
    expect_same_but_for_order(run(execution.options), expected);
  }
  Options one_by_one;
  one_by_one.mode = Mode::recursive_device;
  expect_same_but_for_order(run(one_by_one), expected);
}

TEST(Modes, SetsOfEveryScale) {
  Coordinates points;
  std::vector<std::size_t> offsets{0};
  for (const int exponent : {-1000, 0, 900, -400, 300}) {
    const Coordinates set = scaled(make_fixture("kuzmin", 70, 3), std::ldexp(1.0, exponent));
    points.insert(points.end(), set.begin(), set.end());
    offsets.push_back(points.size() / 2);
  }
  const auto run = [&](const Options& options) {
    return research::triangulate(triangulator(), points.data(), offsets, options);
  };
  const Triangulation expected = run({});
  EXPECT_EQ(expected.triangle_offsets.back() % 5, 0u);
  for (const Execution& execution : executions(true)) {
    SCOPED_TRACE(execution.name);
    expect_same_but_for_order(run(execution.options), expected);
  }
}

TEST(Modes, NoPoints) {
  for (const Execution& execution : executions(true)) {
    SCOPED_TRACE(execution.name);
    const Triangulation none = triangulate({}, execution.options);
    EXPECT_TRUE(none.triangles.empty());
    EXPECT_EQ(none.triangle_offsets, (std::vector<std::size_t>{0, 0}));
  }
}

/// Bytes do not depend on the work before, nor on the number of threads.
TEST(Modes, AreDeterministic) {
  const Coordinates points = make_fixture("kuzmin", 5000, 8);
  for (const Execution& execution : executions(false)) {
    SCOPED_TRACE(execution.name);
    const Triangulation once = triangulate(points, execution.options);
    Options again = execution.options;
    again.threads = 5;
    triangulate(make_fixture("grid", 700, 1), again);
    const Triangulation twice = triangulate(points, again);
    EXPECT_EQ(once.triangles, twice.triangles);
    EXPECT_EQ(once.neighbors, twice.neighbors);
  }
}

TEST(Modes, BadInputIsTheSameErrorInAll) {
  Coordinates not_finite = make_fixture("uniform", 50, 1);
  not_finite[31] = std::nan("");
  const Coordinates too_far_apart{0, 0, 1e200, 1, 1e-200, 2, 3, 4};
  for (const Coordinates& points : {not_finite, too_far_apart}) {
    const std::string expected = error_of(ErrorKind::input, [&] { triangulate(points, {}); });
    ASSERT_NE(expected, "no error");
    for (const Execution& execution : executions(true)) {
      EXPECT_EQ(error_of(ErrorKind::input, [&] { triangulate(points, execution.options); }), expected)
          << execution.name;
    }
  }
}

TEST(Modes, RequestsWithoutSense) {
  const Coordinates points = make_fixture("uniform", 50, 1);
  for (const Mode mode : {Mode::flattened, Mode::recursive_device, Mode::partition}) {
    Options options;
    options.mode = mode;
    options.hull = Hull::monotone_chain;
    EXPECT_THROW(triangulate(points, options), Error) << to_string(mode);
  }
  EXPECT_THROW(research::triangulate_on_host(points.data(), {0, 50}, {}), Error);
  EXPECT_THROW(research::partition(triangulator(), points.data(), 50, -1), Error);
}

// -----------------------------------------------------------------------------------------------------------
// Partitions

/// Each region's points triangulated on their own, put together again.
flaunay::Triangulation solved(const Coordinates& points, int levels) {
  const research::Partition partition =
      research::partition(triangulator(), points.data(), points.size() / 2, levels);
  std::vector<std::vector<std::int32_t>> solutions;
  for (const research::Region& region : partition.regions) {
    Coordinates own;
    for (const std::int32_t i : region.points) {
      own.push_back(points[2 * i]);
      own.push_back(points[2 * i + 1]);
    }
    Options dwyer;
    dwyer.mode = Mode::dwyer;
    solutions.push_back(
        research::triangulate_on_host(own.data(), {0, region.points.size()}, dwyer).triangles);
  }
  return research::assemble(points.data(), points.size() / 2, partition, solutions);
}

TEST(Partition, PutTogetherAgainIsTheSame) {
  for (const Fixture& fixture : all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Coordinates points = fixture.make(1200, 6);
    const Triangulation expected = triangulate(points, {});
    for (const int levels : {0, 1, 3, 6, 30}) {
      SCOPED_TRACE(levels);
      expect_same_but_for_order(solved(points, levels), expected);
    }
  }
}

TEST(Partition, HasAsManyRegionsAsLevelsAllow) {
  const Coordinates points = make_fixture("uniform", 5000, 1);
  for (const int levels : {0, 1, 2, 4}) {
    const research::Partition partition = research::partition(triangulator(), points.data(), 5000, levels);
    EXPECT_EQ(partition.regions.size(), std::size_t{1} << levels);
    EXPECT_TRUE(partition.triangles.empty());
    std::size_t total = 0;
    for (const research::Region& region : partition.regions) {
      total += region.points.size();
      EXPECT_GT(region.border.size(), 4u);
    }
    EXPECT_GE(total, 5000u);
    EXPECT_LT(total, 5000u + 400u * partition.regions.size());
  }
  // All the way down nothing is left but triangles.
  const research::Partition whole = research::partition(triangulator(), points.data(), 5000, 30);
  EXPECT_TRUE(whole.regions.empty());
  EXPECT_EQ(whole.triangles.size(), 3 * whole.statistics.triangles);
}

// -----------------------------------------------------------------------------------------------------------
// What flattening saves

TEST(RecursiveDevice, LaunchesAndWaitsForEveryRegion) {
  const Coordinates points = make_fixture("uniform", 2000, 1);
  Options one_by_one;
  one_by_one.mode = Mode::recursive_device;
  Options all_at_once;
  all_at_once.mode = Mode::flattened;
  all_at_once.finish = Finish::levels;
  const Triangulation flattened = triangulate(points, all_at_once);
  const Triangulation recursive = triangulate(points, one_by_one);
  ASSERT_EQ(recursive.levels.size(), flattened.levels.size());
  std::size_t regions = 0;
  for (std::size_t l = 0; l < recursive.levels.size(); ++l) {
    const research::LevelStatistics& one = recursive.levels[l];
    const research::LevelStatistics& all = flattened.levels[l];
    EXPECT_EQ(one.regions, all.regions);
    EXPECT_EQ(one.internal_points, all.internal_points);
    EXPECT_EQ(one.corners, all.corners);
    EXPECT_EQ(one.largest_region, all.largest_region);
    EXPECT_EQ(one.path_vertices, all.path_vertices);
    regions += one.regions;
  }
  EXPECT_GT(recursive.statistics.kernel_launches, 20 * regions);
  // The host does not wait for itself.
  if (device_under_test() != "host") {
    EXPECT_GT(recursive.statistics.host_waits, regions);
  }
  EXPECT_GT(recursive.statistics.kernel_launches, 10 * flattened.statistics.kernel_launches);
}

}  // namespace
}  // namespace flaunay::testing
