// Every stage of the flattened triangulator against its plain twin (support/stage_twins.hpp), on random and
// on degenerate input, under the device's own tuning and under one of odd, small sizes.
//
// Suites named Small... have tiny inputs, for slow simulators: oclgrind test_stages --gtest_filter='Small*'
#include "flattened/stages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <numeric>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "flattened/self_test.hpp"
#include "host/device.hpp"
#include "host/vector_operations.hpp"
#include "tests/support/device.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/same.hpp"
#include "tests/support/stage_twins.hpp"

namespace flaunay::flattened {
namespace {

using host::Runtime;
using testing::BordersTwin;
using testing::Coordinates;
using testing::Corner;
using testing::ExactPoints;
using testing::FixtureRandom;
using testing::Frame;
using testing::IngestTwin;
using testing::make_fixture;
using testing::MergeCounts;
using testing::Region;
using testing::Regions;
using testing::same;
using testing::TriangleSet;

constexpr bool kSmall[] = {false, true};

/// One runtime for each tuning, destroyed before the OpenCL implementation leaves.
class Runtimes : public ::testing::Environment {
 public:
  void TearDown() override { all().clear(); }
  static Runtime& get(bool small) {
    std::unique_ptr<Runtime>& runtime = all()[small];
    if (!runtime) {
      const char* const before = std::getenv("FLAUNAY_TUNING");
      const testing::ScopedEnvironment kind("FLAUNAY_TUNING", small ? "small" : before);
      runtime = std::make_unique<Runtime>(host::find_device(""));
      if (small || (before != nullptr && std::string(before) == "small")) {
        // Small regions so small that many others count as large.
        host::Tuning tuning = runtime->tuning();
        tuning.small_region = 4;
        runtime->set_tuning(tuning);
      }
    }
    return *runtime;
  }

 private:
  static std::map<bool, std::unique_ptr<Runtime>>& all() {
    static std::map<bool, std::unique_ptr<Runtime>> runtimes;
    return runtimes;
  }
};
[[maybe_unused]] ::testing::Environment* const kRuntimes = ::testing::AddGlobalTestEnvironment(new Runtimes);

/// Under the tuning that the environment names alone, if it names one.
template <typename Check>
void under_each_tuning(const Check& check) {
  const bool chosen = std::getenv("FLAUNAY_TUNING") != nullptr;
  for (const bool small : kSmall) {
    if (small && chosen) continue;
    SCOPED_TRACE(small ? "small tuning" : "own tuning");
    check(Runtimes::get(small));
  }
}

/// Bounds under which no filter decides anything: all goes to the exact kernels.
constexpr Bounds kUndecided{2, 2, 2};

/// What triangulator.cpp sets up around the stages; state is never released before the end.
class Call {
 public:
  explicit Call(Runtime& used)
      : runtime(used),
        persistent_(used.context(), used.device()),
        state_(used.context(), used.device()),
        scope_(used.arena()),
        work{used, persistent_, statistics_} {
    work.children = &state_;
    if (used.tuning().separate_buffers) {
      persistent_.separate_buffers();
      state_.separate_buffers();
    }
    work.broken = persistent_.allocate<cl_int>(1);
    work.list_length = persistent_.allocate<cl_uint>(1);
    work.undecided = persistent_.allocate<cl_uint>(1);
    work.largest = persistent_.allocate<cl_int>(kMostLevels);
    runtime.fill(work.broken, 1, cl_int{0});
    runtime.fill(work.undecided, 1, cl_uint{0});
    runtime.fill(work.largest, kMostLevels, cl_int{0});
  }

  template <typename T>
  std::vector<T> read(const Buffer<T>& buffer, std::size_t count) {
    std::vector<T> values(count);
    runtime.read(buffer, 0, count, values.data());
    return values;
  }
  std::size_t undecided() { return runtime.read_one(work.undecided, 0); }
  cl_int broken() { return runtime.read_one(work.broken, 0); }

  Runtime& runtime;

 private:
  Arena persistent_, state_;
  Arena::Scope scope_;
  Statistics statistics_;

