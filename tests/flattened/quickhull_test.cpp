// The stage `quickhull`: the strict hulls of projections, and their clean-up.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <set>
#include <vector>

#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

/// All points of each region in any order, below the chord between its ends.
HullPoints upload_hull_points(Call& call, const ExactPoints& points, const std::vector<Frame>& frames,
                              const std::vector<std::vector<int>>& ids_of_regions,
                              const std::vector<std::vector<int>>& ends) {
  std::vector<cl_int> ids, segments, first;
  std::vector<cl_double2> projections;
  for (std::size_t r = 0; r < ids_of_regions.size(); ++r) {
    first.push_back(static_cast<cl_int>(ids.size()));
    for (const int id : ids_of_regions[r]) {
      ids.push_back(id);
      segments.push_back(static_cast<cl_int>(2 * r));
      projections.push_back(projected(frames[r], points[id]));
    }
    first.push_back(static_cast<cl_int>(ids.size()));
  }
  first.push_back(static_cast<cl_int>(ids.size()));
  HullPoints uploaded;
  uploaded.size = ids.size();
  uploaded.ids = testing::upload(call.runtime, ids);
  uploaded.segments = testing::upload(call.runtime, segments);
  uploaded.projections = testing::upload(call.runtime, projections);
  uploaded.ends = upload_paths(call, HostPaths(points, frames, ends));
  uploaded.first = testing::upload(call.runtime, first);
  return uploaded;
}

}  // namespace

/// Quickhull with nothing pruned and points in any order; then the clean-up of a path of all columns.
void check_quickhull(Call& call, const ExactPoints& points, const PointTable& table, const Level& level,
                     const std::vector<Region>& regions, const std::vector<Frame>& frames,
                     const std::vector<std::vector<int>>& expected, FixtureRandom& random) {
  Arena::Scope scope(call.work.scratch());
  std::vector<std::vector<int>> shuffled, columns, ends;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    shuffled.push_back(regions[r].points());
    random.shuffle(shuffled.back());
    ends.push_back({expected[r].front(), expected[r].back()});
    columns.push_back(points.lowest_by_u(frames[r], shuffled.back()));
  }
  const HostPaths expected_paths(points, frames, expected);
  int rounds = 0;
  const Paths path =
      quickhull(call.work, table, level, upload_hull_points(call, points, frames, shuffled, ends), rounds);
  {
    SCOPED_TRACE("quickhull");
    expect_paths(call, strict(call.work, table, level, path), expected_paths);
  }
  SCOPED_TRACE("strict");
  const Paths all_columns = upload_paths(call, HostPaths(points, frames, columns));
  expect_paths(call, strict(call.work, table, level, all_columns), expected_paths);
}

void check_hulls(Call& call, const ExactPoints& points, const Level& level,
                 const std::vector<Region>& regions, const std::vector<Frame>& frames, const Paths& paths,
                 const std::vector<std::vector<int>>& expected, Met& met) {
  SCOPED_TRACE("hulls");
  expect_paths(call, paths, HostPaths(points, frames, expected));
  // Nothing on the path is dropped by prune.
  const auto flags = call.read(paths.flags, level.points + level.corners);
  const auto corner_ids = call.read(level.corner_ids, 3 * level.corners);
  std::size_t i = 0, c = 0, dropped_from_path = 0;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const std::set<int> on_path(expected[r].begin(), expected[r].end());
    for (const int id : frames[r].axis == 1 ? regions[r].x_list : regions[r].y_list) {
      dropped_from_path += on_path.count(id) != 0 && flags[i] == 0;
      ++i;
    }
    for (std::size_t k = 0; k < regions[r].corners.size(); ++k, ++c) {
      dropped_from_path += on_path.count(corner_ids[3 * c + 1]) != 0 && flags[level.points + c] == 0;
    }
    const std::vector<int> all = regions[r].points();
    if (all.size() > 2000) continue;
    for (const int id : all) {
      if (on_path.count(id) != 0) continue;
      const auto above =
          std::upper_bound(expected[r].begin(), expected[r].end(), frames[r].u(points[id]),
                           [&](double value, int other) { return value < frames[r].u(points[other]); });
      const int v = *(above - 1);
      if (frames[r].u(points[v]) == frames[r].u(points[id])) {
        ++met.equal_u;
        // Mirror images have s - q of opposite signs and nothing between them.
        met.equal_projections +=
            frames[r].s(points[v]) - frames[r].q == frames[r].q - frames[r].s(points[id]);
      } else {
        met.on_chord += points.depth_sign(frames[r], v, *above, id) == 0;
      }
    }
  }
  EXPECT_EQ(dropped_from_path, 0u);
}

