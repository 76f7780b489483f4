// The stage `strips`: the triangles of regions too large for one work-item.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "tests/flattened/support.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::flattened {

/// Border edges of regions that strips misses, since of cocircular points it chose other edges: it
/// triangulates the vertices alone, so it makes the same edges where the border is their convex hull.
std::size_t missing_edges(Call& call, const PointTable& table, const std::vector<int>& around,
                          const std::vector<Region>& regions) {
  Arena::Scope scope(call.work.scratch());
  std::vector<Region> hulls;
  std::vector<std::size_t> of_hull;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const std::vector<int> vertices = regions[r].points();
    if (vertices.size() <= static_cast<std::size_t>(tuning_of(call.runtime).small_region)) continue;
    const std::set<int> in(vertices.begin(), vertices.end());
    std::vector<int> polygon;
    std::copy_if(around.begin(), around.end(), std::back_inserter(polygon),
                 [&](int id) { return in.count(id) != 0; });
    Region hull;
    add_polygon(polygon, hull.corners);
    hulls.push_back(hull);
    of_hull.push_back(r);
  }
  const RetiredRegions retired = upload_retired(call, hulls);
  const auto triangles = testing::guarded<cl_int>(call.runtime, 3 * retired.corners);
  const std::size_t written = endgame(call.work, table, retired, triangles, 0);
  const auto rows = call.read(triangles, 3 * written);
  std::size_t missing = 0;
  auto row = rows.begin();
  for (std::size_t h = 0; h < hulls.size(); ++h) {
    std::set<std::pair<int, int>> edges;
    for (std::size_t t = 0; t + 2 < hulls[h].corners.size(); ++t, row += 3) {
      for (int j = 0; j < 3; ++j) edges.insert({row[j], row[(j + 1) % 3]});
    }
    for (const Corner& corner : regions[of_hull[h]].corners) {
      missing +=
          edges.count({corner.vertex, corner.after}) == 0 && edges.count({corner.after, corner.vertex}) == 0;
    }
  }
  EXPECT_TRUE(row == rows.end());
  return missing;
}

namespace {

TEST(Strips, CocircularRegionsWhoseBordersAreDiagonals) {
  Met met;
  check_circle_regions(std::int64_t{25} * 13 * 17, 100, 2, false, met);       // 48 points
  check_circle_regions(std::int64_t{25} * 13 * 17 * 29, 100, 3, true, met);   // 96
  check_circle_regions(std::int64_t{625} * 169 * 17 * 29, 20, 4, true, met);  // 240
  EXPECT_GT(met.undecided_endgame + met.large, 300u);
  EXPECT_GT(met.large, 200u);
}

}  // namespace

}  // namespace flaunay::flattened