 public:
  Workspace work;
};

/// Corner triples and offsets as corners by region.
std::vector<std::vector<Corner>> corners_by_region(const std::vector<cl_int>& ids,
                                                   const std::vector<cl_int>& offsets) {
  std::vector<std::vector<Corner>> regions;
  for (std::size_t r = 0; r + 1 < offsets.size(); ++r) {
    std::vector<Corner> corners;
    for (cl_int c = offsets[r]; c < offsets[r + 1]; ++c)
      corners.push_back({ids[3 * c], ids[3 * c + 1], ids[3 * c + 2]});
    regions.push_back(corners);
  }
  return regions;
}

/// offsets[r] counts what is in regions before r, of the ascending regions of elements.
std::vector<cl_int> offsets_of(const std::vector<cl_int>& regions, std::size_t count) {
  std::vector<cl_int> offsets;
  for (std::size_t r = 0; r <= count; ++r) {
    offsets.push_back(static_cast<cl_int>(
        std::lower_bound(regions.begin(), regions.end(), static_cast<cl_int>(r)) - regions.begin()));
  }
  return offsets;
}

/// The device's regions in the twin's form; also holds their redundant arrays against each other.
Regions download(Call& call, const Level& level, const RetiredRegions& retired) {
  Regions regions;
  const auto x_list = call.read(level.x_list, level.points);
  const auto y_list = call.read(level.y_list, level.points);
  const auto corner_ids = call.read(level.corner_ids, 3 * level.corners);
  const auto point_offsets = call.read(level.point_offsets, level.regions + 1);
  const auto corner_offsets = call.read(level.corner_offsets, level.regions + 1);
  EXPECT_TRUE(same(point_offsets, offsets_of(call.read(level.point_regions, level.points), level.regions)));
  EXPECT_TRUE(
      same(corner_offsets, offsets_of(call.read(level.corner_regions, level.corners), level.regions)));
  const auto corners = corners_by_region(corner_ids, corner_offsets);
  for (std::size_t r = 0; r < level.regions; ++r) {
    Region region;
    region.x_list.assign(x_list.begin() + point_offsets[r], x_list.begin() + point_offsets[r + 1]);
    region.y_list.assign(y_list.begin() + point_offsets[r], y_list.begin() + point_offsets[r + 1]);
    region.corners = corners[r];
    std::sort(region.corners.begin(), region.corners.end());
    regions.open.push_back(std::move(region));
  }
  const auto retired_offsets = call.read(retired.offsets, retired.regions + 1);
  EXPECT_EQ(static_cast<std::size_t>(retired_offsets.back()), retired.corners);
  for (auto& some : corners_by_region(call.read(retired.corner_ids, 3 * retired.corners), retired_offsets)) {
    std::sort(some.begin(), some.end());
    regions.retired.push_back({{}, {}, std::move(some)});
  }
  return regions;
}

::testing::AssertionResult same_regions(const Regions& found, const Regions& expected) {
  for (const bool retired : {false, true}) {
    const std::vector<Region>& f = retired ? found.retired : found.open;
    const std::vector<Region>& e = retired ? expected.retired : expected.open;
    const char* const kind = retired ? "retired" : "open";
    if (f.size() != e.size()) {
      return ::testing::AssertionFailure() << f.size() << " regions " << kind << " instead of " << e.size();
    }
    for (std::size_t r = 0; r < f.size(); ++r) {
      if (f[r] == e[r]) continue;
      return ::testing::AssertionFailure()
             << kind << " region " << r << ": " << (f[r].corners == e[r].corners ? "lists" : "corners")
             << " differ";
    }
  }
  return ::testing::AssertionSuccess();
}

/// What the tests met, so that they can say that they met it.
struct Met {
  std::size_t levels = 0;
  std::size_t regions = 0;
  std::size_t retired = 0;
  std::size_t large = 0;              ///< retired regions that went to strips
  std::size_t mirrored_ends = 0;      ///< hull ends chosen among several vertices of one u
  std::size_t equal_u = 0;            ///< points above a path vertex, in one column
  std::size_t equal_projections = 0;  ///< mirror images in the line
  std::size_t on_chord = 0;           ///< points on the path that are no vertices
  std::size_t undecided_hull = 0, undecided_merge = 0, undecided_endgame = 0;
  std::size_t survivors = 0, path_vertices = 0;  ///< of prune, and of the hulls they were for
  MergeCounts merge;
};

/// (h, u), rounded as the kernels do.
cl_double2 projected(const Frame& frame, const cl_double2& p) {
  const double across = frame.s(p) - frame.q;
  return {{frame.planar() ? across : across * across, frame.u(p)}};
}

/// Paths as they should be, or made by hand: ids in the order of u for each region.
struct HostPaths {
  HostPaths(const ExactPoints& points, const std::vector<Frame>& frames,
            const std::vector<std::vector<int>>& paths) {
    for (std::size_t r = 0; r < paths.size(); ++r) {
      for (const int id : paths[r]) {
        vertices.push_back(id);
        regions.push_back(static_cast<cl_int>(r));
        projections.push_back(projected(frames[r], points[id]));
      }
      offsets.push_back(static_cast<cl_int>(vertices.size()));
    }
  }
  std::vector<cl_int> vertices, regions, offsets{0};
  std::vector<cl_double2> projections;
};

Paths upload_paths(Call& call, const HostPaths& paths) {
  Paths uploaded;
  uploaded.size = paths.vertices.size();
  uploaded.vertices = testing::upload(call.runtime, paths.vertices);
  uploaded.projections = testing::upload(call.runtime, paths.projections);
  uploaded.regions = testing::upload(call.runtime, paths.regions);
  uploaded.offsets = testing::upload(call.runtime, paths.offsets);
  return uploaded;
}

void expect_paths(Call& call, const Paths& paths, const HostPaths& expected) {
  EXPECT_TRUE(same(call.read(paths.vertices, paths.size), expected.vertices));
  EXPECT_TRUE(same(call.read(paths.projections, paths.size), expected.projections));
  EXPECT_TRUE(same(call.read(paths.regions, paths.size), expected.regions));
  EXPECT_TRUE(same(call.read(paths.offsets, expected.offsets.size()), expected.offsets));
}

/// All points of each region in any order, below the chord between its ends.
HullPoints upload_hull_points(Call& call, const ExactPoints& points, const std::vector<Frame>& frames,
                              const std::vector<std::vector<int>>& ids_of_regions,
                              const std::vector<std::vector<int>>& ends) {
  std::vector<cl_int> ids, segments, first;
  std::vector<cl_double2> projections;
  for (std::size_t r = 0; r < ids_of_regions.size(); ++r) {
    first.push_back(static_cast<cl_int>(ids.size()));
    for (const int id : ids_of_regions[r]) {
      ids.push_back(id);
      segments.push_back(static_cast<cl_int>(2 * r));
      projections.push_back(projected(frames[r], points[id]));
    }
    first.push_back(static_cast<cl_int>(ids.size()));
  }
  first.push_back(static_cast<cl_int>(ids.size()));
  HullPoints uploaded;
  uploaded.size = ids.size();
  uploaded.ids = testing::upload(call.runtime, ids);
  uploaded.segments = testing::upload(call.runtime, segments);
  uploaded.projections = testing::upload(call.runtime, projections);
  uploaded.ends = upload_paths(call, HostPaths(points, frames, ends));
  uploaded.first = testing::upload(call.runtime, first);
  return uploaded;
}

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

/// Prune against paths made by hand, which need be no hulls: of some of each region's points.
void check_prune(Call& call, const ExactPoints& points, const PointTable& table, Level level,
                 const std::vector<Region>& regions, const std::vector<Frame>& frames,
                 const std::vector<std::vector<int>>& paths, bool keep_on) {
  Arena::Scope scope(call.work.scratch());
  if (keep_on) level.corners = 0;  // as initial_borders has it
  const HostPaths host_paths(points, frames, paths);
  const Paths uploaded = upload_paths(call, host_paths);
  level.projections = upload_projections(call, points, regions, frames);
  const Pruned pruned = allocate_pruned(call.work, level);
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
  const std::string source = host::kernel_source("prune");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(source, match, std::regex("#define BUCKET (\\d+)")));
  const auto bucket = static_cast<std::size_t>(std::stoi(match[1]));
  Arena::Scope scope(call.work.scratch());
  const auto flags = testing::guarded<cl_uchar>(call.runtime, level.points);
  call.runtime.map("prune", "candidate_flags", (level.points + bucket - 1) / bucket,
                   static_cast<cl_int>(level.points), level.point_regions,
                   upload_projections(call, points, regions, frames), flags);
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

/// Quickhull with nothing pruned and points in any order; then the clean-up of a path of all columns.
void check_quickhull(Call& call, const ExactPoints& points, const PointTable& table, const Level& level,
                     const std::vector<Region>& regions, const std::vector<Frame>& frames,
                     const std::vector<std::vector<int>>& expected, FixtureRandom& random) {
  Arena::Scope scope(call.work.scratch());
  std::vector<std::vector<int>> shuffled, columns, ends;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    shuffled.push_back(regions[r].points());
    random.shuffle(shuffled.back());
    ends.push_back({expected[r].front(), expected[r].back()});
    columns.push_back(points.lowest_by_u(frames[r], shuffled.back()));
  }
  const HostPaths expected_paths(points, frames, expected);
  int rounds = 0;
  const Paths path =
      quickhull(call.work, table, level, upload_hull_points(call, points, frames, shuffled, ends), rounds);
  {
    SCOPED_TRACE("quickhull");
    expect_paths(call, strict(call.work, table, level, path), expected_paths);
  }
  SCOPED_TRACE("strict");
  const Paths all_columns = upload_paths(call, HostPaths(points, frames, columns));
  expect_paths(call, strict(call.work, table, level, all_columns), expected_paths);
}

void check_hulls(Call& call, const ExactPoints& points, const Level& level,
                 const std::vector<Region>& regions, const std::vector<Frame>& frames, const Paths& paths,
                 const std::vector<std::vector<int>>& expected, Met& met) {
  SCOPED_TRACE("hulls");
  expect_paths(call, paths, HostPaths(points, frames, expected));
  // Nothing on the path is dropped by prune.
  const auto flags = call.read(paths.flags, level.points + level.corners);
  const auto corner_ids = call.read(level.corner_ids, 3 * level.corners);
  std::size_t i = 0, c = 0, dropped_from_path = 0;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const std::set<int> on_path(expected[r].begin(), expected[r].end());
    for (const int id : frames[r].axis == 1 ? regions[r].x_list : regions[r].y_list) {
      dropped_from_path += on_path.count(id) != 0 && flags[i] == 0;
      ++i;
    }
    for (std::size_t k = 0; k < regions[r].corners.size(); ++k, ++c) {
      dropped_from_path += on_path.count(corner_ids[3 * c + 1]) != 0 && flags[level.points + c] == 0;
    }
    const std::vector<int> all = regions[r].points();
    if (all.size() > 2000) continue;
    for (const int id : all) {
      if (on_path.count(id) != 0) continue;
      const auto above =
          std::upper_bound(expected[r].begin(), expected[r].end(), frames[r].u(points[id]),
                           [&](double value, int other) { return value < frames[r].u(points[other]); });
      const int v = *(above - 1);
      if (frames[r].u(points[v]) == frames[r].u(points[id])) {
        ++met.equal_u;
        // Mirror images have s - q of opposite signs and nothing between them.
        met.equal_projections +=
            frames[r].s(points[v]) - frames[r].q == frames[r].q - frames[r].s(points[id]);
      } else {
        met.on_chord += points.depth_sign(frames[r], v, *above, id) == 0;
      }
    }
  }
  EXPECT_EQ(dropped_from_path, 0u);
}

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
    met.large += region.corners.size() > static_cast<std::size_t>(call.runtime.tuning().small_region);
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
    const std::size_t made = endgame(call.work, table, retired, triangles, kBase);
    call.work.bounds = bounds;
    ASSERT_EQ(made, total);
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
    ASSERT_EQ(testing::region_fault(points, regions[r].corners, {row, end}), "") << "region " << r;
    row = end;
  }
  EXPECT_EQ(call.broken(), 0);
}

struct LoopOptions {
  bool undecided = false;  ///< let no filter decide
  bool alternate = false;  ///< cut x and y in turn
  bool parts = true;       ///< also prune, quickhull and clean-up on their own
  std::size_t levels = 1000;
};