/// A parabola's points and one far below: each round lays bare one more vertex on either side, until
/// quickhull of what is left ends that. Two regions, so that only one of them has much to do.
void check_restart(Runtime& runtime) {
  Call call(runtime);
  constexpr int kHalf = 40;
  std::vector<cl_double2> places;
  for (int i = -kHalf; i <= kHalf; ++i) {
    places.push_back({{static_cast<double>(i), i == 0 ? -1000.0 * kHalf * kHalf : 1.0 * i * i}});
  }
  const ExactPoints points(places);
  PointTable table;
  table.count = places.size();
  table.points = testing::upload(runtime, places);
  std::vector<int> all(places.size());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<int> some{0, 3, kHalf};
  const std::vector<Frame> frames{{2, 0.0}, {2, 0.0}};
  Level level;
  level.regions = 2;
  level.axis = testing::upload(runtime, std::vector<cl_int>{2, 2});
  level.cut = testing::upload(runtime, std::vector<cl_double>{0.0, 0.0});
  const std::vector<int> expected{0, kHalf, 2 * kHalf};
  ASSERT_EQ(points.lower_hull(frames[0], all), expected);
  for (const Bounds& bounds : {Bounds{}, kUndecided}) {
    call.work.bounds = bounds;
    const Paths paths = upload_paths(call, HostPaths(points, frames, {all, some}));
    expect_paths(call, strict(call.work, table, level, paths),
                 HostPaths(points, frames, {expected, points.lower_hull(frames[1], some)}));
  }
}

namespace {

/// Points (2^i, 4^i): the deepest is always next to the end, so that splits by depth alone take a round each.
TEST(Quickhull, BalancesAfterManyRounds) {
  under_each_tuning([](Runtime& runtime) {
    Call call(runtime);
    constexpr int kPoints = 120;
    std::vector<cl_double2> places;
    for (int i = 0; i < kPoints; ++i) places.push_back({{std::ldexp(1.0, i), std::ldexp(1.0, 2 * i)}});
    const ExactPoints points(places);
    PointTable table;
    table.count = kPoints;
    table.points = testing::upload(runtime, places);
    std::vector<int> all(kPoints);
    std::iota(all.begin(), all.end(), 0);
    const std::vector<Frame> frames{{2, 0.0}};
    Level level;
    level.regions = 1;
    level.axis = testing::upload(runtime, std::vector<cl_int>{2});
    level.cut = testing::upload(runtime, std::vector<cl_double>{0.0});
    const HullPoints hull_points = upload_hull_points(call, points, frames, {all}, {{0, kPoints - 1}});
    call.work.bounds = {1e-14, 1e-14, 1e-14};
    int rounds = 0;
    const Paths paths = quickhull(call.work, table, level, hull_points, rounds);
    EXPECT_GT(rounds, 64);   // so the balanced ones were met
    EXPECT_LT(rounds, 100);  // and were fewer
    ASSERT_EQ(points.lower_hull(frames[0], all), all);
    expect_paths(call, strict(call.work, table, level, paths), HostPaths(points, frames, {all}));
  });
}

TEST(Quickhull, CleanUpThatLaysBareOneVertexAtATime) { under_each_tuning(check_restart); }

}  // namespace

}  // namespace flaunay::flattened
