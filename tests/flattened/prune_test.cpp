// The stage `prune`: what lies below paths, and the candidates that make the first paths.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "flattened/limits.h"
#include "launchers/flattened/prune.cl.hpp"
#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

/// The projections of a level's internal points.
Buffer<cl_double2> upload_projections(Call& call, const ExactPoints& points,
                                      const std::vector<Region>& regions, const std::vector<Frame>& frames) {
  std::vector<cl_double2> projections;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    for (const int id : frames[r].axis == 1 ? regions[r].x_list : regions[r].y_list) {
      projections.push_back(projected(frames[r], points[id]));
    }
  }
  return testing::upload(call.runtime, projections);
}

/// What prune should say of a point: 0 dropped, 1 kept, 3 on the path; of what is kept, the vertex of the
/// path whose chord it is below.
struct PruneTwin {
  cl_uchar flag = 0;
  cl_int chord = 0;
};
PruneTwin prune_twin(const ExactPoints& points, const Frame& frame, const std::vector<int>& path, int id,
                     bool keep_on) {
  const double u = frame.u(points[id]);
  const auto above = std::upper_bound(
      path.begin(), path.end(), u, [&](double value, int other) { return value < frame.u(points[other]); });
  const int v = *(above - 1);
  const bool last = above == path.end();
  const auto chord = static_cast<cl_int>(above - 1 - path.begin());
  if (id == v) return {static_cast<cl_uchar>(keep_on ? 1 : 3), chord};
  if (frame.u(points[v]) == u) {
    const bool kept = keep_on ? last : points.is_lower(frame, id, v);
    return {kept, keep_on || !last ? chord : chord - 1};
  }
  const int sign = points.depth_sign(frame, v, *above, id);
  return {sign > 0 || (keep_on && sign == 0), chord};
}

}  // namespace

/// Prune against paths made by hand, which need be no hulls: of some of each region's points.
void check_prune(Call& call, const ExactPoints& points, const PointTable& table, Level level,
                 const std::vector<Region>& regions, const std::vector<Frame>& frames,
                 const std::vector<std::vector<int>>& paths, bool keep_on) {
  Arena::Scope scope(call.work.scratch());
  if (keep_on) level.corners = 0;  // as initial_borders has it
  const HostPaths host_paths(points, frames, paths);
  const Paths uploaded = upload_paths(call, host_paths);
  level.projections = upload_projections(call, points, regions, frames);
  const Pruned pruned =
      allocate_pruned(call.work, level, call.work.scratch().allocate<cl_uchar>(level.points + level.corners));
  prune(call.work, table, level, uploaded, keep_on, pruned);
  ASSERT_EQ(pruned.elements, level.points + level.corners);
  const auto flags = call.read(pruned.flags, pruned.elements);
  const auto chords = call.read(pruned.chord, pruned.elements);
  const auto corner_ids = call.read(level.corner_ids, 3 * level.corners);
  std::vector<cl_uchar> expected;
  std::size_t wrong_chords = 0;
  const auto expect = [&](std::size_t r, int id, bool on) {
    const PruneTwin twin = prune_twin(points, frames[r], paths[r], id, on);
    // Chords are for quickhull, which goes on with what is strictly below.
    wrong_chords +=
        !keep_on && twin.flag == 1 && chords[expected.size()] != host_paths.offsets[r] + twin.chord;
    expected.push_back(twin.flag);
  };
  for (std::size_t r = 0; r < regions.size(); ++r) {
    for (const int id : frames[r].axis == 1 ? regions[r].x_list : regions[r].y_list) expect(r, id, keep_on);
  }
  std::size_t region_of = 0, corners_left = regions.empty() ? 0 : regions[0].corners.size();
  for (std::size_t c = 0; c < level.corners; ++c) {
    while (corners_left == 0) corners_left = regions[++region_of].corners.size();
    --corners_left;
    expect(region_of, corner_ids[3 * c + 1], false);
  }
  EXPECT_TRUE(same(flags, expected)) << (keep_on ? "keep_on" : "");
  EXPECT_EQ(wrong_chords, 0u);
}

/// Prune's candidates: of each region's points in a bucket, the first of those nearest to the line.
void check_candidates(Call& call, const ExactPoints& points, const Level& level,
                      const std::vector<Region>& regions, const std::vector<Frame>& frames) {
  const std::size_t bucket = kernel::BUCKET;
  Arena::Scope scope(call.work.scratch());
  const auto flags = testing::guarded<cl_uchar>(call.runtime, level.points);
  call.runtime.map((level.points + bucket - 1) / bucket,
                   kernels::candidate_flags{.elements = level.points,
                                            .regions = level.point_regions,
                                            .projections = upload_projections(call, points, regions, frames),
                                            .flags = flags});
  std::vector<cl_uchar> expected;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const auto& list = frames[r].axis == 1 ? regions[r].x_list : regions[r].y_list;
    std::size_t best = 0;
    double best_distance = HUGE_VAL;
    for (std::size_t i = 0; i < list.size(); ++i) {
      expected.push_back(0);
      const double distance = projected(frames[r], points[list[i]]).s[0];
      if (distance < best_distance) {
        best = expected.size() - 1;
        best_distance = distance;
      }
      if (expected.size() % bucket == 0 || i + 1 == list.size()) {
        expected[best] = 1;
        best_distance = HUGE_VAL;
      }
    }
  }
  EXPECT_TRUE(same(testing::download(call.runtime, flags, level.points), expected)) << "candidates";
}

namespace {

/// So large that prune thins its candidates by candidates of their own.
TEST(Prune, OneHugeRegion) {
  const LoopOptions options{false, false, false, 2};
  Met met;
  for (const char* const name : {"kuzmin", "random-integers"}) {
    SCOPED_TRACE(name);
    check_levels(Runtimes::get(false), make_fixture(name, 100000, 11), options, met);
    check_levels(Runtimes::get(true), make_fixture(name, 10000, 12), options, met);
  }
  for (const char* const name : {"grid", "columns", "rotated-grid", "half-duplicates", "line"}) {
    SCOPED_TRACE(name);
    check_levels(Runtimes::get(false), make_fixture(name, 20000, 29), options, met);
    check_levels(Runtimes::get(true), make_fixture(name, 6000, 30), options, met);
  }
  EXPECT_EQ(met.levels, 28u);
  EXPECT_LT(met.survivors, 2 * met.path_vertices);  // prune leaves little more than the hulls
}

}  // namespace

}  // namespace flaunay::flattened
