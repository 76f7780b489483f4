// The stage `endgame`: the triangles of regions without internal points.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/flattened/support.hpp"
#include "tests/support/border_twin.hpp"
#include "tests/support/endgame_twin.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::flattened {
namespace {

/// What remains of a convex polygon when polygons of some of its vertices are taken out of it, again and
/// again.
void add_caps(const std::vector<int>& polygon, int depth, FixtureRandom& random,
              std::vector<Corner>& corners) {
  if (depth == 0 || polygon.size() < 6) return add_polygon(polygon, corners);
  std::vector<std::size_t> taken;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (random.integer(0, 3) == 0) taken.push_back(i);
  }
  if (taken.size() < 3) return add_polygon(polygon, corners);
  for (std::size_t j = 0; j < taken.size(); ++j) {
    std::vector<int> cap;
    for (std::size_t i = taken[j];; i = (i + 1) % polygon.size()) {
      cap.push_back(polygon[i]);
      if (i == taken[(j + 1) % taken.size()]) break;
    }
    if (cap.size() >= 3) add_caps(cap, depth - 1, random, corners);
  }
}

/// Empty if the triangles (3 ids each) are a Delaunay triangulation of the region, else what is wrong with
/// them.
std::string region_fault(const ExactPoints& points, const std::vector<Corner>& corners,
                         const std::vector<int>& triangles) {
  if (triangles.size() != 3 * testing::triangle_count_twin(corners)) return "wrong number of triangles";
  std::set<int> vertices;
  std::set<std::pair<int, int>> border;
  for (const Corner& corner : corners) {
    vertices.insert(corner.vertex);
    border.insert({corner.vertex, corner.after});
  }
  std::map<std::pair<int, int>, int> apex_of;  // by directed edge
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const int v[3] = {triangles[t], triangles[t + 1], triangles[t + 2]};
    const std::string name =
        " (" + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + ")";
    for (const int id : v) {
      if (vertices.count(id) == 0) return "a vertex that is none of the region's" + name;
    }
    if (points.orient(v[0], v[1], v[2]) <= 0) return "a triangle that is not counter-clockwise" + name;
    for (int j = 0; j < 3; ++j) {
      if (!apex_of.emplace(std::make_pair(v[j], v[(j + 1) % 3]), v[(j + 2) % 3]).second) {
        return "an edge of two triangles on one side" + name;
      }
    }
    // Beyond this size, edges suffice (below), and all circles cost too much.
    if (vertices.size() <= 200) {
      for (const int id : vertices) {
        if (points.in_circle(v[0], v[1], v[2], id) > 0) return "a circle that is not empty" + name;
      }
    }
  }
  for (const std::pair<int, int>& edge : border) {
    if (apex_of.count(edge) == 0) return "a border edge without a triangle";
  }
  for (const auto& [edge, apex] : apex_of) {
    const auto twin = apex_of.find({edge.second, edge.first});
    const bool is_border = border.count(edge) != 0;
    if (is_border == (twin != apex_of.end())) return is_border ? "a border edge inside" : "a hole";
    if (!is_border && points.in_circle(edge.first, edge.second, apex, twin->second) > 0) {
      return "an edge that is not Delaunay";
    }
  }
  return "";
}

}  // namespace

/// The triangles of retired regions: each a valid triangulation of its region, and the same if nothing is
/// filtered.
void check_endgame(Call& call, const ExactPoints& points, const PointTable& table,
                   const RetiredRegions& retired, const std::vector<Region>& regions, Met& met) {
  SCOPED_TRACE("endgame");
  ASSERT_EQ(retired.regions, regions.size());
  Arena::Scope scope(call.work.scratch());
  const auto corner_ids = call.read(retired.corner_ids, 3 * retired.corners);
  std::vector<std::size_t> counts;
  for (const Region& region : regions) {
    counts.push_back(testing::triangle_count_twin(region.corners));
    met.large += region.corners.size() > static_cast<std::size_t>(tuning_of(call.runtime).small_region);
  }
  const std::size_t total = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  constexpr std::size_t kBase = 2;  // rows that are there before
  const std::vector<cl_int> rows_before(3 * kBase, -7);
  const Bounds bounds = call.work.bounds;
  std::vector<cl_int> filtered;
  for (const bool exact : {false, true}) {
    const auto triangles = testing::guarded<cl_int>(call.runtime, 3 * (kBase + total));
    call.runtime.write(triangles, 0, 3 * kBase, rows_before.data());
    call.runtime.write(retired.corner_ids, 0, 3 * retired.corners, corner_ids.data());
    if (exact) call.work.bounds = kUndecided;
    const std::size_t undecided = call.undecided();
    const std::size_t written = endgame(call.work, table, retired, triangles, kBase);
    call.work.bounds = bounds;
    ASSERT_EQ(written, total);
    std::vector<cl_int> rows = testing::download(call.runtime, triangles, 3 * (kBase + total));
    EXPECT_TRUE(std::equal(rows_before.begin(), rows_before.end(), rows.begin()))
        << "written before the base";
    rows.erase(rows.begin(), rows.begin() + 3 * kBase);
    if (exact) {
      EXPECT_TRUE(same(rows, filtered)) << "filtered and exact predicates give other triangles";
    } else {
      met.undecided_endgame += call.undecided() - undecided;
      filtered = rows;
    }
  }
  auto row = filtered.begin();
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const auto end = row + 3 * static_cast<std::ptrdiff_t>(counts[r]);
    ASSERT_EQ(region_fault(points, regions[r].corners, {row, end}), "") << "region " << r;
    row = end;
  }
  EXPECT_EQ(call.broken(), 0);
}

