// What no whole triangulation shows of the stages: what later steps mend, hulls that need many rounds, and
// broken invariants.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "launchers/flattened/border.cl.hpp"
#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

/// Regions of one planar lower hull each, whose points are their own projections.
struct PlanarHulls {
  PlanarHulls(Runtime& runtime, std::vector<cl_double2> points, std::size_t regions)
      : call(runtime), places(std::move(points)) {
    table.count = places.size();
    table.points = testing::upload(runtime, places);
    level.regions = regions;
    level.axis = testing::upload(runtime, std::vector<cl_int>(regions, 2));
    level.cut = testing::upload(runtime, std::vector<cl_double>(regions, 0.0));
  }

  /// (height, along)
  std::vector<cl_double2> projections(const std::vector<cl_int>& ids) const {
    std::vector<cl_double2> all;
    for (const cl_int id : ids) {
      all.push_back({{places[static_cast<std::size_t>(id)].s[1], places[static_cast<std::size_t>(id)].s[0]}});
    }
    return all;
  }
  Paths upload(const std::vector<std::vector<cl_int>>& paths) {
    std::vector<cl_int> vertices, regions, offsets{0};
    for (const std::vector<cl_int>& path : paths) {
      vertices.insert(vertices.end(), path.begin(), path.end());
      regions.insert(regions.end(), path.size(), static_cast<cl_int>(offsets.size()) - 1);
      offsets.push_back(static_cast<cl_int>(vertices.size()));
    }
    Paths uploaded;
    uploaded.size = vertices.size();
    uploaded.vertices = testing::upload(call.runtime, vertices);
    uploaded.projections = testing::upload(call.runtime, projections(vertices));
    uploaded.regions = testing::upload(call.runtime, regions);
    uploaded.offsets = testing::upload(call.runtime, offsets);
    return uploaded;
  }
  /// What the strict hulls of paths are.
  void expect_strict(const Paths& paths, const std::vector<std::vector<cl_int>>& expected) {
    const Paths hulls = strict(call.work, table, level, paths);
    const std::vector<cl_int> offsets = call.read(hulls.offsets, expected.size() + 1);
    const auto vertices = call.read(hulls.vertices, static_cast<std::size_t>(offsets.back()));
    for (std::size_t r = 0; r < expected.size(); ++r) {
      EXPECT_EQ(std::vector<cl_int>(vertices.begin() + offsets[r], vertices.begin() + offsets[r + 1]),
                expected[r]);
    }
  }

  Call call;
  std::vector<cl_double2> places;
  PointTable table;
  Level level;
};

/// A parabola's points and one far below: each round lays bare one more vertex on either side, until
/// quickhull of what is left ends that. Two regions, so that only one of them has much to do.
TEST(Quickhull, CleanUpThatLaysBareOneVertexAtATime) {
  under_each_tuning([](Runtime& runtime) {
    constexpr int kHalf = 40;
    std::vector<cl_double2> places;
    for (int i = -kHalf; i <= kHalf; ++i) {
      places.push_back({{static_cast<double>(i), i == 0 ? -1000.0 * kHalf * kHalf : 1.0 * i * i}});
    }
    PlanarHulls hulls(runtime, places, 2);
    std::vector<cl_int> all(places.size());
    std::iota(all.begin(), all.end(), 0);
    for (const Bounds& bounds : {Bounds{}, kUndecided}) {
      hulls.call.work.bounds = bounds;
      hulls.expect_strict(hulls.upload({all, {0, 3, kHalf}}), {{0, kHalf, 2 * kHalf}, {0, kHalf}});
    }
  });
}

/// Points (2^i, 4^i): the deepest is always next to the end, so that splits by depth alone take a round each.
TEST(Quickhull, BalancesAfterManyRounds) {
  under_each_tuning([](Runtime& runtime) {
    constexpr int kPoints = 120;
    std::vector<cl_double2> places;
    for (int i = 0; i < kPoints; ++i) places.push_back({{std::ldexp(1.0, i), std::ldexp(1.0, 2 * i)}});
    PlanarHulls hulls(runtime, places, 1);
    std::vector<cl_int> all(kPoints);
    std::iota(all.begin(), all.end(), 0);
    HullPoints points;
    points.size = kPoints;
    points.ids = testing::upload(runtime, all);
    points.segments = testing::upload(runtime, std::vector<cl_int>(kPoints, 0));
    points.projections = testing::upload(runtime, hulls.projections(all));
    points.ends = hulls.upload({{0, kPoints - 1}});
    points.first = testing::upload(runtime, std::vector<cl_int>{0, kPoints, kPoints});
    hulls.call.work.bounds = {1e-14, 1e-14, 1e-14};
    int rounds = 0;
    const Paths paths = quickhull(hulls.call.work, hulls.table, hulls.level, points, rounds);
    EXPECT_GT(rounds, 64);   // so the balanced ones were met
    EXPECT_LT(rounds, 100);  // and were fewer
    hulls.expect_strict(paths, {all});
  });
}