/// Runs the level loop and holds every stage of every level against its twin, the twin being fed with what
/// the device had before. Stops at the first level that differs.
void check_levels(Runtime& runtime, const Coordinates& coordinates, const std::vector<std::size_t>& offsets,
                  const LoopOptions& options, Met& met) {
  Call call(runtime);
  Workspace& work = call.work;
  FixtureRandom random(coordinates.size());
  std::vector<std::int32_t> representatives(coordinates.size() / 2);
  PointTable table = ingest(work, coordinates.data(), offsets, representatives.data());
  if (options.undecided) work.bounds = kUndecided;
  const ExactPoints points(call.read(table.points, table.count));
  const auto set_offsets = call.read(table.set_offsets, table.sets + 1);

  Level level;
  RetiredRegions retired;
  const Borders borders = initial_borders(work, table, level, retired);
  const BordersTwin borders_twin =
      testing::borders_twin(points, set_offsets, call.read(table.y_order, table.count));
  EXPECT_TRUE(same(call.read(borders.hull, borders.size), borders_twin.hull));
  EXPECT_TRUE(same(borders.hull_offsets, borders_twin.hull_offsets));
  EXPECT_EQ(borders.triangles, borders_twin.triangles);
  const auto side = call.read(table.side, table.count);
  for (std::size_t id = 0; id < table.count; ++id)
    ASSERT_EQ(side[id] == 2, borders_twin.on_border[id]) << "id " << id;
  Regions regions = download(call, level, retired);
  ASSERT_TRUE(same_regions(regions, borders_twin.regions));
  check_endgame(call, points, table, retired, regions.retired, met);
  std::size_t triangles = 0;
  const auto count_retired = [&] {
    for (const Region& region : regions.retired) triangles += testing::triangle_count_twin(region.corners);
    met.retired += regions.retired.size();
  };
  count_retired();

  std::size_t depth = 0;
  for (; level.regions > 0 && depth < options.levels && !::testing::Test::HasFailure(); ++depth) {
    SCOPED_TRACE("level " + std::to_string(depth) + " of " + std::to_string(level.regions) + " regions");
    Arena::Scope scope(work.scratch());
    ++met.levels;
    met.regions += level.regions;
    const int alternate = options.alternate ? static_cast<int>(depth % 2) : -1;
    cut(work, table, level, 0, alternate);
    std::vector<Frame> frames;
    std::vector<cl_int> axes, first_ends, last_ends;
    std::vector<cl_double> cuts;
    std::vector<std::vector<int>> expected_paths;
    for (const Region& region : regions.open) {
      frames.push_back(testing::cut_twin(points, region, alternate));
      const auto ends = testing::ends_twin(points, frames.back(), region);
      axes.push_back(frames.back().axis);
      cuts.push_back(frames.back().q);
      first_ends.push_back(ends.first);
      last_ends.push_back(ends.second);
      expected_paths.push_back(points.lower_hull(frames.back(), region.points()));
      std::set<int> lowest, highest;
      for (const Corner& corner : region.corners) {
        const double u = frames.back().u(points[corner.vertex]);
        if (u == frames.back().u(points[ends.first])) lowest.insert(corner.vertex);
        if (u == frames.back().u(points[ends.second])) highest.insert(corner.vertex);
      }
      met.mirrored_ends += (lowest.size() > 1) + (highest.size() > 1);
    }
    EXPECT_TRUE(same(call.read(level.axis, level.regions), axes)) << "axis";
    EXPECT_TRUE(same(call.read(level.cut, level.regions), cuts)) << "cut";
    EXPECT_TRUE(same(call.read(level.first_end, level.regions), first_ends)) << "first_end";
    EXPECT_TRUE(same(call.read(level.last_end, level.regions), last_ends)) << "last_end";
    if (::testing::Test::HasFailure()) return;

    if (options.parts) {
      // Paths through the ends, some vertices of the hull and some other points.
      std::vector<std::vector<int>> rough;
      for (std::size_t r = 0; r < regions.open.size(); ++r) {
        std::vector<int> some;
        const auto columns = points.lowest_by_u(frames[r], regions.open[r].points());
        const std::set<int> hull(expected_paths[r].begin(), expected_paths[r].end());
        for (std::size_t k = 0; k < columns.size(); ++k) {
          const bool is_end = k == 0 || k + 1 == columns.size();
          if (is_end || random.integer(0, hull.count(columns[k]) != 0 ? 2 : 20) == 0)
            some.push_back(columns[k]);
        }
        rough.push_back(some);
      }
      check_candidates(call, points, level, regions.open, frames);
      check_prune(call, points, table, level, regions.open, frames, rough, false);
      check_prune(call, points, table, level, regions.open, frames, expected_paths, true);
      check_quickhull(call, points, table, level, regions.open, frames, expected_paths, random);
      for (const Hull variant : {Hull::quickhull, Hull::balanced}) {
        SCOPED_TRACE(to_string(variant));
        Arena::Scope variant_scope(work.scratch());
        work.hull = variant;
        LevelStatistics ignored;
        project(work, table, level);
        const Paths paths = hulls(work, table, level, ignored);
        work.hull = Hull::prune;
        expect_paths(call, paths, HostPaths(points, frames, expected_paths));
      }
    }

    const std::size_t undecided = call.undecided();
    LevelStatistics statistics;
    project(work, table, level);
    const Paths paths = hulls(work, table, level, statistics);
    met.undecided_hull += call.undecided() - undecided;
    met.survivors += statistics.survivors;
    met.path_vertices += paths.size;
    check_hulls(call, points, level, regions.open, frames, paths, expected_paths, met);
    if (::testing::Test::HasFailure()) return;

    Regions expected;
    for (std::size_t r = 0; r < regions.open.size(); ++r) {
      for (Region& child :
           testing::merge_twin(points, regions.open[r], frames[r], expected_paths[r], met.merge)) {
        expected.add(std::move(child));
      }
    }
    Level next;
    const std::size_t undecided_before = call.undecided();
    merge(work, table, level, paths, next, retired);
    met.undecided_merge += call.undecided() - undecided_before;
    Regions found = download(call, next, retired);
    ASSERT_TRUE(same_regions(found, expected));
    regions = std::move(found);
    check_endgame(call, points, table, retired, regions.retired, met);
    count_retired();
    level = next;
  }
  if (level.regions == 0) {
    EXPECT_EQ(triangles, borders.triangles);
  }
  EXPECT_EQ(call.broken(), 0);
}

void check_levels(Runtime& runtime, const Coordinates& coordinates, const LoopOptions& options, Met& met) {
  check_levels(runtime, coordinates, {0, coordinates.size() / 2}, options, met);
}

/// Few values of coordinates, so that points coincide and line up.
Coordinates coarse_points(std::size_t n, int values, FixtureRandom& random) {
  Coordinates points;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const auto value = static_cast<double>(random.integer(-values, values));
    points.push_back(value == 0 && random.integer(0, 1) == 0 ? -0.0 : value);
  }
  return points;
}

/// Sizes of sets, some of them 0, as offsets.
std::vector<std::size_t> random_offsets(std::size_t sets, std::int64_t largest, FixtureRandom& random) {
  std::vector<std::size_t> offsets{0};
  for (std::size_t s = 0; s < sets; ++s) {
    const std::int64_t size = random.integer(0, 2) == 0 ? 0 : random.integer(0, largest);
    offsets.push_back(offsets.back() + static_cast<std::size_t>(size));
  }
  return offsets;
}

/// Exactly the structure of a fixture of few bits, but with so many bits that filters leave it undecided.
Coordinates long_numbers(const std::string& fixture, std::size_t n, std::uint64_t seed) {
  return testing::scaled(make_fixture(fixture, n, seed), 1 + 0x1.6b8a3p-12 + 0x1p-31);
}

// -----------------------------------------------------------------------------------------------------------
// Ingest

