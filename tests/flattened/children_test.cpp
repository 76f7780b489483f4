// The stage `children`: which children are regions of the next level, which retire, and where they begin.
#include <gtest/gtest.h>

#include <vector>

#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

/// How many points and corners children have, and what follows from that.
struct ChildrenTwin {
  std::vector<cl_int> region, base;
  std::vector<cl_int> point_offsets{0}, corner_offsets{0}, retired_offsets{0};

  void add(cl_int points, cl_int corners) {
    std::vector<cl_int>& offsets = points > 0 ? corner_offsets : retired_offsets;
    const auto number = static_cast<cl_int>(offsets.size()) - 1;
    region.push_back(points > 0 ? number : -1 - number);
    base.push_back(offsets.back());
    // A child of neither points nor corners is none.
    if (points > 0) point_offsets.push_back(point_offsets.back() + points);
    if (points > 0 || corners > 0) offsets.push_back(offsets.back() + corners);
  }
};

void expect_children(Call& call, const Children& placed, const Level& next, const RetiredRegions& retired,
                     const ChildrenTwin& twin) {
  EXPECT_TRUE(same(call.read(placed.region, twin.region.size()), twin.region));
  EXPECT_TRUE(same(call.read(placed.base, twin.base.size()), twin.base));
  ASSERT_EQ(next.regions, twin.point_offsets.size() - 1);
  ASSERT_EQ(retired.regions, twin.retired_offsets.size() - 1);
  EXPECT_EQ(next.points, static_cast<std::size_t>(twin.point_offsets.back()));
  EXPECT_EQ(next.corners, static_cast<std::size_t>(twin.corner_offsets.back()));
  EXPECT_EQ(retired.corners, static_cast<std::size_t>(twin.retired_offsets.back()));
  EXPECT_TRUE(same(call.read(next.point_offsets, next.regions + 1), twin.point_offsets));
  EXPECT_TRUE(same(call.read(next.corner_offsets, next.regions + 1), twin.corner_offsets));
  EXPECT_TRUE(same(call.read(retired.offsets, retired.regions + 1), twin.retired_offsets));
}

cl_int size_of_child(FixtureRandom& random) {
  return random.integer(0, 2) == 0 ? 0 : static_cast<cl_int>(random.integer(1, 9));
}

void check_sets(Runtime& runtime, std::size_t sets, FixtureRandom& random) {
  Call call(runtime);
  std::vector<cl_int> points, corners;
  ChildrenTwin twin;
  for (std::size_t s = 0; s < sets; ++s) {
    points.push_back(size_of_child(random));
    corners.push_back(size_of_child(random));
    twin.add(points.back(), corners.back());
  }
  Level next;
  RetiredRegions retired;
  const Children placed = place_sets(call.work, sets, testing::upload(runtime, points),
                                     testing::upload(runtime, corners), next, retired);
  expect_children(call, placed, next, retired, twin);
}

/// Two children per region: points by region, corners from corners on either side, and from path vertices
/// that were internal points, which both children get.
void check_regions(Runtime& runtime, std::size_t regions, FixtureRandom& random) {
  Call call(runtime);
  std::vector<cl_uint2> points_before{{{0, 0}}}, corner_sides{{{0, 0}}};
  std::vector<cl_uint> internal{0};
  std::vector<cl_int> corner_offsets{0}, path_offsets{0};
  ChildrenTwin twin;
  for (std::size_t r = 0; r < regions; ++r) {
    cl_int points[2] = {size_of_child(random), size_of_child(random)}, corners[2] = {0, 0};
    points_before.push_back(points_before.back());
    for (const int to : {0, 1}) points_before.back().s[to] += static_cast<cl_uint>(points[to]);
    for (cl_int c = size_of_child(random); c > 0; --c) {
      corner_sides.push_back(corner_sides.back());
      for (const int to : {0, 1}) {
        const auto parts = static_cast<cl_int>(random.integer(0, 2));
        corner_sides.back().s[to] += static_cast<cl_uint>(parts);
        corners[to] += parts;
      }
    }
    for (cl_int v = size_of_child(random); v > 0; --v) {
      const auto is_internal = static_cast<cl_int>(random.integer(0, 1));
      internal.push_back(internal.back() + static_cast<cl_uint>(is_internal));
      for (cl_int& count : corners) count += is_internal;
    }
    corner_offsets.push_back(static_cast<cl_int>(corner_sides.size()) - 1);
    path_offsets.push_back(static_cast<cl_int>(internal.size()) - 1);
    for (const int to : {0, 1}) twin.add(points[to], corners[to]);
  }
  Level level, next;
  level.regions = regions;
  level.corner_offsets = testing::upload(runtime, corner_offsets);
  Paths paths;
  paths.offsets = testing::upload(runtime, path_offsets);
  RetiredRegions retired;
  const Children placed =
      place_children(call.work, level, paths,
                     {testing::upload(runtime, points_before), testing::upload(runtime, corner_sides),
                      testing::upload(runtime, internal)},
                     next, retired);
  expect_children(call, placed, next, retired, twin);
}

TEST(SmallChildren, AreLaidOut) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(35);
    for (const std::size_t count : {1, 2, 12}) {
      check_sets(runtime, count, random);
      check_regions(runtime, count, random);
    }
  });
}

TEST(Children, AreLaidOut) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(36);
    check_sets(runtime, 20000, random);
    check_regions(runtime, 20000, random);
  });
}

}  // namespace
}  // namespace flaunay::flattened
