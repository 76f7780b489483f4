// The stage `hull_depth`: depths below chords that no filter decided, exactly.
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

/// Points against the chord between two others, one chord per region; every third is decided already.
void check_depths(Runtime& runtime, const Coordinates& coordinates, FixtureRandom& random) {
  Call call(runtime);
  std::vector<cl_double2> places;
  for (std::size_t i = 0; i < coordinates.size() / 2; ++i) {
    places.push_back({{coordinates[2 * i], coordinates[2 * i + 1]}});
  }
  const ExactPoints points(places);
  const auto any = [&] {
    return static_cast<int>(random.integer(0, static_cast<std::int64_t>(places.size()) - 1));
  };
  std::vector<Frame> frames;
  std::vector<std::vector<int>> paths;
  std::vector<cl_int> axes, ids, chords;
  std::vector<cl_double> cuts;
  std::vector<cl_uchar> flags;
  while (frames.size() < 4 * places.size()) {
    const auto axis = static_cast<int>(frames.size() % 4);
    Frame frame{axis, 0.0};
    frame.q = axis < 2 ? frame.s(points[any()]) : 0.0;
    // Three columns: the ends of the chord, and a point between them.
    const std::vector<int> columns = points.lowest_by_u(frame, {any(), any(), any(), any()});
    if (columns.size() < 3) continue;
    chords.push_back(static_cast<cl_int>(3 * frames.size()));
    ids.push_back(columns[1]);
    flags.push_back(frames.size() % 3 == 0 ? 7 : 2);
    frames.push_back(frame);
    axes.push_back(axis);
    cuts.push_back(frame.q);
    // The chord in front, since `chord` names its first vertex; the point behind it is for the next check.
    paths.push_back({columns[0], columns[2], columns[0]});
  }
  PointTable table;
  table.count = places.size();
  table.points = testing::upload(runtime, places);
  Level level;
  level.regions = frames.size();
  level.axis = testing::upload(runtime, axes);
  level.cut = testing::upload(runtime, cuts);
  const Paths chord_paths = upload_paths(call, HostPaths(points, frames, paths));
  std::set<int> signs;
  for (const bool keep_on : {false, true}) {
    std::vector<cl_uchar> expected = flags;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      const int sign = points.depth_sign(frames[i], paths[i][0], paths[i][1], ids[i]);
      if (flags[i] == 2) expected[i] = sign > 0 || (keep_on && sign == 0);
      signs.insert(sign);
    }
    const auto device_flags = testing::upload(runtime, flags);
    decide_depths(call.work, table, level, chord_paths, testing::upload(runtime, ids),
                  testing::upload(runtime, chords), ids.size(), keep_on, device_flags);
    EXPECT_TRUE(same(testing::download(runtime, device_flags, flags.size()), expected)) << keep_on;
  }
  EXPECT_EQ(signs.size(), 3u);

  // Vertices of paths against the chord of their neighbours.
  std::vector<cl_uchar> vertex_flags, expected;
  for (std::size_t r = 0; r < paths.size(); ++r) {
    paths[r] = {paths[r][0], ids[r], paths[r][1]};
    const int sign = points.depth_sign(frames[r], paths[r][0], paths[r][2], ids[r]);
    vertex_flags.insert(vertex_flags.end(), {1, 2, 1});
    expected.insert(expected.end(), {1, static_cast<cl_uchar>(sign > 0), 1});
  }
  const auto device_flags = testing::upload(runtime, vertex_flags);
  decide_vertices(call.work, table, level, upload_paths(call, HostPaths(points, frames, paths)),
                  device_flags);
  EXPECT_TRUE(same(testing::download(runtime, device_flags, expected.size()), expected)) << "vertices";
}

TEST(SmallHullDepth, IsDecidedExactly) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(37);
    check_depths(runtime, make_fixture("small-integers", 12, 38), random);
  });
}

TEST(HullDepth, IsDecidedExactly) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(39);
    for (const char* const name : {"grid", "small-integers", "hexagonal", "thirty-lines"}) {
      SCOPED_TRACE(name);
      check_depths(runtime, long_numbers(name, 300, 40), random);
    }
  });
}

}  // namespace
}  // namespace flaunay::flattened