void check_ingest(Runtime& runtime, const Coordinates& coordinates, const std::vector<std::size_t>& offsets) {
  Call call(runtime);
  const IngestTwin twin = testing::ingest_twin(coordinates, offsets);
  std::vector<std::int32_t> representatives(coordinates.size() / 2);
  const PointTable table = ingest(call.work, coordinates.data(), offsets, representatives.data());
  EXPECT_EQ(table.input_count, coordinates.size() / 2);
  EXPECT_EQ(table.sets, offsets.size() - 1);
  ASSERT_EQ(table.count, twin.points.size());
  EXPECT_TRUE(same(call.read(table.points, table.count), twin.points));
  EXPECT_TRUE(same(call.read(table.source, table.count), twin.source));
  EXPECT_TRUE(same(call.read(table.set_of_id, table.count), twin.set_of_id));
  EXPECT_TRUE(same(call.read(table.set_offsets, table.sets + 1), twin.set_offsets));
  EXPECT_TRUE(same(call.read(table.y_order, table.count), twin.y_order));
  EXPECT_TRUE(same(representatives, twin.representatives));
  // Products of 3, 2 and 4 coordinates are exact if they have so few bits.
  EXPECT_EQ(call.work.bounds.hull == 0, twin.bits <= 16) << twin.bits;
  EXPECT_EQ(call.work.bounds.orient == 0, twin.bits <= 25) << twin.bits;
  EXPECT_EQ(call.work.bounds.circle == 0, twin.bits <= 11) << twin.bits;
}

TEST(SmallIngest, SortsDuplicatesOfSeveralSets) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(1);
    check_ingest(runtime, {-0.0, 0.0, 0.0, -0.0, 1.0, -0.0, 1.0, 0.0}, {0, 4});
    check_ingest(runtime, {2.5, -1.5}, {0, 0, 1, 1, 1});
    for (std::size_t n = 2; n <= 40; n += 19) {
      check_ingest(runtime, coarse_points(n, 2, random), {0, n});
      check_ingest(runtime, coarse_points(n, 2, random), {0, 0, n / 3, n / 3, n / 2, n, n});
    }
  });
}

TEST(Ingest, SortsAndRenumbers) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(2);
    for (const int values : {1, 5, 1000}) {
      check_ingest(runtime, coarse_points(3000, values, random), {0, 3000});
      for (const std::size_t sets : {2, 50, 3000}) {
        const auto offsets = random_offsets(sets, 6000 / static_cast<std::int64_t>(sets), random);
        check_ingest(runtime, coarse_points(offsets.back(), values, random), offsets);
      }
    }
    for (const char* const name : {"uniform", "kuzmin", "half-duplicates", "log-spiral", "columns"}) {
      SCOPED_TRACE(name);
      check_ingest(runtime, make_fixture(name, 5000, 3), {0, 5000});
    }
  });
}

TEST(Ingest, ScalesByAPowerOfTwo) {
  under_each_tuning([](Runtime& runtime) {
    const Coordinates uniform = make_fixture("uniform", 200, 4);
    for (const double factor :
         {1e150, 1e-150, 1e300, 1e-300, 0x1p-1000, 0x1p249, 0x1p250, 0x1p-203, 0x1p-204}) {
      SCOPED_TRACE(factor);
      check_ingest(runtime, testing::scaled(uniform, factor), {0, 200});
    }
    // Subnormal numbers, and the two ends of the range of magnitudes.
    check_ingest(runtime, {0x1p-1074, 0.0, -0x1.8p-1073, 0x1p-1050, 0.0, 0.0}, {0, 3});
    check_ingest(runtime, {0x1p249, 0.0, 0x1p-255, 1.0, -1.0, 0x1p-100}, {0, 3});
    check_ingest(runtime, {0x1p1023, 0.0, 0x1p519, 0x1.8p664, -0x1.8p565, 0x1p600}, {0, 3});
    check_ingest(runtime, {0x1p-570, 0.0, 0x1p-1074, 0x1p-800, -0x1p-900, 0x1p-700}, {0, 3});
    for (const int bits : {11, 12, 16, 17, 25, 26}) {
      SCOPED_TRACE(bits);
      check_ingest(runtime, {1.0, std::ldexp(1.0, bits - 1), 3.0, 0.0}, {0, 2});
    }
  });
}

TEST(SmallIngest, NamesTheFirstPointThatCannotBe) {
  under_each_tuning([](Runtime& runtime) {
    for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
      Coordinates points(60, 1.0);
      points[2 * 23] = bad;
      points[2 * 17 + 1] = bad;
      Call call(runtime);
      std::vector<std::int32_t> representatives(30);
      try {
        ingest(call.work, points.data(), {0, 30}, representatives.data());
        ADD_FAILURE() << "no exception for " << bad;
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_NE(std::string(error.what()).find("point 17 "), std::string::npos) << error.what();
      }
    }
    Call call(runtime);
    std::int32_t representatives[2];
    const double far[] = {0x1p250, 0.0, 1.0, 0x1p-255};
    EXPECT_THROW(ingest(call.work, far, {0, 2}, representatives), Error);
  });
}

// -----------------------------------------------------------------------------------------------------------
// Borders of whole sets: check_levels without levels

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
      runtime.map("border", "set_ends", table.sets, table.set_offsets, table.points, axis, cuts, first, last);
      EXPECT_TRUE(same(testing::download(runtime, axis, 2 * table.sets), axes));
      EXPECT_TRUE(same(testing::download(runtime, first, 2 * table.sets), first_ends));
      EXPECT_TRUE(same(testing::download(runtime, last, 2 * table.sets), last_ends));
    }
  });
}

// -----------------------------------------------------------------------------------------------------------
// The level loop: cut, hulls, prune, quickhull, merge, end game

void check_fixtures(const std::vector<std::string>& names, std::size_t n, const LoopOptions& options,
                    Met& met) {
  under_each_tuning([&](Runtime& runtime) {
    for (const std::string& name : names) {
      SCOPED_TRACE(name);
      check_levels(runtime, make_fixture(name, n, 7), options, met);
    }
  });
}

TEST(SmallLevelLoop, GridAndScatter) {
  Met met;
  check_fixtures({"grid", "uniform"}, 25, {}, met);
  check_fixtures({"small-integers"}, 20, {true, false, false, 1000}, met);
  EXPECT_GT(met.merge.corners_by_parts[2], 0u);
  EXPECT_GT(met.retired, 4u);
}

TEST(SmallLevelLoop, ManySets) {
  Met met;
  under_each_tuning([&](Runtime& runtime) {
    FixtureRandom random(8);
    check_levels(runtime, coarse_points(40, 3, random), {0, 0, 9, 12, 30, 30, 40}, {}, met);
  });
  EXPECT_GT(met.regions, 2u);
}

TEST(LevelLoop, GeneralPosition) {
  Met met;
  check_fixtures({"uniform", "normal", "kuzmin", "line", "clusters", "spiral", "log-spiral", "slender",
                  "corners", "far-away", "parabola"},
                 700, {}, met);
  EXPECT_GT(met.levels, 80u);
  EXPECT_GT(met.merge.corners_by_parts[1], 0u);
  EXPECT_GT(met.merge.corners_by_parts[2], 0u);
  EXPECT_GT(met.merge.corners_by_parts[3], 0u);
  EXPECT_GT(met.merge.path_leaves_region, 0u);
  EXPECT_GT(met.merge.path_on_border, 0u);
  EXPECT_GT(met.merge.pinch_points, 0u);
  EXPECT_GT(met.undecided_hull, 0u);
  EXPECT_GT(met.large, 0u);
}

TEST(LevelLoop, Degenerate) {
  Met met;
  check_fixtures({"grid", "rotated-grid", "hexagonal", "circle", "integer-circle", "nested-circles",
                  "columns", "small-integers", "half-duplicates", "two-lines", "thirty-lines", "star",
                  "integer-star", "circle-few-inside", "ladder", "apex", "triangle-edges", "random-integers"},
                 500, {}, met);
  EXPECT_GT(met.merge.corners_by_parts[1], 0u);
  EXPECT_GT(met.merge.corners_by_parts[2], 0u);
  EXPECT_GT(met.merge.corners_by_parts[3], 0u);
  EXPECT_GT(met.merge.path_leaves_region, 0u);
  EXPECT_GT(met.merge.path_on_border, 0u);
  EXPECT_GT(met.merge.pinch_points, 0u);
  EXPECT_GT(met.mirrored_ends, 0u);
  EXPECT_GT(met.equal_u, 0u);
  EXPECT_GT(met.equal_projections, 0u);
  EXPECT_GT(met.on_chord, 0u);
  EXPECT_GT(met.large, 0u);
}