RetiredRegions upload_retired(Call& call, const std::vector<Region>& regions) {
  RetiredRegions retired;
  std::vector<cl_int> ids, offsets{0};
  for (const Region& region : regions) {
    for (const Corner& c : region.corners) ids.insert(ids.end(), {c.before, c.vertex, c.after});
    offsets.push_back(static_cast<cl_int>(ids.size() / 3));
  }
  retired.regions = regions.size();
  retired.corners = ids.size() / 3;
  retired.corner_ids = testing::upload(call.runtime, ids);
  retired.offsets = testing::upload(call.runtime, offsets);
  return retired;
}

void check_circle_regions(std::int64_t square, int regions_count, int depth, bool expect_missing, Met& met) {
  under_each_tuning([&](Runtime& runtime) {
    FixtureRandom random(14);
    Call call(runtime);
    const auto places = integer_circle(square);
    const ExactPoints points(places);
    PointTable table;
    table.count = places.size();
    table.points = testing::upload(runtime, places);
    std::vector<int> ids(places.size());
    std::iota(ids.begin(), ids.end(), 0);
    bool collinear = false;
    const std::vector<int> around = testing::border_twin(points, ids, collinear);
    ASSERT_EQ(around.size(), places.size());
    std::vector<Region> regions;
    while (regions.size() < static_cast<std::size_t>(regions_count)) {
      std::vector<int> some;
      const std::int64_t keep = random.integer(1, 4);
      for (const int id : around) {
        if (random.integer(1, 4) <= keep) some.push_back(id);
      }
      if (some.size() < 3) continue;
      Region region;
      add_caps(some, depth, random, region.corners);
      random.shuffle(region.corners);
      regions.push_back(region);
    }
    for (const Bounds& bounds : {Bounds{1e-14, 1e-14, 1e-14}, kUndecided}) {
      call.work.bounds = bounds;
      check_endgame(call, points, table, upload_retired(call, regions), regions, met);
      if (expect_missing) {
        EXPECT_GT(missing_edges(call, table, around, regions), 0u) << "restore_border had nothing to do";
      }
    }
  });
}

namespace {

TEST(SmallEndgame, CocircularRegions) {
  Met met;
  check_circle_regions(5 * 13, 3, 2, false, met);
  EXPECT_GT(met.undecided_endgame + met.large, 0u);
}

/// A border that does not close is found out, not triangulated.
TEST(SmallEndgame, ReportsABrokenBorder) {
  under_each_tuning([](Runtime& runtime) {
    for (const Bounds& bounds : {Bounds{0, 0, 0}, kUndecided}) {
      Call call(runtime);
      call.work.bounds = bounds;
      PointTable table;
      table.points =
          testing::upload(runtime, std::vector<cl_double2>{{{0, 0}}, {{4, 0}}, {{4, 4}}, {{0, 4}}});
      Region clockwise;
      add_polygon({0, 3, 2, 1}, clockwise.corners);
      const RetiredRegions retired = upload_retired(call, {clockwise});
      const auto triangles = testing::guarded<cl_int>(runtime, 12);
      endgame(call.work, table, retired, triangles, 0);
      EXPECT_EQ(call.broken(), 2);
      EXPECT_THROW(check_invariants(call.work), Error);
    }
  });
}

}  // namespace

}  // namespace flaunay::flattened