/// Points below a chord, on it and above it, which later steps would tell apart, too: in the plane, and
/// projected from a circle about a point of the cut.
TEST(SmallHullDepth, IsDecidedExactly) {
  under_each_tuning([](Runtime& runtime) {
    PlanarHulls hulls(
        runtime,
        {{{0, 0}}, {{4, 4}}, {{2, 1}}, {{2, 2}}, {{2, 3}}, {{4, -3}}, {{3, 4}}, {{4, 0}}, {{5, 0}}, {{6, 0}}},
        6);
    hulls.level.axis = testing::upload(runtime, std::vector<cl_int>{2, 2, 2, 0, 0, 0});
    const Paths chords = hulls.upload({{0, 1}, {0, 1}, {0, 1}, {5, 6}, {5, 6}, {5, 6}});
    const auto ids = testing::upload(runtime, std::vector<cl_int>{2, 3, 4, 7, 8, 9});
    const auto first = testing::upload(runtime, std::vector<cl_int>{0, 2, 4, 6, 8, 10});
    for (const cl_uchar keep_on : {0, 1}) {
      const auto flags = testing::upload(runtime, std::vector<cl_uchar>(6, 2));
      decide_depths(hulls.call.work, hulls.table, hulls.level, chords, ids, first, 6, keep_on != 0, flags);
      EXPECT_EQ(testing::download(runtime, flags, 6), (std::vector<cl_uchar>{1, keep_on, 0, 1, keep_on, 0}));
    }
    const auto flags =
        testing::upload(runtime, std::vector<cl_uchar>{1, 2, 1, 1, 2, 1, 1, 2, 1, 1, 2, 1, 1, 2, 1, 1, 7, 1});
    const Paths paths = hulls.upload({{0, 2, 1}, {0, 3, 1}, {0, 4, 1}, {5, 7, 6}, {5, 8, 6}, {5, 9, 6}});
    decide_vertices(hulls.call.work, hulls.table, hulls.level, paths, flags);
    // What is decided already stays.
    EXPECT_EQ(testing::download(runtime, flags, 18),
              (std::vector<cl_uchar>{1, 1, 1, 1, 0, 1, 1, 0, 1, 1, 1, 1, 1, 0, 1, 1, 7, 1}));
  });
}

/// The ends of the lower and of the upper hull, of which the hull stages would also mend others.
TEST(Borders, SetEndsAreTheLowestOfTheOutermostColumns) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(28);
    for (const int values : {1, 3, 50}) {
      Call call(runtime);
      const auto offsets = random_offsets(500, 15, random);
      const Coordinates coordinates = coarse_points(offsets.back(), values, random);
      std::vector<std::int32_t> representatives(offsets.back());
      const PointTable table = ingest(call.work, coordinates.data(), offsets, representatives.data());
      // Ids are in the order of (x, y).
      const auto points = call.read(table.points, table.count);
      const auto ids = call.read(table.set_offsets, table.sets + 1);
      std::vector<cl_int> first_ends, last_ends;
      for (std::size_t s = 0; s < table.sets; ++s) {
        const cl_int low = ids[s], high = ids[s + 1];
        cl_int last_of_first = low, first_of_last = high - 1;
        while (last_of_first + 1 < high && points[last_of_first + 1].s[0] == points[low].s[0])
          ++last_of_first;
        while (first_of_last > low && points[first_of_last - 1].s[0] == points[high - 1].s[0])
          --first_of_last;
        const bool is_empty = low == high;
        first_ends.insert(first_ends.end(), {is_empty ? -1 : low, is_empty ? -1 : high - 1});
        last_ends.insert(last_ends.end(), {is_empty ? -1 : first_of_last, is_empty ? -1 : last_of_first});
      }
      const auto axis = testing::guarded<cl_int>(runtime, 2 * table.sets);
      const auto cuts = testing::guarded<cl_double>(runtime, 2 * table.sets);
      const auto first = testing::guarded<cl_int>(runtime, 2 * table.sets);
      const auto last = testing::guarded<cl_int>(runtime, 2 * table.sets);
      runtime.map(table.sets, kernels::set_ends{.offsets = table.set_offsets,
                                                .points = table.points,
                                                .axis = axis,
                                                .cut = cuts,
                                                .first_end = first,
                                                .last_end = last});
      EXPECT_TRUE(same(testing::download(runtime, first, 2 * table.sets), first_ends));
      EXPECT_TRUE(same(testing::download(runtime, last, 2 * table.sets), last_ends));
    }
  });
}