TEST(LevelLoop, UndecidedPredicates) {
  Met met;
  under_each_tuning([&](Runtime& runtime) {
    for (const char* const name :
         {"grid", "small-integers", "integer-circle", "hexagonal", "thirty-lines", "ladder"}) {
      SCOPED_TRACE(name);
      check_levels(runtime, long_numbers(name, 400, 9), {}, met);
    }
  });
  EXPECT_GT(met.undecided_hull, 100u);
  EXPECT_GT(met.undecided_endgame + met.large, 10u);
  EXPECT_GT(met.merge.corners_by_parts[3], 0u);
  EXPECT_GT(met.merge.pinch_points, 0u);
}

TEST(LevelLoop, NothingFiltered) {
  Met met;
  check_fixtures({"uniform", "kuzmin", "grid", "random-integers", "columns", "log-spiral"}, 300,
                 {true, false, true, 1000}, met);
  EXPECT_GT(met.undecided_hull, 1000u);
  EXPECT_GT(met.undecided_merge, 1000u);
  EXPECT_GT(met.undecided_endgame + met.large, 100u);
}

TEST(LevelLoop, AlternatingCuts) {
  Met met;
  check_fixtures({"uniform", "line", "grid", "integer-circle", "kuzmin", "columns"}, 400,
                 {false, true, false, 1000}, met);
  EXPECT_GT(met.levels, 30u);
}

TEST(LevelLoop, ManySets) {
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

/// So large that prune thins its candidates by candidates of their own.
TEST(LevelLoop, OneHugeRegion) {
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

/// Squares with one or two points inside, and some without: as many regions as sets.
TEST(LevelLoop, AHundredThousandTinyRegions) {
  Met met;
  for (const bool small : kSmall) {
    FixtureRandom random(13);
    Coordinates points;
    std::vector<std::size_t> offsets{0};
    std::size_t open = 0;
    for (int s = 0; s < (small ? 5000 : 110000); ++s) {
      for (const double corner : {0.0, 0.0, 8.0, 0.0, 8.0, 8.0, 0.0, 8.0}) points.push_back(corner);
      const std::int64_t inside = s % 10 == 9 ? 0 : random.integer(1, 2);
      for (std::int64_t i = 0; i < 2 * inside; ++i)
        points.push_back(static_cast<double>(random.integer(1, 7)));
      open += inside > 0;
      offsets.push_back(points.size() / 2);
    }
    const std::size_t before = met.regions;
    check_levels(Runtimes::get(small), points, offsets, {false, false, false, 1000}, met);
    EXPECT_GE(met.regions - before, open);
  }
  EXPECT_GT(met.regions, 100000u);
}

// -----------------------------------------------------------------------------------------------------------
// Quickhull's balanced rounds

/// Points (2^i, 4^i): the deepest is always next to the end, so that splits by depth alone take a round each.
TEST(Quickhull, BalancesAfterManyRounds) {
  under_each_tuning([](Runtime& runtime) {
    Call call(runtime);
    constexpr int kPoints = 120;
    std::vector<cl_double2> places;
    for (int i = 0; i < kPoints; ++i) places.push_back({{std::ldexp(1.0, i), std::ldexp(1.0, 2 * i)}});
    const ExactPoints points(places);
    PointTable table;
    table.count = kPoints;
    table.points = testing::upload(runtime, places);
    std::vector<int> all(kPoints);
    std::iota(all.begin(), all.end(), 0);
    const std::vector<Frame> frames{{2, 0.0}};
    Level level;
    level.regions = 1;
    level.axis = testing::upload(runtime, std::vector<cl_int>{2});
    level.cut = testing::upload(runtime, std::vector<cl_double>{0.0});
    const HullPoints hull_points = upload_hull_points(call, points, frames, {all}, {{0, kPoints - 1}});
    call.work.bounds = {1e-14, 1e-14, 1e-14};
    int rounds = 0;
    const Paths paths = quickhull(call.work, table, level, hull_points, rounds);
    EXPECT_GT(rounds, 64);   // so the balanced ones were met
    EXPECT_LT(rounds, 100);  // and were fewer
    ASSERT_EQ(points.lower_hull(frames[0], all), all);
    expect_paths(call, strict(call.work, table, level, paths), HostPaths(points, frames, {all}));
  });
}

/// A parabola's points and one far below: each round lays bare one more vertex on either side, until
/// quickhull of what is left ends that. Two regions, so that only one of them has much to do.
void check_restart(Runtime& runtime) {
  Call call(runtime);
  constexpr int kHalf = 40;
  std::vector<cl_double2> places;
  for (int i = -kHalf; i <= kHalf; ++i) {
    places.push_back({{static_cast<double>(i), i == 0 ? -1000.0 * kHalf * kHalf : 1.0 * i * i}});
  }
  const ExactPoints points(places);
  PointTable table;
  table.count = places.size();
  table.points = testing::upload(runtime, places);
  std::vector<int> all(places.size());
  std::iota(all.begin(), all.end(), 0);
  const std::vector<int> some{0, 3, kHalf};
  const std::vector<Frame> frames{{2, 0.0}, {2, 0.0}};
  Level level;
  level.regions = 2;
  level.axis = testing::upload(runtime, std::vector<cl_int>{2, 2});
  level.cut = testing::upload(runtime, std::vector<cl_double>{0.0, 0.0});
  const std::vector<int> expected{0, kHalf, 2 * kHalf};
  ASSERT_EQ(points.lower_hull(frames[0], all), expected);
  for (const Bounds& bounds : {Bounds{}, kUndecided}) {
    call.work.bounds = bounds;
    const Paths paths = upload_paths(call, HostPaths(points, frames, {all, some}));
    expect_paths(call, strict(call.work, table, level, paths),
                 HostPaths(points, frames, {expected, points.lower_hull(frames[1], some)}));
  }
}

TEST(Quickhull, CleanUpThatLaysBareOneVertexAtATime) { under_each_tuning(check_restart); }

// -----------------------------------------------------------------------------------------------------------
// Regions of cocircular vertices

/// All points of integer coordinates with x^2 + y^2 = square, by x and y.
std::vector<cl_double2> integer_circle(std::int64_t square) {
  std::vector<cl_double2> points;
  const auto reach = static_cast<std::int64_t>(std::sqrt(static_cast<double>(square))) + 1;
  for (std::int64_t x = -reach; x <= reach; ++x) {
    const std::int64_t rest = square - x * x;
    if (rest < 0) continue;
    auto y = static_cast<std::int64_t>(std::sqrt(static_cast<double>(rest)));
    while (y * y > rest) --y;
    while ((y + 1) * (y + 1) <= rest) ++y;
    if (y * y != rest) continue;
    if (y > 0) points.push_back({{static_cast<double>(x), -static_cast<double>(y)}});
    points.push_back({{static_cast<double>(x), static_cast<double>(y)}});
  }
  return points;
}

void add_polygon(const std::vector<int>& polygon, std::vector<Corner>& corners) {
  const std::size_t k = polygon.size();
  for (std::size_t i = 0; i < k; ++i)
    corners.push_back({polygon[(i + k - 1) % k], polygon[i], polygon[(i + 1) % k]});
}

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

/// Border edges of regions that strips misses, since of cocircular points it chose other edges: it
/// triangulates the vertices alone, so it makes the same edges where the border is their convex hull.
std::size_t missing_edges(Call& call, const PointTable& table, const std::vector<int>& around,
                          const std::vector<Region>& regions) {
  Arena::Scope scope(call.work.scratch());
  std::vector<Region> hulls;
  std::vector<std::size_t> of_hull;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const std::vector<int> vertices = regions[r].points();
    if (vertices.size() <= static_cast<std::size_t>(call.runtime.tuning().small_region)) continue;
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
  const std::size_t made = endgame(call.work, table, retired, triangles, 0);
  const auto rows = call.read(triangles, 3 * made);
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

TEST(SmallEndgame, CocircularRegions) {
  Met met;
  check_circle_regions(5 * 13, 3, 2, false, met);
  EXPECT_GT(met.undecided_endgame + met.large, 0u);
}

TEST(Endgame, CocircularRegionsWhoseBordersAreDiagonals) {
  Met met;
  check_circle_regions(std::int64_t{25} * 13 * 17, 100, 2, false, met);       // 48 points
  check_circle_regions(std::int64_t{25} * 13 * 17 * 29, 100, 3, true, met);   // 96
  check_circle_regions(std::int64_t{625} * 169 * 17 * 29, 20, 4, true, met);  // 240
  EXPECT_GT(met.undecided_endgame + met.large, 300u);
  EXPECT_GT(met.large, 200u);
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

// -----------------------------------------------------------------------------------------------------------
// Twins

void check_match(Runtime& runtime, const std::vector<cl_int>& triangles) {
  Call call(runtime);
  const auto uploaded = testing::upload(runtime, triangles);
  const auto twins = testing::guarded<cl_int>(runtime, triangles.size());
  match_edges(call.work, uploaded, triangles.size() / 3, twins);
  EXPECT_TRUE(same(testing::download(runtime, twins, triangles.size()), testing::twins_twin(triangles)));
}

/// Triangles with rows turned and shuffled, every tenth missing, and vertices numbered anew.
std::vector<cl_int> scrambled(TriangleSet triangles, std::int64_t largest_id, FixtureRandom& random) {
  random.shuffle(triangles);
  triangles.resize(triangles.size() - triangles.size() / 10);
  std::map<int, int> ids;
  std::set<int> used;
  std::vector<cl_int> rows;
  for (auto& row : triangles) {
    std::rotate(row.begin(), row.begin() + random.integer(0, 2), row.end());
    for (const int id : row) {
      if (ids.count(id) == 0) {
        int fresh = 0;
        do {
          fresh = static_cast<int>(random.integer(0, largest_id));
        } while (!used.insert(fresh).second);
        ids[id] = fresh;
      }
      rows.push_back(ids[id]);
    }
  }
  return rows;
}

TEST(SmallMatchEdges, FewTriangles) {
  under_each_tuning([](Runtime& runtime) {
    check_match(runtime, {});
    check_match(runtime, {4, 2, 7});
    check_match(runtime, {0, 1, 2, 2, 1, 3, 0, 2, 3});
    // A closed surface: every edge has a twin.
    check_match(runtime, {0, 1, 2, 0, 2, 3, 0, 3, 1, 3, 2, 1});
  });
}

TEST(MatchEdges, RandomMeshesAndAHub) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(15);
    for (const char* const name : {"uniform", "grid", "integer-star", "small-integers"}) {
      SCOPED_TRACE(name);
      const TriangleSet mesh = testing::reference_delaunay(make_fixture(name, 250, 16));
      check_match(runtime, scrambled(mesh, 250, random));
      check_match(runtime, scrambled(mesh, 1 << 28, random));
    }
    constexpr int kSpokes = 10000;
    for (const int hub : {0, kSpokes, 1 << 28}) {
      TriangleSet star;
      for (int i = 0; i < kSpokes; ++i) {
        star.push_back({hub, hub == 0 ? 1 + i : i, hub == 0 ? 1 + (i + 1) % kSpokes : (i + 1) % kSpokes});
      }
      check_match(runtime, testing::flat_triangles(star));
      check_match(runtime, scrambled(star, 20000, random));
    }
  });
}

// -----------------------------------------------------------------------------------------------------------
// The canonical form

/// Some triangulation of a convex polygon, counter-clockwise.
void add_random_triangles(const std::vector<int>& polygon, FixtureRandom& random,
                          std::vector<cl_int>& triangles) {
  // Ears in random order.
  std::vector<int> rest = polygon;
  while (rest.size() >= 3) {
    const auto k = static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(rest.size()) - 1));
    const std::size_t size = rest.size();
    triangles.insert(triangles.end(), {rest[(k + size - 1) % size], rest[k], rest[(k + 1) % size]});
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(k));
  }
}

