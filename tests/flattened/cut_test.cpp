// The stage `cut`: where regions are cut, and where their paths begin and end.
#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

/// alternate_axis: 0 or 1, or -1 for the longer interquartile range (as rounded to double).
Frame cut_twin(const ExactPoints& points, const Region& region, int alternate_axis) {
  const std::size_t count = region.x_list.size();
  Frame frame;
  frame.axis = alternate_axis;
  if (alternate_axis < 0) {
    const double x_range = points[region.x_list[3 * count / 4]].s[0] - points[region.x_list[count / 4]].s[0];
    const double y_range = points[region.y_list[3 * count / 4]].s[1] - points[region.y_list[count / 4]].s[1];
    frame.axis = y_range > x_range ? 1 : 0;
  }
  frame.q = frame.axis == 0 ? points[region.x_list[count / 2]].s[0] : points[region.y_list[count / 2]].s[1];
  return frame;
}

/// The border vertices of smallest and of largest u, the lowest of each.
std::pair<int, int> ends_twin(const ExactPoints& points, const Frame& frame, const Region& region) {
  std::vector<int> vertices;
  for (const Corner& corner : region.corners) vertices.push_back(corner.vertex);
  const std::vector<int> by_u = points.lowest_by_u(frame, vertices);
  return {by_u.front(), by_u.back()};
}

}  // namespace

CutLevel check_cut(Call& call, const ExactPoints& points, const PointTable& table, Level& level,
                   const std::vector<Region>& regions, int alternate, Met& met) {
  cut(call.work, table, level, 0, alternate);
  CutLevel twin;
  std::vector<cl_int> axes, first_ends, last_ends;
  std::vector<cl_double> cuts;
  for (const Region& region : regions) {
    const Frame frame = cut_twin(points, region, alternate);
    const auto ends = ends_twin(points, frame, region);
    axes.push_back(frame.axis);
    cuts.push_back(frame.q);
    first_ends.push_back(ends.first);
    last_ends.push_back(ends.second);
    twin.frames.push_back(frame);
    twin.paths.push_back(points.lower_hull(frame, region.points()));
    std::set<int> lowest, highest;
    for (const Corner& corner : region.corners) {
      const double u = frame.u(points[corner.vertex]);
      if (u == frame.u(points[ends.first])) lowest.insert(corner.vertex);
      if (u == frame.u(points[ends.second])) highest.insert(corner.vertex);
    }
    met.mirrored_ends += (lowest.size() > 1) + (highest.size() > 1);
  }
  EXPECT_TRUE(same(call.read(level.axis, level.regions), axes)) << "axis";
  EXPECT_TRUE(same(call.read(level.cut, level.regions), cuts)) << "cut";
  EXPECT_TRUE(same(call.read(level.first_end, level.regions), first_ends)) << "first_end";
  EXPECT_TRUE(same(call.read(level.last_end, level.regions), last_ends)) << "last_end";
  return twin;
}

namespace {

TEST(Cut, AlternatingCuts) {
  Met met;
  check_fixtures({"uniform", "line", "grid", "integer-circle", "kuzmin", "columns"}, 400,
                 {false, true, false, 1000}, met);
  EXPECT_GT(met.levels, 30u);
}

}  // namespace

}  // namespace flaunay::flattened
