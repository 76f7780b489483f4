// The stage `border`: the convex hulls of whole sets, which are the level loop without levels.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "launchers/flattened/border.cl.hpp"
#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

TEST(Borders, AreConvexHullsWithThePointsOnTheirEdges) {
  const LoopOptions options{false, false, false, 0};
  under_each_tuning([&](Runtime& runtime) {
    Met met;
    FixtureRandom random(5);
    for (const bool undecided : {false, true}) {
      LoopOptions with = options;
      with.undecided = undecided;
      for (const int values : {1, 2, 3, 20}) {
        SCOPED_TRACE(values);
        // Many small sets: most of them with points on edges, some collinear, some empty, some without
        // inside.
        const auto offsets = random_offsets(400, 12, random);
        check_levels(runtime, coarse_points(offsets.back(), values, random), offsets, with, met);
      }
      for (const char* const name :
           {"uniform", "grid", "rotated-grid", "collinear", "apex", "triangle-edges", "circle",
            "integer-circle", "columns", "parabola", "slender", "two-lines"}) {
        SCOPED_TRACE(name);
        check_levels(runtime, make_fixture(name, 2500, 6), with, met);
      }
    }
    EXPECT_EQ(met.levels, 0u);
    EXPECT_GT(met.retired, 300u);
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
      const ExactPoints points(call.read(table.points, table.count));
      const auto ids = call.read(table.set_offsets, table.sets + 1);
      std::vector<cl_int> axes, first_ends, last_ends;
      for (std::size_t s = 0; s < table.sets; ++s) {
        std::vector<int> all(static_cast<std::size_t>(ids[s + 1] - ids[s]));
        std::iota(all.begin(), all.end(), ids[s]);
        for (const int axis : {2, 3}) {
          const std::vector<int> columns = points.lowest_by_u({axis, 0.0}, all);
          axes.push_back(axis);
          first_ends.push_back(all.empty() ? -1 : columns.front());
          last_ends.push_back(all.empty() ? -1 : columns.back());
        }
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
      EXPECT_TRUE(same(testing::download(runtime, axis, 2 * table.sets), axes));
      EXPECT_TRUE(same(testing::download(runtime, first, 2 * table.sets), first_ends));
      EXPECT_TRUE(same(testing::download(runtime, last, 2 * table.sets), last_ends));
    }
  });
}

}  // namespace
}  // namespace flaunay::flattened