/// Canonicalizes and returns the rows, with the twins held against those of the new triangles.
std::vector<cl_int> canonical(Call& call, const std::vector<cl_double2>& places,
                              const std::vector<cl_int>& triangles) {
  PointTable table;
  table.count = places.size();
  table.points = testing::upload(call.runtime, places);
  const auto rows = testing::upload(call.runtime, triangles);
  const auto twins = testing::guarded<cl_int>(call.runtime, triangles.size());
  match_edges(call.work, rows, triangles.size() / 3, twins);
  canonicalize(call.work, table, rows, triangles.size() / 3, twins);
  auto made = testing::download(call.runtime, rows, triangles.size());
  EXPECT_TRUE(same(testing::download(call.runtime, twins, triangles.size()), testing::twins_twin(made)));
  return made;
}

/// Cells of cocircular points, given in counter-clockwise order of ids, become fans from their smallest ids.
void check_cells(Runtime& runtime, const std::vector<cl_double2>& places,
                 const std::vector<std::vector<int>>& cells, const Bounds& bounds, FixtureRandom& random) {
  std::vector<cl_int> triangles;
  TriangleSet expected;
  for (std::vector<int> cell : cells) {
    add_random_triangles(cell, random, triangles);
    std::rotate(cell.begin(), std::min_element(cell.begin(), cell.end()), cell.end());
    for (std::size_t i = 1; i + 1 < cell.size(); ++i) expected.push_back({cell[0], cell[i], cell[i + 1]});
  }
  std::sort(expected.begin(), expected.end());
  Call call(runtime);
  call.work.bounds = bounds;
  const auto found = canonical(call, places, triangles);
  EXPECT_TRUE(testing::sorted_triangles(found) == expected);
  EXPECT_NE(testing::sorted_triangles(triangles), expected);  // so there was something to do
  EXPECT_EQ(call.broken(), 0);
}

/// Cells of k points each of one circle, as sets of points of their own.
void make_cells(std::int64_t square, const std::vector<std::size_t>& sizes, FixtureRandom& random,
                std::vector<cl_double2>& places, std::vector<std::vector<int>>& cells) {
  const auto circle = integer_circle(square);
  for (const std::size_t size : sizes) {
    std::vector<int> chosen(circle.size());
    std::iota(chosen.begin(), chosen.end(), 0);
    random.shuffle(chosen);
    chosen.resize(size);
    std::sort(chosen.begin(), chosen.end());
    std::vector<cl_double2> own;
    for (const int id : chosen) own.push_back(circle[static_cast<std::size_t>(id)]);
    std::vector<int> ids(size);
    std::iota(ids.begin(), ids.end(), 0);
    bool collinear = false;
    std::vector<int> cell = testing::border_twin(ExactPoints(own), ids, collinear);
    for (int& id : cell) id += static_cast<int>(places.size());
    places.insert(places.end(), own.begin(), own.end());
    cells.push_back(cell);
  }
}

TEST(SmallCanonical, Cells) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(17);
    std::vector<cl_double2> places;
    std::vector<std::vector<int>> cells;
    make_cells(25 * 13, {4, 7, 9, 12}, random, places, cells);
    check_cells(runtime, places, cells, {0, 0, 0}, random);
    check_cells(runtime, places, cells, kUndecided, random);
  });
}

TEST(Canonical, CellsOfFourToThirtyPointsAndOneOfAThousand) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(18);
    for (const Bounds& bounds : {Bounds{1.2e-15, 1.2e-15, 1.2e-15}, kUndecided}) {
      std::vector<cl_double2> places;
      std::vector<std::vector<int>> cells;
      std::vector<std::size_t> sizes(27);
      std::iota(sizes.begin(), sizes.end(), 4);
      make_cells(std::int64_t{25} * 13 * 17 * 29, sizes, random, places, cells);
      check_cells(runtime, places, cells, bounds, random);
      places.clear();
      cells.clear();
      const std::int64_t square =
          std::int64_t{125} * 169 * 289 * 29 * 37;  // 4 * 4 * 3 * 3 * 2 * 2 = 576 points
      make_cells(square * 41, {1152}, random, places, cells);
      check_cells(runtime, places, cells, bounds, random);
    }
  });
}

