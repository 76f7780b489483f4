// The stage `merge`: the regions that paths make of regions.
#include <gtest/gtest.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "tests/flattened/support.hpp"

namespace flaunay::flattened {

Regions check_merge(Call& call, const ExactPoints& points, PointTable& table, const Level& level,
                    const std::vector<Region>& regions, const CutLevel& cut, const Paths& paths, Level& next,
                    RetiredRegions& retired, Met& met) {
  Regions expected;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    for (Region& child : testing::merge_twin(points, regions[r], cut.frames[r], cut.paths[r], met.merge)) {
      expected.add(std::move(child));
    }
  }
  const std::size_t undecided = call.undecided();
  merge(call.work, table, level, paths, next, retired);
  met.undecided_merge += call.undecided() - undecided;
  Regions found = download(call, next, retired);
  const auto are_same = [&] { ASSERT_TRUE(same_regions(found, expected)); };
  are_same();
  return found;
}

namespace {

TEST(Merge, ManySets) {
  Met met;
  under_each_tuning([&](Runtime& runtime) {
    FixtureRandom random(10);
    for (const int values : {3, 10, 1000}) {
      SCOPED_TRACE(values);
      const auto offsets = random_offsets(300, 30, random);
      check_levels(runtime, coarse_points(offsets.back(), values, random), offsets, {}, met);
    }
  });
  EXPECT_GT(met.merge.pinch_points, 0u);
  EXPECT_GT(met.merge.corners_by_parts[3], 0u);
  EXPECT_GT(met.equal_projections, 0u);
}

}  // namespace

}  // namespace flaunay::flattened
