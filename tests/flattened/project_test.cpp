// The stage `project`: internal points as (h, u), in the order along their region's cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

/// One region for each axis, all of the same points.
void check_projections(Runtime& runtime, const Coordinates& coordinates) {
  Call call(runtime);
  const std::size_t n = coordinates.size() / 2;
  std::vector<cl_double2> places;
  for (std::size_t i = 0; i < n; ++i) places.push_back({{coordinates[2 * i], coordinates[2 * i + 1]}});
  const ExactPoints points(places);
  const std::vector<Frame> frames{{0, places[n / 2].s[0]}, {1, places[n / 2].s[1]}, {2, 0.0}, {3, 0.0}};
  std::vector<cl_int> by_x(n), by_y(n), x_list, y_list, regions, axes;
  std::vector<cl_double> cuts;
  std::vector<cl_double2> expected;
  std::iota(by_x.begin(), by_x.end(), 0);
  by_y = by_x;
  std::sort(by_x.begin(), by_x.end(), [&](int i, int j) { return points[i].s[0] < points[j].s[0]; });
  std::sort(by_y.begin(), by_y.end(), [&](int i, int j) { return points[i].s[1] < points[j].s[1]; });
  for (const Frame& frame : frames) {
    x_list.insert(x_list.end(), by_x.begin(), by_x.end());
    y_list.insert(y_list.end(), by_y.begin(), by_y.end());
    regions.insert(regions.end(), n, static_cast<cl_int>(axes.size()));
    axes.push_back(frame.axis);
    cuts.push_back(frame.q);
    for (const int id : frame.axis == 1 ? by_x : by_y) expected.push_back(projected(frame, points[id]));
  }
  PointTable table;
  table.count = n;
  table.points = testing::upload(runtime, places);
  Level level;
  level.regions = frames.size();
  level.points = x_list.size();
  level.x_list = testing::upload(runtime, x_list);
  level.y_list = testing::upload(runtime, y_list);
  level.point_regions = testing::upload(runtime, regions);
  level.axis = testing::upload(runtime, axes);
  level.cut = testing::upload(runtime, cuts);
  project(call.work, table, level);
  // Lists of planar regions are taken as those of axis 0 are: all but axis 1 by y.
  EXPECT_TRUE(same(call.read(level.projections, level.points), expected));
}

TEST(SmallProject, OfEachAxis) {
  under_each_tuning([](Runtime& runtime) { check_projections(runtime, make_fixture("uniform", 9, 1)); });
}

TEST(Project, OfEachAxis) {
  under_each_tuning([](Runtime& runtime) {
    for (const char* const name : {"uniform", "small-integers", "kuzmin"}) {
      SCOPED_TRACE(name);
      check_projections(runtime, make_fixture(name, 700, 2));
    }
  });
}

}  // namespace
}  // namespace flaunay::flattened