/// Canonical triangulations with edges of cocircular points flipped at random, which must come back.
TEST(Canonical, UndoesFlips) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(19);
    for (const char* const name : {"grid", "small-integers", "integer-circle", "ladder", "uniform"}) {
      SCOPED_TRACE(name);
      // In the order of ids, without duplicates: ids are indices.
      const Coordinates raw = make_fixture(name, 150, 20);
      std::set<std::pair<double, double>> distinct;
      for (std::size_t i = 0; i < raw.size(); i += 2) distinct.insert({raw[i], raw[i + 1]});
      Coordinates coordinates;
      std::vector<cl_double2> places;
      for (const auto& [x, y] : distinct) {
        coordinates.insert(coordinates.end(), {x, y});
        places.push_back({{x, y}});
      }
      const ExactPoints points(places);
      const TriangleSet expected = testing::reference_delaunay(coordinates);
      std::vector<cl_int> triangles = testing::flat_triangles(expected);
      std::size_t flips = 0;
      for (int attempt = 0; attempt < 400; ++attempt) {
        const auto twins = testing::twins_twin(triangles);
        const auto h =
            static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(triangles.size()) - 1));
        if (twins[h] < 0) continue;
        const auto g = static_cast<std::size_t>(twins[h]);
        const int a = triangles[h], b = triangles[h / 3 * 3 + (h + 1) % 3],
                  c = triangles[h / 3 * 3 + (h + 2) % 3];
        const int d = triangles[g];
        if (points.in_circle(a, b, c, d) != 0) continue;
        const int one[] = {a, b, d}, other[] = {a, d, c};
        std::copy(one, one + 3, triangles.begin() + static_cast<std::ptrdiff_t>(h / 3 * 3));
        std::copy(other, other + 3, triangles.begin() + static_cast<std::ptrdiff_t>(g / 3 * 3));
        ++flips;
      }
      EXPECT_EQ(flips > 0, std::string(name) != "uniform");
      for (const Bounds& bounds : {Bounds{1.2e-15, 1.2e-15, 1.2e-15}, kUndecided}) {
        Call call(runtime);
        call.work.bounds = bounds;
        EXPECT_TRUE(testing::sorted_triangles(canonical(call, places, triangles)) == expected);
        EXPECT_EQ(call.broken(), 0);
      }
    }
  });
}

/// An edge that is not Delaunay is found out.
TEST(SmallCanonical, ReportsAnEdgeThatIsNotDelaunay) {
  under_each_tuning([](Runtime& runtime) {
    const std::vector<cl_double2> places{{{0, 0}}, {{1, -1}}, {{1, 1}}, {{8, 0}}};
    for (const Bounds& bounds : {Bounds{0, 0, 0}, kUndecided}) {
      Call call(runtime);
      call.work.bounds = bounds;
      canonical(call, places, {0, 1, 2, 2, 1, 3});
      EXPECT_EQ(call.broken(), 0);
      canonical(call, places, {0, 1, 3, 0, 3, 2});
      EXPECT_EQ(call.broken(), 4);
      EXPECT_THROW(check_invariants(call.work), Error);
    }
  });
}

// -----------------------------------------------------------------------------------------------------------
// Output

void check_output(Runtime& runtime, const TriangleSet& mesh, FixtureRandom& random) {
  Call call(runtime);
  constexpr int kIds = 300;
  const std::vector<cl_int> triangles = scrambled(mesh, kIds - 1, random);
  const std::size_t count = triangles.size() / 3;
  const std::vector<cl_int> twins = testing::twins_twin(triangles);
  std::vector<cl_int> source(kIds);
  std::iota(source.begin(), source.end(), 1000);
  random.shuffle(source);
  std::vector<cl_int> expected_rows, expected_neighbors;
  for (std::size_t t = 0; t < count; ++t) {
    std::array<std::pair<cl_int, cl_int>, 3> row;  // vertex, triangle opposite to it
    for (std::size_t j = 0; j < 3; ++j) {
      const cl_int twin = twins[3 * t + j];
      row[j] = {source[static_cast<std::size_t>(triangles[3 * t + j])], twin < 0 ? -1 : twin / 3};
    }
    std::rotate(row.begin(), std::min_element(row.begin(), row.end()), row.end());
    for (const auto& [vertex, neighbor] : row) {
      expected_rows.push_back(vertex);
      expected_neighbors.push_back(neighbor);
    }
  }
  const auto device_triangles = testing::upload(runtime, triangles);
  const auto device_twins = testing::upload(runtime, twins);
  const auto device_source = testing::upload(runtime, source);
  for (const int with_neighbors : {1, 0}) {
    const auto rows = testing::guarded<cl_int>(runtime, 3 * count);
    const auto neighbors = testing::guarded<cl_int>(runtime, with_neighbors ? 3 * count : 0);
    runtime.map("output", "finish_rows", count, cl_int{with_neighbors}, device_triangles, device_twins,
                device_source, rows, neighbors);
    EXPECT_TRUE(same(testing::download(runtime, rows, 3 * count), expected_rows));
    const auto found = testing::download(runtime, neighbors, with_neighbors ? 3 * count : 0);
    if (with_neighbors) {
      EXPECT_TRUE(same(found, expected_neighbors));
    }
  }
  // What callers rely on, by another way.
  EXPECT_TRUE(same(expected_neighbors, testing::reference_neighbors(expected_rows)));

  const auto indices = testing::guarded<cl_int>(runtime, triangles.size());
  runtime.map("output", "map_ids", triangles.size(), device_triangles, device_source, indices);
  std::vector<cl_int> expected_indices;
  for (const cl_int id : triangles) expected_indices.push_back(source[static_cast<std::size_t>(id)]);
  EXPECT_TRUE(same(testing::download(runtime, indices, triangles.size()), expected_indices));

  // Several sets: stably by the set of a triangle's vertices.
  constexpr std::size_t kSets = 7;
  std::vector<cl_int> set_of_id(kIds);
  for (cl_int& set : set_of_id) set = static_cast<cl_int>(random.integer(0, kSets - 1));
  const auto set_of = [&](std::size_t t) { return set_of_id[static_cast<std::size_t>(triangles[3 * t])]; };
  std::vector<cl_uint> expected_counts(kSets, 0);
  std::vector<cl_ulong> expected_keys;
  std::vector<cl_int> identity(count);
  std::iota(identity.begin(), identity.end(), 0);
  for (std::size_t t = 0; t < count; ++t) {
    ++expected_counts[static_cast<std::size_t>(set_of(t))];
    expected_keys.push_back(static_cast<cl_ulong>(set_of(t)));
  }
  std::vector<cl_int> by_set = identity;
  std::stable_sort(by_set.begin(), by_set.end(), [&](int t, int u) {
    return set_of(static_cast<std::size_t>(t)) < set_of(static_cast<std::size_t>(u));
  });
  const auto keys = testing::guarded<cl_ulong>(runtime, count);
  const auto order = testing::guarded<cl_int>(runtime, count);
  const auto counts = testing::upload(runtime, std::vector<cl_uint>(kSets, 0));
  runtime.map("output", "triangle_sets", count, device_triangles, testing::upload(runtime, set_of_id), keys,
              order, counts);
  EXPECT_TRUE(same(testing::download(runtime, keys, count), expected_keys));
  EXPECT_TRUE(same(testing::download(runtime, order, count), identity));
  EXPECT_TRUE(same(testing::download(runtime, counts, kSets), expected_counts));
  host::sort_by_key(runtime, keys, order, count);
  const auto reordered = testing::guarded<cl_int>(runtime, 3 * count);
  runtime.map("output", "reorder_triangles", count, order, device_triangles, reordered);
  std::vector<cl_int> expected_reordered;
  for (const int t : by_set) {
    expected_reordered.insert(expected_reordered.end(), triangles.begin() + 3 * t,
                              triangles.begin() + 3 * t + 3);
  }
  EXPECT_TRUE(same(testing::download(runtime, reordered, 3 * count), expected_reordered));
}

TEST(SmallOutput, Rows) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(21);
    check_output(runtime, testing::reference_delaunay(make_fixture("uniform", 20, 22)), random);
  });
}

TEST(Output, Rows) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(23);
    for (const char* const name : {"uniform", "grid", "integer-star"}) {
      check_output(runtime, testing::reference_delaunay(make_fixture(name, 250, 24)), random);
    }
  });
}

// -----------------------------------------------------------------------------------------------------------
// The self test

