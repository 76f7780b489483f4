// The stage `lists`: internal points of regions go to the children, in their order; and the first lists.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

constexpr cl_uchar kOnBorder = 2;

/// Points of integer x in regions of the given sizes, cut between two integers; every fifth is on a path.
void check_split(Runtime& runtime, const std::vector<std::size_t>& sizes, FixtureRandom& random) {
  Call call(runtime);
  const std::size_t n = std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  std::vector<cl_double2> places;
  std::vector<cl_uchar> side;
  for (std::size_t i = 0; i < n; ++i) {
    const auto x = static_cast<double>(random.integer(0, 9));
    places.push_back({{x, static_cast<double>(random.integer(0, 9))}});
    side.push_back(random.integer(0, 4) == 0 ? kOnBorder : 0);
  }
  std::vector<cl_int> ids(n), x_list, y_list, regions;
  std::iota(ids.begin(), ids.end(), 0);
  random.shuffle(ids);
  std::vector<std::vector<cl_int>> new_lists(2);
  std::vector<cl_int> new_regions;
  std::vector<cl_uint2> before{{{0, 0}}};
  std::vector<cl_int> child_region;
  const auto goes = [&](cl_int id, int to) {
    const auto i = static_cast<std::size_t>(id);
    return side[i] != kOnBorder && (places[i].s[0] < 4.5 ? 0 : 1) == to;
  };
  auto first = ids.begin();
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    std::vector<cl_int> own(first, first + static_cast<std::ptrdiff_t>(sizes[r]));
    first += static_cast<std::ptrdiff_t>(sizes[r]);
    regions.insert(regions.end(), sizes[r], static_cast<cl_int>(r));
    cl_uint2 counts = before.back();
    for (std::vector<cl_int>* const list : {&x_list, &y_list}) {
      list->insert(list->end(), own.begin(), own.end());
      for (const int to : {0, 1}) {
        for (const cl_int id : own) {
          if (!goes(id, to)) continue;
          new_lists[list == &x_list ? 0 : 1].push_back(id);
          if (list != &x_list) continue;
          ++counts.s[to];
          new_regions.push_back(static_cast<cl_int>(2 * r) + to);
        }
      }
      random.shuffle(own);
    }
    before.push_back(counts);
    child_region.push_back(static_cast<cl_int>(2 * r));
    child_region.push_back(static_cast<cl_int>(2 * r + 1));
  }

  PointTable table;
  table.count = n;
  table.points = testing::upload(runtime, places);
  table.side = testing::upload(runtime, side);
  Level level, next;
  level.regions = sizes.size();
  level.points = n;
  level.x_list = testing::upload(runtime, x_list);
  level.y_list = testing::upload(runtime, y_list);
  level.point_regions = testing::upload(runtime, regions);
  level.axis = testing::upload(runtime, std::vector<cl_int>(sizes.size(), 0));
  level.cut = testing::upload(runtime, std::vector<cl_double>(sizes.size(), 4.5));
  const ListSplit split = begin_split(call.work, table, level);
  EXPECT_TRUE(same(call.read(split.points_before, sizes.size() + 1), before));
  Children children;
  children.region = testing::upload(runtime, child_region);
  next.points = new_regions.size();
  next.x_list = testing::guarded<cl_int>(runtime, next.points);
  next.y_list = testing::guarded<cl_int>(runtime, next.points);
  next.point_regions = testing::guarded<cl_int>(runtime, next.points);
  split_lists(call.work, table, level, split, children, next);
  EXPECT_TRUE(same(testing::download(runtime, next.x_list, next.points), new_lists[0]));
  EXPECT_TRUE(same(testing::download(runtime, next.y_list, next.points), new_lists[1]));
  EXPECT_TRUE(same(testing::download(runtime, next.point_regions, next.points), new_regions));
  EXPECT_EQ(call.broken(), 0);
}

/// What is not on a border, in the order of a list of all ids, with the regions of its sets.
void check_first_list(Runtime& runtime, std::size_t n, FixtureRandom& random) {
  Call call(runtime);
  constexpr std::size_t kSets = 5;
  std::vector<cl_int> list(n), set_of_id, child_region(kSets), kept, regions;
  std::vector<cl_uchar> side;
  std::iota(list.begin(), list.end(), 0);
  std::iota(child_region.begin(), child_region.end(), 10);
  random.shuffle(list);
  for (std::size_t i = 0; i < n; ++i) {
    set_of_id.push_back(static_cast<cl_int>(i * kSets / n));
    side.push_back(random.integer(0, 2) == 0 ? kOnBorder : 0);
  }
  for (const cl_int id : list) {
    if (side[static_cast<std::size_t>(id)] == kOnBorder) continue;
    kept.push_back(id);
    regions.push_back(10 + set_of_id[static_cast<std::size_t>(id)]);
  }
  PointTable table;
  table.count = n;
  table.sets = kSets;
  table.side = testing::upload(runtime, side);
  table.set_of_id = testing::upload(runtime, set_of_id);
  Children children;
  children.region = testing::upload(runtime, child_region);
  const auto new_list = testing::guarded<cl_int>(runtime, kept.size());
  const auto new_regions = testing::guarded<cl_int>(runtime, kept.size());
  first_list(call.work, table, testing::upload(runtime, list), children, new_list, new_regions);
  EXPECT_TRUE(same(testing::download(runtime, new_list, kept.size()), kept));
  EXPECT_TRUE(same(testing::download(runtime, new_regions, kept.size()), regions));
}

TEST(SmallLists, SplitStably) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(33);
    check_split(runtime, {1}, random);
    check_split(runtime, {7, 1, 12}, random);
    check_first_list(runtime, 30, random);
  });
}

TEST(Lists, SplitStably) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(34);
    check_split(runtime, {20000}, random);
    std::vector<std::size_t> sizes;
    for (int r = 0; r < 3000; ++r) sizes.push_back(static_cast<std::size_t>(random.integer(1, 9)));
    check_split(runtime, sizes, random);
    check_first_list(runtime, 20000, random);
  });
}

/// A point on the cut line that is not on the path breaks an invariant.
TEST(SmallLists, ReportAPointOnTheLine) {
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
    EXPECT_EQ(call.broken(), 1);
    EXPECT_THROW(check_invariants(call.work), Error);
  });
}

}  // namespace
}  // namespace flaunay::flattened
