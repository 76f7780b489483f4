// The level loop: every stage of every level against its twin, on random and on degenerate input, under the
// device's own tuning and under one of odd, small sizes.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/flattened/support.hpp"
#include "tests/support/border_twin.hpp"
#include "tests/support/endgame_twin.hpp"

namespace flaunay::flattened {
namespace {

/// The convex hulls of sets, and the first regions.
struct BordersTwin {
  std::vector<int> hull;
  std::vector<std::size_t> hull_offsets{0};
  std::size_t triangles = 0;
  Regions regions;
  std::vector<bool> on_border;  ///< by id; collinear sets have nothing else
};

BordersTwin borders_twin(const ExactPoints& points, const std::vector<cl_int>& set_offsets,
                         const std::vector<cl_int>& y_order) {
  BordersTwin twin;
  twin.on_border.assign(points.size(), false);
  for (std::size_t s = 0; s + 1 < set_offsets.size(); ++s) {
    std::vector<int> ids(static_cast<std::size_t>(set_offsets[s + 1] - set_offsets[s]));
    std::iota(ids.begin(), ids.end(), set_offsets[s]);
    bool collinear = false;
    const std::vector<int> hull = testing::border_twin(points, ids, collinear);
    const std::size_t h = hull.size();
    for (const int id : hull) twin.on_border[static_cast<std::size_t>(id)] = true;
    Region region;
    if (!collinear) {
      twin.triangles += 2 * ids.size() - 2 - h;
      for (std::size_t k = 0; k < h; ++k)
        region.corners.push_back({hull[(k + h - 1) % h], hull[k], hull[(k + 1) % h]});
      const auto internal = [&](int id) { return !twin.on_border[static_cast<std::size_t>(id)]; };
      std::copy_if(ids.begin(), ids.end(), std::back_inserter(region.x_list), internal);
      std::copy_if(y_order.begin() + set_offsets[s], y_order.begin() + set_offsets[s + 1],
                   std::back_inserter(region.y_list), internal);
    }
    twin.regions.add(std::move(region));
    twin.hull.insert(twin.hull.end(), hull.begin(), hull.end());
    twin.hull_offsets.push_back(twin.hull.size());
  }
  return twin;
}

}  // namespace

/// Runs the level loop and holds every stage of every level against its twin, the twin being fed with what
/// the device had before. Stops at the first level that differs.
void check_levels(Runtime& runtime, const Coordinates& coordinates, const std::vector<std::size_t>& offsets,
                  const LoopOptions& options, Met& met) {
  Call call(runtime);
  Workspace& work = call.work;
  FixtureRandom random(coordinates.size());
  std::vector<std::int32_t> representatives(coordinates.size() / 2);
  PointTable table = ingest(work, coordinates.data(), offsets, representatives.data());
  if (options.undecided) work.bounds = kUndecided;
  const ExactPoints points(call.read(table.points, table.count));
  const auto set_offsets = call.read(table.set_offsets, table.sets + 1);

  Level level;
  RetiredRegions retired;
  const Borders borders = initial_borders(work, table, level, retired);
  const BordersTwin twin = borders_twin(points, set_offsets, call.read(table.y_order, table.count));
  EXPECT_TRUE(same(call.read(borders.hull, borders.size), twin.hull));
  EXPECT_TRUE(same(borders.hull_offsets, twin.hull_offsets));
  EXPECT_EQ(borders.triangles, twin.triangles);
  const auto side = call.read(table.side, table.count);
  for (std::size_t id = 0; id < table.count; ++id)
    ASSERT_EQ(side[id] == 2, twin.on_border[id]) << "id " << id;
  Regions regions = download(call, level, retired);
  ASSERT_TRUE(same_regions(regions, twin.regions));
  check_endgame(call, points, table, retired, regions.retired, met);
  std::size_t triangles = 0;
  const auto count_retired = [&] {
    for (const Region& region : regions.retired) triangles += testing::triangle_count_twin(region.corners);
    met.retired += regions.retired.size();
  };
  count_retired();

  std::size_t depth = 0;
  for (; level.regions > 0 && depth < options.levels && !::testing::Test::HasFailure(); ++depth) {
    SCOPED_TRACE("level " + std::to_string(depth) + " of " + std::to_string(level.regions) + " regions");
    Arena::Scope scope(work.scratch());
    ++met.levels;
    met.regions += level.regions;
    const int alternate = options.alternate ? static_cast<int>(depth % 2) : -1;
    const CutLevel cut = check_cut(call, points, table, level, regions.open, alternate, met);
    if (::testing::Test::HasFailure()) return;
    const std::vector<Frame>& frames = cut.frames;
    const std::vector<std::vector<int>>& expected_paths = cut.paths;

    if (options.parts) {
      // Paths through the ends, some vertices of the hull and some other points.
      std::vector<std::vector<int>> rough;
      for (std::size_t r = 0; r < regions.open.size(); ++r) {
        std::vector<int> some;
        const auto columns = points.lowest_by_u(frames[r], regions.open[r].points());
        const std::set<int> hull(expected_paths[r].begin(), expected_paths[r].end());
        for (std::size_t k = 0; k < columns.size(); ++k) {
          const bool is_end = k == 0 || k + 1 == columns.size();
          if (is_end || random.integer(0, hull.count(columns[k]) != 0 ? 2 : 20) == 0)
            some.push_back(columns[k]);
        }
        rough.push_back(some);
      }
      check_candidates(call, points, level, regions.open, frames);
      check_prune(call, points, table, level, regions.open, frames, rough, false);
      check_prune(call, points, table, level, regions.open, frames, expected_paths, true);
      check_quickhull(call, points, table, level, regions.open, frames, expected_paths, random);
      for (const Hull variant : {Hull::prune, Hull::quickhull, Hull::balanced}) {
        SCOPED_TRACE(to_string(variant));
        Arena::Scope variant_scope(work.scratch());
        work.hull = variant;
        LevelStatistics ignored;
        project(work, table, level);
        const Paths paths = hulls(work, table, level, ignored);
        work.hull = Hull::monotone_chain;
        expect_paths(call, paths, HostPaths(points, frames, expected_paths));
      }
    }

    {
      Arena::Scope lone_scope(work.scratch());
      LevelStatistics ignored;
      const auto flags = testing::guarded<cl_uchar>(runtime, level.corners);
      expect_paths(call, lone_paths(work, table, level, flags, ignored),
                   HostPaths(points, frames, expected_paths));
      const auto on_path = testing::download(runtime, flags, level.corners);
      const auto corner_ids = call.read(level.corner_ids, 3 * level.corners);
      const auto corner_regions = call.read(level.corner_regions, level.corners);
      for (std::size_t c = 0; c < level.corners; ++c) {
        const std::vector<int>& path = expected_paths[static_cast<std::size_t>(corner_regions[c])];
        ASSERT_EQ(on_path[c], std::count(path.begin(), path.end(), corner_ids[3 * c + 1])) << "corner " << c;
      }
    }

    const std::size_t undecided = call.undecided();
    LevelStatistics statistics;
    project(work, table, level);
    const Paths paths = hulls(work, table, level, statistics);
    met.undecided_hull += call.undecided() - undecided;
    met.survivors += statistics.survivors;
    for (const std::vector<int>& path : expected_paths) met.path_vertices += path.size();
    check_hulls(call, points, level, regions.open, frames, paths, expected_paths, met);
    if (::testing::Test::HasFailure()) return;

    Level next;
    Regions found = check_merge(call, points, table, level, regions.open, cut, paths, next, retired, met);
    if (::testing::Test::HasFatalFailure()) return;
    regions = std::move(found);
    check_endgame(call, points, table, retired, regions.retired, met);
    count_retired();
    level = next;
  }
  if (level.regions == 0) {
    EXPECT_EQ(triangles, borders.triangles);
  }
  EXPECT_EQ(call.broken(), 0);
}

void check_levels(Runtime& runtime, const Coordinates& coordinates, const LoopOptions& options, Met& met) {
  check_levels(runtime, coordinates, {0, coordinates.size() / 2}, options, met);
}

void check_fixtures(const std::vector<std::string>& names, std::size_t n, const LoopOptions& options,
                    Met& met) {
  under_each_tuning([&](Runtime& runtime) {
    for (const std::string& name : names) {
      SCOPED_TRACE(name);
      check_levels(runtime, make_fixture(name, n, 7), options, met);
    }
  });
}

namespace {

TEST(SmallLevelLoop, GridAndScatter) {
  Met met;
  check_fixtures({"grid", "uniform"}, 25, {}, met);
  check_fixtures({"small-integers"}, 20, {true, false, false, 1000}, met);
  EXPECT_GT(met.merge.corners_by_parts[2], 0u);
  EXPECT_GT(met.retired, 4u);
}

TEST(SmallLevelLoop, ManySets) {
  Met met;
  under_each_tuning([&](Runtime& runtime) {
    FixtureRandom random(8);
    check_levels(runtime, coarse_points(40, 3, random), {0, 0, 9, 12, 30, 30, 40}, {}, met);
  });
  EXPECT_GT(met.regions, 2u);
}

TEST(LevelLoop, GeneralPosition) {
  Met met;
  check_fixtures({"uniform", "normal", "kuzmin", "line", "clusters", "spiral", "log-spiral", "slender",
                  "corners", "far-away", "parabola"},
                 700, {}, met);
  EXPECT_GT(met.levels, 80u);
  EXPECT_GT(met.merge.corners_by_parts[1], 0u);
  EXPECT_GT(met.merge.corners_by_parts[2], 0u);
  EXPECT_GT(met.merge.corners_by_parts[3], 0u);
  EXPECT_GT(met.merge.path_leaves_region, 0u);
  EXPECT_GT(met.merge.path_on_border, 0u);
  EXPECT_GT(met.merge.pinch_points, 0u);
  EXPECT_GT(met.undecided_hull, 0u);
  EXPECT_GT(met.large, 0u);
}

TEST(LevelLoop, Degenerate) {
  Met met;
  check_fixtures({"grid", "rotated-grid", "hexagonal", "circle", "integer-circle", "nested-circles",
                  "columns", "small-integers", "half-duplicates", "two-lines", "thirty-lines", "star",
                  "integer-star", "circle-few-inside", "ladder", "apex", "triangle-edges", "random-integers"},
                 500, {}, met);
  EXPECT_GT(met.merge.corners_by_parts[1], 0u);
  EXPECT_GT(met.merge.corners_by_parts[2], 0u);
  EXPECT_GT(met.merge.corners_by_parts[3], 0u);
  EXPECT_GT(met.merge.path_leaves_region, 0u);
  EXPECT_GT(met.merge.path_on_border, 0u);
  EXPECT_GT(met.merge.pinch_points, 0u);
  EXPECT_GT(met.mirrored_ends, 0u);
  EXPECT_GT(met.equal_u, 0u);
  EXPECT_GT(met.equal_projections, 0u);
  EXPECT_GT(met.on_chord, 0u);
  EXPECT_GT(met.large, 0u);
}

TEST(LevelLoop, UndecidedPredicates) {
  Met met;
  under_each_tuning([&](Runtime& runtime) {
    for (const char* const name :
         {"grid", "small-integers", "integer-circle", "hexagonal", "thirty-lines", "ladder"}) {
      SCOPED_TRACE(name);
      check_levels(runtime, long_numbers(name, 400, 9), {}, met);
    }
  });
  EXPECT_GT(met.undecided_hull, 10u);
  EXPECT_GT(met.undecided_endgame + met.large, 10u);
  EXPECT_GT(met.merge.corners_by_parts[3], 0u);
  EXPECT_GT(met.merge.pinch_points, 0u);
}

TEST(LevelLoop, NothingFiltered) {
  Met met;
  check_fixtures({"uniform", "kuzmin", "grid", "random-integers", "columns", "log-spiral"}, 300,
                 {true, false, true, 1000}, met);
  EXPECT_GT(met.undecided_hull, 1000u);
  EXPECT_GT(met.undecided_merge, 1000u);
  EXPECT_GT(met.undecided_endgame + met.large, 100u);
}

/// Squares with one or two points inside, and some without: as many regions as sets.
TEST(LevelLoop, AHundredThousandTinyRegions) {
  Met met;
  for (const bool small : kSmall) {
    FixtureRandom random(13);
    Coordinates points;
    std::vector<std::size_t> offsets{0};
    std::size_t open = 0;
    for (int s = 0; s < (small ? 5000 : 110000); ++s) {
      for (const double corner : {0.0, 0.0, 8.0, 0.0, 8.0, 8.0, 0.0, 8.0}) points.push_back(corner);
      const std::int64_t inside = s % 10 == 9 ? 0 : random.integer(1, 2);
      for (std::int64_t i = 0; i < 2 * inside; ++i)
        points.push_back(static_cast<double>(random.integer(1, 7)));
      open += inside > 0;
      offsets.push_back(points.size() / 2);
    }
    const std::size_t before = met.regions;
    check_levels(Runtimes::get(small), points, offsets, {false, false, false, 1000}, met);
    EXPECT_GE(met.regions - before, open);
  }
  EXPECT_GT(met.regions, 100000u);
}

}  // namespace

}  // namespace flaunay::flattened