TEST(SmallSelfTest, PassesHereAndFailsOnOtherBits) {
  Runtime& runtime = Runtimes::get(false);
  EXPECT_EQ(self_test_failure(runtime), "");
  Call call(runtime);
  const std::vector<cl_double> operands{1 + 0x1p-30, 1 - 0x1p-30,          -1.0,
                                        0x1p-1060,   0x1.5555555555555p-2, 0x1.0000000000001p+60};
  const auto bits = [](double value) {
    cl_ulong result = 0;
    std::memcpy(&result, &value, sizeof result);
    return result;
  };
  // The results, worked out with rational numbers; mpq_class rounds towards zero, so only exact ones are
  // converted.
  const auto rounded = [](const mpq_class& value) {
    const double truncated = value.get_d();
    const double away = std::nextafter(truncated, value > 0 ? HUGE_VAL : -HUGE_VAL);
    const mpq_class below = abs(value - mpq_class(truncated)), above = abs(mpq_class(away) - value);
    if (below == above) throw std::logic_error("a tie");
    return below < above ? truncated : away;
  };
  const mpq_class third(operands[4]), large(operands[5]);
  const double sum = rounded(third + large), product = rounded(third * third);
  const std::vector<cl_ulong> right{
      bits(0.0),                                                           // 1 rounded, less 1
      bits(rounded(mpq_class(operands[0]) * mpq_class(operands[1]) - 1)),  // fma
      bits(0x1p-1061),                                                     // a subnormal number, halved
      bits(sum),
      bits(product),
      bits(rounded(third + large - mpq_class(sum))),      // two_sum
      bits(rounded(third * third - mpq_class(product))),  // two_product
      bits(0.0)};                                         // (large + third) - large
  const auto failed_bits = [&](const std::vector<cl_double>& with, const std::vector<cl_ulong>& expected) {
    const auto failed = testing::upload(runtime, std::vector<cl_uint>{0xffffffff});
    runtime.launch("selftest", "self_test", 1, 1, testing::upload(runtime, with),
                   testing::upload(runtime, expected), failed);
    return testing::download(runtime, failed, 1)[0];
  };
  EXPECT_EQ(failed_bits(operands, right), 0u);
  // Which checks rest on which expected value.
  const cl_uint checks[] = {1, 2, 4, 8 | 32, 16 | 64 | 128, 32, 64, 256};
  for (std::size_t k = 0; k < right.size(); ++k) {
    std::vector<cl_ulong> wrong = right;
    wrong[k] ^= 1;
    EXPECT_EQ(failed_bits(operands, wrong), checks[k]) << "expected value " << k;
  }
  // As a device would fail that flushes subnormal numbers to 0.
  std::vector<cl_double> flushed = operands;
  flushed[3] = 0.0;
  EXPECT_EQ(failed_bits(flushed, right), 4u);
}

// -----------------------------------------------------------------------------------------------------------
// The twins themselves, and what they were held against

TEST(SmallTwins, PredicatesAreTheReferences) {
  FixtureRandom random(25);
  std::array<int, 3> turns{}, circles{};
  for (const double factor : {1.0, 0x1.3p-20, 1e-3, 1 + 0x1p-40}) {
    for (int round = 0; round < 300; ++round) {
      std::vector<cl_double2> places;
      for (int i = 0; i < 4; ++i) {
        places.push_back({{factor * static_cast<double>(random.integer(-3, 3)),
                           factor * static_cast<double>(random.integer(-3, 3))}});
      }
      const ExactPoints points(places);
      const double* p[4];
      for (std::size_t i = 0; i < 4; ++i) p[i] = places[i].s;
      const int turn = testing::reference_orient2d(p[0], p[1], p[2]);
      const int circle = testing::reference_incircle(p[0], p[1], p[2], p[3]);
      EXPECT_EQ(points.orient(0, 1, 2), turn);
      EXPECT_EQ(points.in_circle(0, 1, 2, 3), circle);
      ++turns[static_cast<std::size_t>(turn + 1)];
      ++circles[static_cast<std::size_t>(circle + 1)];
      // Below the chord of a and b, in the projection: nearer to a point of the line than to a and b, which
      // is inside a circle centred on it. With c the mirror image of a that circle is one through a, b, c.
      const Frame frame{0, places[2].s[0]};
      const cl_double2 a = places[0], b = places[1];
      const cl_double2 mirror{{2 * frame.q - a.s[0], a.s[1]}};
      if (!(a.s[1] < b.s[1]) || a.s[0] == frame.q || mirror.s[0] + a.s[0] != 2 * frame.q) continue;
      const std::vector<cl_double2> with{a, b, places[3], {{frame.q, 0.0}}};
      const int turned = testing::reference_orient2d(a.s, b.s, mirror.s);
      const int inside = testing::reference_incircle(a.s, b.s, mirror.s, places[3].s) * turned;
      if (turned != 0 && places[3].s[1] > a.s[1] && places[3].s[1] < b.s[1]) {
        EXPECT_EQ(ExactPoints(with).depth_sign(frame, 0, 1, 2), inside);
      }
    }
  }
  for (const int some : turns) EXPECT_GT(some, 50);
  for (const int some : circles) EXPECT_GT(some, 50);
}

void check_widening(Runtime& runtime, std::size_t first, std::size_t n) {
  FixtureRandom random(first + n);
  std::vector<float> narrow(2 * (first + n));
  for (float& x : narrow)
    x = static_cast<float>(std::ldexp(random.unit() - 0.5, static_cast<int>(random.integer(-140, 100))));
  host::Arena::Scope scope(runtime.arena());
  const auto wide = testing::guarded<double>(runtime, 2 * n);
  runtime.map("ingest", "widen_points", n, cl_ulong{first}, testing::upload(runtime, narrow), wide);
  EXPECT_EQ(testing::download(runtime, wide, 2 * n),
            std::vector<double>(narrow.begin() + static_cast<std::ptrdiff_t>(2 * first), narrow.end()));
}

TEST(SmallIngest, FloatsAreTheSameNumbersAsDoubles) {
  for (const bool small : kSmall) {
    for (const std::size_t first : {0, 3}) {
      for (const std::size_t n : {0, 1, 70}) check_widening(Runtimes::get(small), first, n);
    }
  }
}

/// Whatever a stage launches on ordinary and degenerate input is all there is: no kernel is left over, none
/// untested.
TEST(Kernels, AllAreLaunched) {
  std::set<std::string> launched;
  for (const bool small : kSmall) {
    Runtime& runtime = Runtimes::get(small);
    runtime.set_profiling(true);
    Met met;
    FixtureRandom random(26);
    check_levels(runtime, coarse_points(40, 3, random), {0, 0, 9, 12, 40}, {}, met);
    check_levels(runtime, make_fixture("uniform", 5000, 31), {false, false, true, 1}, met);
    std::vector<cl_double2> places;
    std::vector<std::vector<int>> cells;
    make_cells(25 * 13, {5}, random, places, cells);
    check_cells(runtime, places, cells, {0, 0, 0}, random);
    check_output(runtime, testing::reference_delaunay(make_fixture("uniform", 10, 27)), random);
    check_restart(runtime);
    check_widening(runtime, 1, 40);
    EXPECT_EQ(self_test_failure(runtime), "");
    for (const auto& [name, time] : runtime.kernel_times()) launched.insert(name);
    runtime.set_profiling(false);
  }
  std::size_t kernels = 0;
  for (const char* const file : {"ingest", "border", "cut", "prune", "quickhull", "merge", "lists", "endgame",
                                 "endgame_exact", "strips", "neighbors", "canonical", "output", "selftest"}) {
    const std::string source = host::kernel_source(file);
    const std::regex pattern("\nkernel void (\\w+)\\(|\nSEGMENTED_ARG_REDUCE\\((\\w+),");
    for (std::sregex_iterator it(source.begin(), source.end(), pattern), end; it != end; ++it) {
      const std::string name = (*it)[1].matched ? (*it)[1] : (*it)[2];
      EXPECT_EQ(launched.count(name), 1u) << name << " of " << file << ".cl";
      ++kernels;
    }
  }
  EXPECT_GT(kernels, 70u);
}

}  // namespace
}  // namespace flaunay::flattened
