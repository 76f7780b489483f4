// The record of a call's launches (research::Options::record): beside the statistics, and the steps of merges
// beside their definition.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "flaunay/research.hpp"
#include "mesh/limits.h"
#include "mesh/rings.h"
#include "tests/support/environment.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {
namespace {

using research::LaunchStatistics;
using research::Mode;
using research::Options;
using research::Record;
using research::Triangulation;

Triangulation run(Triangulator& on, const Coordinates& points, Record record, Mode mode = Mode::blocks,
                  bool profile = false) {
  Options options;
  options.mode = mode;
  options.record = record;
  options.profile = profile;
  options.neighbors = true;
  return research::triangulate(on, points.data(), points.size() / 2, options);
}

// Where a work-item solves a block, as on a CPU.
Triangulator& block_by_block() { return triangulator_with("cpu"); }

// Points that every cut divides by x, in the order of x; integers, for which the reference is fast.
Coordinates flat_points(std::size_t n, std::uint64_t seed) {
  FixtureRandom random(seed);
  std::vector<double> xs;
  for (std::size_t i = 0; i < n; ++i) xs.push_back(std::floor(0x1p29 * random.unit()));
  std::sort(xs.begin(), xs.end());
  Coordinates points;
  for (const double x : xs) {
    points.push_back(x);
    points.push_back(std::floor(0x1p19 * random.unit()));
  }
  return points;
}

using Edge = std::pair<int, int>;

/// The lower hull of points [begin, end), which are sorted by x.
std::vector<int> lower_hull(const Coordinates& points, int begin, int end) {
  const auto at = [&](int v) { return &points[2 * static_cast<std::size_t>(v)]; };
  std::vector<int> hull;
  for (int v = begin; v < end; ++v) {
    while (hull.size() > 1 && reference_orient2d(at(hull[hull.size() - 2]), at(hull.back()), at(v)) <= 0)
      hull.pop_back();
    hull.push_back(v);
  }
  return hull;
}

/// The steps of merging points that are sorted by x, in halves down to four, as docs/counting.md defines
/// them: found without merging, from the triangulations of both halves and of the whole.
class StepsTwin {
 public:
  explicit StepsTwin(const Coordinates& points) : points_(points) {
    const auto count = static_cast<int>(points.size() / 2);
    int depth = 0;
    while (count > 4 << depth) ++depth;
    edges_of_part(count, depth, 0, 0);
  }
  std::uint32_t steps() const { return steps_; }

 private:
  /// The edges of part `part` of 2^level, whose merges are counted.
  std::set<Edge> edges_of_part(int count, int depth, int part, int level) {
    const auto begin_of = [&](int p, int l) { return static_cast<int>((static_cast<long>(p) * count) >> l); };
    const int begin = begin_of(part, level), end = begin_of(part + 1, level);
    std::set<Edge> edges;
    if (end - begin == 2) edges.insert({begin, begin + 1});
    const auto triangles = reference_delaunay(&points_[2 * static_cast<std::size_t>(begin)],
                                              static_cast<std::size_t>(end - begin));
    for (const auto& [a, b, c] : triangles) {
      for (const auto& [v, w] : {std::minmax(a, b), std::minmax(b, c), std::minmax(c, a)})
        edges.insert({begin + v, begin + w});
    }
    if (level == depth) return edges;
    const int middle = begin_of(2 * part + 1, level + 1);
    for (const int half : {2 * part, 2 * part + 1}) {
      for (const Edge& edge : edges_of_part(count, depth, half, level + 1)) steps_ += edges.count(edge) == 0;
    }
    for (const auto& [v, w] : edges) steps_ += v < middle && middle <= w;
    // The tangent's ends move along the halves' hulls, from the points beside the cut, to that of the whole.
    const std::vector<int> hull = lower_hull(points_, begin, end);
    const int right = *std::lower_bound(hull.begin(), hull.end(), middle);
    const int left = *std::prev(std::lower_bound(hull.begin(), hull.end(), middle));
    for (const int v : lower_hull(points_, begin, middle)) steps_ += v > left;
    for (const int v : lower_hull(points_, middle, end)) steps_ += v < right;
    ++steps_;
    return edges;
  }

