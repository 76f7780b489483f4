// Holds what the kernels count to what their readable twin counts, by component, kind and level.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "flattened/limits.h"
#include "flaunay/flaunay.hpp"
#include "flaunay/research.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {
namespace {

using research::Component;
using research::Cut;
using research::Hull;
using research::kComponents;
using research::Mode;
using research::OperationCounts;
using research::Options;
using research::Triangulation;
using research::Work;

// A multiple of the buckets' size: of both planar hulls of the set, whose points lie one behind the other on
// the device, the buckets then begin where they do on the host.
constexpr std::size_t kPoints = 4096;

constexpr Hull kVariants[] = {Hull::prune, Hull::quickhull, Hull::balanced};
constexpr Cut kCuts[] = {Cut::interquartile, Cut::alternate};
const char* const kInputs[] = {"uniform", "kuzmin", "line", "grid"};
const char* const kComponentNames[] = {"cut", "hull", "merge", "split", "endgame"};

Triangulation run(const Coordinates& points, Mode mode, Hull hull, Cut cut) {
  Options options;
  options.mode = mode;
  options.hull = hull;
  options.cut = cut;
  options.count = true;
  return research::triangulate(triangulator(), points.data(), points.size() / 2, options);
}

std::string name_of(Mode mode, Hull hull, Cut cut) {
  return std::string(to_string(mode)) + ", " + to_string(hull) +
         (cut == Cut::alternate ? ", alternating" : "");
}

// What the device may differ by, in operations: each component of each level, and all together.
//
// Flattened, a level's buckets do not begin where regions begin, so that regions of few points give other
// candidates.
struct Tolerance {
  double component, total;
};
constexpr Tolerance kNone{0, 0};
constexpr Tolerance kOtherBuckets{0.1, 0.025};

// Regions of more corners than this are triangulated in other ways on the device (strips.cl) than by the twin
// (dwyer.cpp), so that their end games have little in common.
constexpr std::size_t kSmallRegion = kernel::DEFAULT_SMALL_REGION;

bool has_large_regions(const Work& work) {
  const auto& sizes = work.endgame_sizes;
  return std::any_of(sizes.begin() + std::min(sizes.size(), kSmallRegion + 1), sizes.end(),
                     [](std::uint64_t regions) { return regions > 0; });
}

// Both with the level before the first at the front.
std::vector<Work::Components> all_levels(const Work& work) {
  std::vector<Work::Components> levels = work.levels;
  levels.insert(levels.begin(), work.start);
  return levels;
}

void expect_equal(const OperationCounts& device, const OperationCounts& twin) {
  EXPECT_EQ(device.arithmetic, twin.arithmetic);
  EXPECT_EQ(device.depths, twin.depths);
  EXPECT_EQ(device.orientations, twin.orientations);
  EXPECT_EQ(device.circles, twin.circles);
}

void expect_near(std::uint64_t device, std::uint64_t twin, double tolerance) {
  EXPECT_NEAR(static_cast<double>(device), static_cast<double>(twin), tolerance * static_cast<double>(twin));
}

// Regions double in number from level to level, so that a scan of a level takes up to two steps more, for
// each level above, than one of its dearest region, which takes one at least. The two planar hulls before the
// first level make one of two regions.
void expect_path(std::uint64_t device, std::uint64_t twin, std::size_t levels_above) {
  EXPECT_GE(device, twin);
  EXPECT_LE(device, (1 + 2 * levels_above) * twin);
}

void expect_work(const Work& device, const Work& twin, Mode mode, const Tolerance& tolerance) {
  EXPECT_EQ(device.endgame_sizes, twin.endgame_sizes);
  ASSERT_EQ(device.levels.size(), twin.levels.size());
  const std::vector<Work::Components> ours = all_levels(device), theirs = all_levels(twin);
  const bool compare_endgames = !has_large_regions(twin);
  std::uint64_t our_total = 0, their_total = 0;
  for (std::size_t l = 0; l < theirs.size(); ++l) {
    for (std::size_t c = 0; c < kComponents; ++c) {
      if (c == static_cast<std::size_t>(Component::endgame) && !compare_endgames) continue;
      SCOPED_TRACE("level " + std::to_string(static_cast<int>(l) - 1) + " " + kComponentNames[c]);
      if (tolerance.component == 0) {
        expect_equal(ours[l][c], theirs[l][c]);
      } else {
        expect_near(ours[l][c].operations(), theirs[l][c].operations(), tolerance.component);
      }
      const std::size_t levels_above = l == 0 ? 1 : mode == Mode::flattened ? l - 1 : 0;
      if (tolerance.component == 0) {
        expect_path(ours[l][c].critical_path, theirs[l][c].critical_path, levels_above);
      }
      our_total += ours[l][c].operations();
      their_total += theirs[l][c].operations();
    }
  }
  expect_near(our_total, their_total, tolerance.total);
}

void expect_equal_triangles(const Triangulation& device, const Triangulation& twin) {
  EXPECT_EQ(sorted_triangles(device.triangles), sorted_triangles(twin.triangles));
  EXPECT_EQ(device.hull, twin.hull);
}

class WorkOf : public ::testing::TestWithParam<const char*> {
 protected:
  // Every hull and cut. tolerance_of(hull): of the counts.
  template <typename Function>
  void compare(Mode mode, const Function& tolerance_of) {
    const Coordinates points = make_fixture(GetParam(), kPoints, 1);
    for (const Cut cut : kCuts) {
      for (const Hull hull : kVariants) {
        SCOPED_TRACE(name_of(mode, hull, cut));
        const Triangulation twin = run(points, Mode::recursive, hull, cut);
        const Triangulation device = run(points, mode, hull, cut);
        expect_equal_triangles(device, twin);
        expect_work(device.work, twin.work, mode, tolerance_of(hull));
      }
    }
  }
};

// One region at a time, all is equal.
TEST_P(WorkOf, RegionsOneByOne) {
  compare(Mode::recursive_device, [](Hull) { return kNone; });
}

TEST_P(WorkOf, LevelsAtOnce) {
  compare(Mode::flattened, [](Hull hull) { return hull == Hull::prune ? kOtherBuckets : kNone; });
}

INSTANTIATE_TEST_SUITE_P(Inputs, WorkOf, ::testing::Values("uniform", "kuzmin", "line", "grid"));

// Several sets of sizes that are multiples of the bucket's, some of them without an inside.
TEST(Work, OfSeveralSets) {
  Coordinates points;
  std::vector<std::size_t> offsets{0};
  const auto add_set = [&](const Coordinates& set) {
    points.insert(points.end(), set.begin(), set.end());
    offsets.push_back(points.size() / 2);
  };
  for (const char* const input : {"uniform", "grid", "circle", "kuzmin"}) {
    add_set(make_fixture(input, 256, 2));
  }
  Coordinates collinear;
  for (int k = 0; k < 64; ++k) collinear.insert(collinear.end(), {1.0 * k, 2.0 * k});
  add_set(collinear);
  for (const Hull hull : kVariants) {
    SCOPED_TRACE(to_string(hull));
    Options options;
    options.count = true;
    options.hull = hull;
    options.mode = Mode::recursive;
    const Triangulation twin = research::triangulate(triangulator(), points.data(), offsets, options);
    options.mode = Mode::recursive_device;
    const Triangulation device = research::triangulate(triangulator(), points.data(), offsets, options);
    expect_equal_triangles(device, twin);
    ASSERT_EQ(device.work.levels.size(), twin.work.levels.size());
    const auto ours = all_levels(device.work), theirs = all_levels(twin.work);
    for (std::size_t l = 0; l < theirs.size(); ++l) {
      for (std::size_t c = 0; c + 1 < kComponents; ++c) expect_equal(ours[l][c], theirs[l][c]);
    }
  }
}

// One level of a region that is cut all at once: the critical path is the twin's, to the step.
TEST(Work, CriticalPathOfTheFirstLevel) {
  for (const char* const input : kInputs) {
    const Coordinates points = make_fixture(input, kPoints, 3);
    for (const Hull hull : kVariants) {
      SCOPED_TRACE(std::string(input) + ", " + to_string(hull));
      const Work twin = run(points, Mode::recursive, hull, Cut::interquartile).work;
      const Work device = run(points, Mode::flattened, hull, Cut::interquartile).work;
      for (std::size_t c = 0; c < kComponents; ++c) {
        EXPECT_EQ(device.levels[0][c].critical_path, twin.levels[0][c].critical_path) << kComponentNames[c];
      }
    }
  }
}

// The regions that are left are solved by Dwyer's algorithm, whose work is the end game's; what the device
// did before is what it does in flattened mode. Less than Dwyer's on all points, whose outermost merges are
// spared.
TEST(Work, OfAPartition) {
  constexpr auto kEndgame = static_cast<std::size_t>(Component::endgame);
  const Coordinates points = make_fixture("uniform", kPoints, 3);
  Options options;
  options.mode = Mode::partition;
  options.partition_levels = 3;
  options.count = true;
  const Work work = research::triangulate(triangulator(), points.data(), kPoints, options).work;
  const Work flattened = run(points, Mode::flattened, Hull::prune, Cut::interquartile).work;
  const Work dwyer = run(points, Mode::dwyer, Hull::prune, Cut::interquartile).work;
  ASSERT_EQ(work.levels.size(), 3u);
  std::uint64_t merges = 0;
  for (const Work::Components& level : dwyer.levels) {
    for (const OperationCounts& counts : level) merges += counts.operations();
  }
  for (std::size_t l = 0; l < 3; ++l) {
    for (std::size_t c = 0; c < kEndgame; ++c) {
      EXPECT_EQ(work.levels[l][c].operations(), flattened.levels[l][c].operations()) << kComponentNames[c];
    }
  }
  EXPECT_GT(work.levels[2][kEndgame].operations(), merges / 2);
  EXPECT_LT(work.levels[2][kEndgame].operations(), merges * 5 / 4);
}

}  // namespace
}  // namespace flaunay::testing
