// What the tests of the flattened stages share: runtimes, the state of a call, regions and paths to and from
// the device.
#pragma once

#include <CL/cl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "modes/flattened/stages.hpp"
#include "tests/support/device.hpp"
#include "tests/support/exact_points.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/regions.hpp"
#include "tests/support/runtimes.hpp"
#include "tests/support/same.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::flattened {

using namespace geometry;
using namespace statistics;

using host::Runtime;
using testing::Coordinates;
using testing::Corner;
using testing::ExactPoints;
using testing::FixtureRandom;
using testing::Frame;
using testing::make_fixture;
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
      runtime = testing::make_tuned_runtime(small ? "small" : "own");
      if (small || (before != nullptr && std::string(before) == "small")) {
        // Small regions so small that many others count as large.
        Tuning tuning = tuning_of(*runtime);
        tuning.small_region = 4;
        runtime->set_sizes(std::make_shared<Tuning>(tuning));
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
[[maybe_unused]] inline ::testing::Environment* const kRuntimes =
    ::testing::AddGlobalTestEnvironment(new Runtimes);

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
        persistent_(used.memory()),
        state_(used.memory()),
        scope_(used.arena()),
        work{used, persistent_, levels_} {
    work.children = &state_;
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
  std::vector<LevelStatistics> levels_;

 public:
  Workspace work;
};

/// Corner triples and offsets as corners by region.
inline std::vector<std::vector<Corner>> corners_by_region(const std::vector<cl_int>& ids,
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
inline std::vector<cl_int> offsets_of(const std::vector<cl_int>& regions, std::size_t count) {
  std::vector<cl_int> offsets;
  for (std::size_t r = 0; r <= count; ++r) {
    offsets.push_back(static_cast<cl_int>(
        std::lower_bound(regions.begin(), regions.end(), static_cast<cl_int>(r)) - regions.begin()));
  }
  return offsets;
}

/// The device's regions in the twin's form; also holds their redundant arrays against each other.
inline Regions download(Call& call, const Level& level, const RetiredRegions& retired) {
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

inline ::testing::AssertionResult same_regions(const Regions& found, const Regions& expected) {
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

/// What the borders that were merged had to offer.
struct MergeCounts {
  std::array<std::size_t, 4> corners_by_parts{};  ///< corners on the path by how many new ones they gave
  std::size_t path_leaves_region = 0;             ///< corners with a path edge outside the wedge
  std::size_t pinch_points = 0;                   ///< vertices with several corners in one region
  std::size_t path_on_border = 0;                 ///< corners with a path edge that is a border edge
};

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
inline cl_double2 projected(const Frame& frame, const cl_double2& p) {
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

inline Paths upload_paths(Call& call, const HostPaths& paths) {
  Paths uploaded;
  uploaded.size = paths.vertices.size();
  uploaded.vertices = testing::upload(call.runtime, paths.vertices);
  uploaded.projections = testing::upload(call.runtime, paths.projections);
  uploaded.regions = testing::upload(call.runtime, paths.regions);
  uploaded.offsets = testing::upload(call.runtime, paths.offsets);
  return uploaded;
}

inline void expect_paths(Call& call, const Paths& paths, const HostPaths& expected) {
  ASSERT_TRUE(same(call.read(paths.offsets, expected.offsets.size()), expected.offsets));
  const std::size_t size = expected.vertices.size();
  ASSERT_LE(size, paths.size);
  EXPECT_TRUE(same(call.read(paths.vertices, size), expected.vertices));
  EXPECT_TRUE(same(call.read(paths.projections, size), expected.projections));
  EXPECT_TRUE(same(call.read(paths.regions, size), expected.regions));
}

/// Few values of coordinates, so that points coincide and line up.
inline Coordinates coarse_points(std::size_t n, int values, FixtureRandom& random) {
  Coordinates points;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const auto value = static_cast<double>(random.integer(-values, values));
    points.push_back(value == 0 && random.integer(0, 1) == 0 ? -0.0 : value);
  }
  return points;
}

/// Sizes of sets, some of them 0, as offsets.
inline std::vector<std::size_t> random_offsets(std::size_t sets, std::int64_t largest,
                                               FixtureRandom& random) {
  std::vector<std::size_t> offsets{0};
  for (std::size_t s = 0; s < sets; ++s) {
    const std::int64_t size = random.integer(0, 2) == 0 ? 0 : random.integer(0, largest);
    offsets.push_back(offsets.back() + static_cast<std::size_t>(size));
  }
  return offsets;
}

/// Exactly the structure of a fixture of few bits, but with so many bits that filters leave it undecided.
inline Coordinates long_numbers(const std::string& fixture, std::size_t n, std::uint64_t seed) {
  return testing::scaled(make_fixture(fixture, n, seed), 1 + 0x1.6b8a3p-12 + 0x1p-31);
}

/// All points of integer coordinates with x^2 + y^2 = square, by x and y.
inline std::vector<cl_double2> integer_circle(std::int64_t square) {
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

inline void add_polygon(const std::vector<int>& polygon, std::vector<Corner>& corners) {
  const std::size_t k = polygon.size();
  for (std::size_t i = 0; i < k; ++i)
    corners.push_back({polygon[(i + k - 1) % k], polygon[i], polygon[(i + 1) % k]});
}

/// Triangles with rows turned and shuffled, every tenth missing, and vertices numbered anew.
inline std::vector<cl_int> scrambled(TriangleSet triangles, std::int64_t largest_id, FixtureRandom& random) {
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

struct LoopOptions {
  bool undecided = false;  ///< let no filter decide
  bool alternate = false;  ///< cut x and y in turn
  bool parts = true;       ///< also prune, quickhull and clean-up on their own
  std::size_t levels = 1000;
};

// -----------------------------------------------------------------------------------------------------------
// What each stage is held against, for the tests that run several: each is defined with its stage's tests.

/// The level loop; see levels_test.cpp.
void check_levels(Runtime& runtime, const Coordinates& coordinates, const std::vector<std::size_t>& offsets,
                  const LoopOptions& options, Met& met);
void check_levels(Runtime& runtime, const Coordinates& coordinates, const LoopOptions& options, Met& met);
/// The level loop on fixtures of n points, under each tuning.
void check_fixtures(const std::vector<std::string>& names, std::size_t n, const LoopOptions& options,
                    Met& met);

/// What a level's regions and their cuts are, as their twins have them.
struct CutLevel {
  std::vector<Frame> frames;
  std::vector<std::vector<int>> paths;
};
/// Cuts a level; see cut_test.cpp.
CutLevel check_cut(Call& call, const ExactPoints& points, const PointTable& table, Level& level,
                   const std::vector<Region>& regions, int alternate, Met& met);
/// Prune against paths made by hand, and its candidates; see prune_test.cpp.
void check_prune(Call& call, const ExactPoints& points, const PointTable& table, Level level,
                 const std::vector<Region>& regions, const std::vector<Frame>& frames,
                 const std::vector<std::vector<int>>& paths, bool keep_on);
void check_candidates(Call& call, const ExactPoints& points, const Level& level,
                      const std::vector<Region>& regions, const std::vector<Frame>& frames);
/// Quickhull without prune, and the hulls of the whole stage; see quickhull_test.cpp.
void check_quickhull(Call& call, const ExactPoints& points, const PointTable& table, const Level& level,
                     const std::vector<Region>& regions, const std::vector<Frame>& frames,
                     const std::vector<std::vector<int>>& expected, FixtureRandom& random);
void check_hulls(Call& call, const ExactPoints& points, const Level& level,
                 const std::vector<Region>& regions, const std::vector<Frame>& frames, const Paths& paths,
                 const std::vector<std::vector<int>>& expected, Met& met);
void check_restart(Runtime& runtime);
/// A region with so many kept corners that runs of them are merged; see chains_test.cpp.
void check_many_kept_corners(Runtime& runtime, Met& met);
/// Merges and returns the next level's regions; see merge_test.cpp.
Regions check_merge(Call& call, const ExactPoints& points, PointTable& table, const Level& level,
                    const std::vector<Region>& regions, const CutLevel& cut, const Paths& paths, Level& next,
                    RetiredRegions& retired, Met& met);
/// The triangles of retired regions, and of regions of cocircular vertices; see endgame_test.cpp.
void check_endgame(Call& call, const ExactPoints& points, const PointTable& table,
                   const RetiredRegions& retired, const std::vector<Region>& regions, Met& met);
RetiredRegions upload_retired(Call& call, const std::vector<Region>& regions);
void check_circle_regions(std::int64_t square, int regions_count, int depth, bool expect_missing, Met& met);
/// Border edges that strips misses; see strips_test.cpp.
std::size_t missing_edges(Call& call, const PointTable& table, const std::vector<int>& around,
                          const std::vector<Region>& regions);
/// Cells of cocircular points; see canonical_test.cpp.
void check_cells(Runtime& runtime, const std::vector<cl_double2>& places,
                 const std::vector<std::vector<int>>& cells, const Bounds& bounds, FixtureRandom& random);
void make_cells(std::int64_t square, const std::vector<std::size_t>& sizes, FixtureRandom& random,
                std::vector<cl_double2>& places, std::vector<std::vector<int>>& cells);
/// Rows of the result; see output_test.cpp.
/// What a test of regions that end in blocks met.
struct MetRegions {
  std::size_t regions = 0, retired = 0, cocircular_borders = 0, several_corners = 0;
};
/// Cuts the points by some levels, and solves what is left as blocks. has_ties: whether triangles may differ
/// from the twin's.
void check_regions(Runtime& runtime, const Coordinates& coordinates, int levels, bool has_ties,
                   MetRegions& met);
void check_output(Runtime& runtime, const TriangleSet& mesh, FixtureRandom& random);

}  // namespace flaunay::flattened