  const Coordinates& points_;
  std::uint32_t steps_ = 0;
};

const LaunchStatistics& only(const std::vector<LaunchStatistics>& launches, const std::string& kernel) {
  const auto is_it = [&](const LaunchStatistics& launch) { return launch.kernel == kernel; };
  EXPECT_EQ(std::count_if(launches.begin(), launches.end(), is_it), 1) << kernel;
  const auto found = std::find_if(launches.begin(), launches.end(), is_it);
  static const LaunchStatistics kNone;
  return found == launches.end() ? kNone : *found;
}

TEST(Launches, AreThoseOfTheStatistics) {
  const Coordinates points = make_fixture("uniform", 20000, 1);
  for (const Mode mode : {Mode::blocks, Mode::flattened}) {
    SCOPED_TRACE(to_string(mode));
    const Triangulation plain = run(triangulator(), points, Record::nothing, mode);
    EXPECT_TRUE(plain.launches.empty());
    for (const Record record : {Record::launches, Record::steps}) {
      const Triangulation recorded = run(triangulator(), points, record, mode, true);
      EXPECT_EQ(recorded.launches.size(), recorded.statistics.kernel_launches);
      EXPECT_EQ(recorded.launches.size(), plain.statistics.kernel_launches);
      EXPECT_EQ(recorded.statistics.host_waits, plain.statistics.host_waits);
      EXPECT_EQ(recorded.statistics.bytes_to_host, plain.statistics.bytes_to_host);
      EXPECT_EQ(recorded.statistics.bytes_to_device, plain.statistics.bytes_to_device);
      EXPECT_EQ(recorded.triangles, plain.triangles);
      EXPECT_EQ(recorded.neighbors, plain.neighbors);
      double seconds = 0, seconds_of_kernels = 0;
      std::uint64_t steps = 0;
      for (const LaunchStatistics& launch : recorded.launches) {
        const bool is_kernel = launch.kernel != "fill" && launch.kernel != "copy";
        EXPECT_EQ(launch.work_items > 0, is_kernel);
        EXPECT_EQ(launch.elements > 0, is_kernel);
        EXPECT_EQ(launch.bytes > 0, !is_kernel);
        EXPECT_LE(launch.longest_chain, launch.steps);
        seconds += launch.seconds;
        steps += launch.steps;
      }
      for (const KernelStatistics& kernel : recorded.statistics.kernels) seconds_of_kernels += kernel.seconds;
      EXPECT_NEAR(seconds, seconds_of_kernels, 1e-9);
      EXPECT_EQ(steps > 0, record == Record::steps && (mode == Mode::blocks || mode == Mode::flattened));
    }
    EXPECT_TRUE(run(triangulator(), points, Record::nothing, mode).launches.empty());
  }
}

// One block, and a walk along its hull.
TEST(Launches, StepsAreTheTwins) {
  for (const std::size_t n : {5, 8, 40, 1000}) {
    SCOPED_TRACE(n);
    const Coordinates points = flat_points(n, n);
    const Triangulation mesh = run(block_by_block(), points, Record::steps);
    const LaunchStatistics& solve = only(mesh.launches, "solve_blocks");
    EXPECT_EQ(solve.longest_chain, StepsTwin(points).steps());
    EXPECT_EQ(solve.steps, solve.longest_chain);
    for (const char* walk : {"mark_outside", "write_hulls"}) {
      EXPECT_EQ(only(mesh.launches, walk).longest_chain, mesh.statistics.hull_vertices);
    }
  }
}

// Of sets in one call, the longest counts, and all are added.
TEST(Launches, StepsOfSeveralSets) {
  const std::size_t sizes[] = {20, 300, 50};
  Coordinates points;
  std::vector<std::size_t> offsets{0};
  std::uint32_t longest = 0;
  std::uint64_t sum = 0;
  for (const std::size_t size : sizes) {
    const Coordinates set = flat_points(size, size);
    const std::uint32_t steps = StepsTwin(set).steps();
    longest = std::max(longest, steps);
    sum += steps;
    points.insert(points.end(), set.begin(), set.end());
    offsets.push_back(offsets.back() + size);
  }
  Options options;
  options.record = Record::steps;
  const Triangulation mesh = research::triangulate(block_by_block(), points.data(), offsets, options);
  const LaunchStatistics& solve = only(mesh.launches, "solve_blocks");
  EXPECT_EQ(solve.longest_chain, longest);
  EXPECT_EQ(solve.steps, sum);
}

// A merge makes or removes an edge, or moves a tangent, in each step.
TEST(Launches, StepsOfMergesOfBlocks) {
  const Coordinates points = make_fixture("uniform", 20000, 1);
  const Triangulation mesh = run(block_by_block(), points, Record::steps);
  std::size_t merges = 0;
  for (const LaunchStatistics& launch : mesh.launches) {
    if (launch.kernel != "merge_blocks") continue;
    ++merges;
    EXPECT_GE(launch.longest_chain * launch.work_items, launch.steps);
    EXPECT_GT(launch.longest_chain, 0u);
    if (launch.work_items == 1) {
      EXPECT_EQ(launch.longest_chain, launch.steps);
    }
  }
  EXPECT_GT(merges, 0u);
}

TEST(Launches, ElementsAreThoseOfChunks) {
  constexpr std::size_t kPoints = 200000;
  const Triangulation mesh = run(block_by_block(), make_fixture("uniform", kPoints, 1), Record::launches);
  for (const char* kernel : {"inspect", "count_blocks", "move_points"}) {
    const LaunchStatistics& launch = only(mesh.launches, kernel);
    EXPECT_GE(launch.work_items * launch.elements, kPoints) << kernel;
    EXPECT_LT((launch.work_items - 1) * launch.elements, kPoints) << kernel;
  }
}

TEST(Launches, AreRecordedOrOperationsCounted) {
  Options options;
  options.mode = Mode::flattened;
  options.count = true;
  options.record = Record::launches;
  const Coordinates points = make_fixture("uniform", 100, 1);
  EXPECT_THROW(research::triangulate(triangulator(), points.data(), 100, options), Error);
}

}  // namespace
}  // namespace flaunay::testing