/// Where the regions of sets begin; a set of neither points nor corners is none.
TEST(SmallChildren, AreLaidOut) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(35);
    for (const std::size_t sets : {1, 2, 12, 300}) {
      Call call(runtime);
      std::vector<cl_int> points, corners, region, point_offsets{0}, corner_offsets{0}, retired_offsets{0};
      for (std::size_t s = 0; s < sets; ++s) {
        for (std::vector<cl_int>* sizes : {&points, &corners})
          sizes->push_back(static_cast<cl_int>(std::max<std::int64_t>(0, random.integer(-4, 9))));
        const bool goes_on = points[s] > 0;
        std::vector<cl_int>& offsets = goes_on ? corner_offsets : retired_offsets;
        const auto number = static_cast<cl_int>(offsets.size()) - 1;
        region.push_back(goes_on ? number : -1 - number);
        if (goes_on) point_offsets.push_back(point_offsets.back() + points[s]);
        if (goes_on || corners[s] > 0) offsets.push_back(offsets.back() + corners[s]);
      }
      Level next;
      RetiredRegions retired;
      const Children placed = place_sets(call.work, sets, testing::upload(runtime, points),
                                         testing::upload(runtime, corners), next, retired);
      EXPECT_TRUE(same(call.read(placed.region, sets), region));
      ASSERT_EQ(next.regions, point_offsets.size() - 1);
      ASSERT_EQ(retired.regions, retired_offsets.size() - 1);
      EXPECT_TRUE(same(call.read(next.point_offsets, next.regions + 1), point_offsets));
      EXPECT_TRUE(same(call.read(next.corner_offsets, next.regions + 1), corner_offsets));
      EXPECT_TRUE(same(call.read(retired.offsets, retired.regions + 1), retired_offsets));
    }
  });
}

// -----------------------------------------------------------------------------------------------------------
// Invariants that are broken on purpose

void expect_broken(Call& call, cl_int invariant) {
  EXPECT_EQ(call.broken(), invariant);
  EXPECT_THROW(check_invariants(call.work), Error);
}

TEST(SmallInvariants, APointOnTheLineThatIsNotOnThePath) {
  under_each_tuning([](Runtime& runtime) {
    Call call(runtime);
    PointTable table;
    table.count = 1;
    table.points = testing::upload(runtime, std::vector<cl_double2>{{{4.5, 0}}});
    table.side = testing::upload(runtime, std::vector<cl_uchar>{0});
    Level level;
    level.regions = level.points = 1;
    level.x_list = level.y_list = level.point_regions = level.axis =
        testing::upload(runtime, std::vector<cl_int>{0});
    level.cut = testing::upload(runtime, std::vector<cl_double>{4.5});
    begin_split(call.work, table, level);
    expect_broken(call, 1);
  });
}

/// A border that does not close is found out, not triangulated.
TEST(SmallInvariants, ABorderThatDoesNotClose) {
  under_each_tuning([](Runtime& runtime) {
    for (const Bounds& bounds : {Bounds{0, 0, 0}, kUndecided}) {
      Call call(runtime);
      call.work.bounds = bounds;
      PointTable table;
      table.points =
          testing::upload(runtime, std::vector<cl_double2>{{{0, 0}}, {{4, 0}}, {{4, 4}}, {{0, 4}}});
      RetiredRegions clockwise;
      clockwise.regions = 1;
      clockwise.corners = 4;
      clockwise.corner_ids =
          testing::upload(runtime, std::vector<cl_int>{1, 0, 3, 0, 3, 2, 3, 2, 1, 2, 1, 0});
      clockwise.offsets = testing::upload(runtime, std::vector<cl_int>{0, 4});
      endgame(call.work, table, clockwise, testing::guarded<cl_int>(runtime, 12), 0);
      expect_broken(call, 2);
    }
  });
}

TEST(SmallInvariants, AnEdgeThatIsNotDelaunay) {
  under_each_tuning([](Runtime& runtime) {
    for (const Bounds& bounds : {Bounds{0, 0, 0}, kUndecided}) {
      Call call(runtime);
      call.work.bounds = bounds;
      PointTable table;
      table.count = 4;
      table.points =
          testing::upload(runtime, std::vector<cl_double2>{{{0, 0}}, {{1, -1}}, {{1, 1}}, {{8, 0}}});
      const auto canonical = [&](const std::vector<cl_int>& triangles) {
        const auto rows = testing::upload(runtime, triangles);
        const auto twins = testing::guarded<cl_int>(runtime, triangles.size());
        match_edges(call.work, rows, triangles.size() / 3, twins);
        canonicalize(call.work, table, rows, triangles.size() / 3, twins);
      };
      canonical({0, 1, 2, 2, 1, 3});
      EXPECT_EQ(call.broken(), 0);
      canonical({0, 1, 3, 0, 3, 2});
      expect_broken(call, 4);
    }
  });
}

}  // namespace
}  // namespace flaunay::flattened
