// Mode flattened with its levels to the bottom, whole: the triangles and neighbours of the default mode, of
// which triangulation_test.cpp proves that they are right, from input on which each stage has something to
// do.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "flattened/limits.h"
#include "flaunay/research.hpp"
#include "host/opencl/programs.hpp"
#include "tests/flattened/support.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::flattened {
namespace {

using research::Cut;
using research::Finish;
using research::Hull;

using Offsets = std::vector<std::size_t>;

/// What the calls of a test had to do.
struct Met {
  std::size_t levels = 0, regions = 0, undecided = 0;
  std::size_t survivors = 0, path_vertices = 0;  ///< of prune, in the first two levels
  std::set<std::string> kernels;
};

struct Variant {
  Hull hull = Hull::prune;
  Cut cut = Cut::interquartile;
  bool count = false;  ///< as the paper has it, with the rounds of prune
};
const std::vector<Variant> kVariants = {{},
                                        {Hull::prune, Cut::alternate},
                                        {Hull::prune, Cut::interquartile, true},
                                        {Hull::quickhull, Cut::interquartile},
                                        {Hull::balanced, Cut::alternate}};

/// All variants, or the default alone.
void check(const Coordinates& points, const Offsets& offsets, bool all_variants, Met& met,
           const std::vector<std::string>& tunings = {"", kSmallTuning}) {
  const Triangulation expected = testing::triangulator().triangulate(points.data(), offsets);
  for (const std::string& tuning : tunings) {
    if (tuning == kSmallTuning && std::getenv("FLAUNAY_TUNING") != nullptr) continue;
    for (std::size_t k = 0; k < (all_variants ? kVariants.size() : 1); ++k) {
      const Variant& variant = kVariants[k];
      SCOPED_TRACE(tuning + ", variant " + std::to_string(k));
      research::Options options;
      options.mode = research::Mode::flattened;
      options.finish = Finish::levels;
      options.hull = variant.hull;
      options.cut = variant.cut;
      options.count = variant.count;
      options.profile = true;
      const research::Triangulation found =
          research::triangulate(testing::triangulator_with(tuning), points.data(), offsets, options);
      testing::expect_same_but_for_order(found, expected);
      if (::testing::Test::HasFailure()) return;
      met.undecided += found.statistics.undecided;
      for (const KernelStatistics& kernel : found.statistics.kernels) met.kernels.insert(kernel.name);
      met.levels += found.levels.size();
      for (std::size_t l = 0; l < found.levels.size(); ++l) {
        met.regions += found.levels[l].regions;
        met.survivors += l < 2 ? found.levels[l].survivors : 0;
        met.path_vertices += l < 2 ? found.levels[l].path_vertices : 0;
      }
    }
  }
}

void check(const Coordinates& points, bool all_variants, Met& met) {
  check(points, {0, points.size() / 2}, all_variants, met);
}

/// Exactly the structure of a fixture of few bits, but with so many bits that filters leave it undecided.
Coordinates long_numbers(const std::string& fixture, std::size_t n, std::uint64_t seed) {
  return testing::scaled(make_fixture(fixture, n, seed), 1 + 0x1.6b8a3p-12 + 0x1p-31);
}

/// All points of integer coordinates with x^2 + y^2 = square.
Coordinates integer_circle(std::int64_t square) {
  Coordinates points;
  const auto reach = static_cast<std::int64_t>(std::sqrt(static_cast<double>(square))) + 1;
  for (std::int64_t x = -reach; x <= reach; ++x) {
    const std::int64_t rest = square - x * x;
    if (rest < 0) continue;
    const auto y = static_cast<std::int64_t>(std::lround(std::sqrt(static_cast<double>(rest))));
    if (y * y != rest) continue;
    points.insert(points.end(), {static_cast<double>(x), static_cast<double>(-y)});
    points.insert(points.end(), {static_cast<double>(x), static_cast<double>(y)});
  }
  return points;
}

TEST(SmallFlattened, GridsAndSets) {
  Met met;
  check(make_fixture("grid", 25, 7), true, met);
  check(long_numbers("small-integers", 20, 9), true, met);
  FixtureRandom random(8);
  check(coarse_points(40, 3, random), {0, 0, 9, 12, 30, 30, 40}, true, met);
  EXPECT_GT(met.undecided, 0u);
}

TEST(Flattened, GeneralPosition) {
  Met met;
  for (const char* const name : {"uniform", "normal", "kuzmin", "line", "clusters", "spiral", "log-spiral",
                                 "slender", "corners", "far-away", "parabola"}) {
    SCOPED_TRACE(name);
    check(make_fixture(name, 500, 7), true, met);
  }
  EXPECT_GT(met.undecided, 0u);
}

TEST(Flattened, Degenerate) {
  Met met;
  for (const char* const name :
       {"grid", "rotated-grid", "hexagonal", "circle", "integer-circle", "nested-circles", "columns",
        "small-integers", "half-duplicates", "two-lines", "thirty-lines", "star", "integer-star",
        "circle-few-inside", "ladder", "apex", "triangle-edges", "random-integers"}) {
    SCOPED_TRACE(name);
    check(make_fixture(name, 400, 7), true, met);
  }
}

TEST(Flattened, UndecidedPredicates) {
  for (const char* const name :
       {"grid", "small-integers", "integer-circle", "hexagonal", "thirty-lines", "ladder", "columns"}) {
    SCOPED_TRACE(name);
    Met met;
    check(long_numbers(name, 400, 9), true, met);
    EXPECT_GT(met.undecided, 100u);
  }
}

/// One polygon of 1,152 cocircular points, and some inside of another circle.
TEST(Flattened, ManyCocircularPoints) {
  Met met;
  constexpr std::int64_t kSquare = std::int64_t{25} * 13 * 17 * 29;
  for (const double factor : {1.0, 1 + 0x1p-30}) {
    check(testing::scaled(integer_circle(kSquare * 5 * 13 * 17 * 37 * 41), factor), false, met);
    Coordinates points = testing::scaled(integer_circle(kSquare), factor);
    const Coordinates inside = testing::scaled(integer_circle(25 * 13), 4 * factor);
    points.insert(points.end(), inside.begin(), inside.end());
    check(points, true, met);
  }
}

TEST(Flattened, ManySets) {
  Met met;
  FixtureRandom random(10);
  for (const int values : {1, 2, 3, 10, 1000}) {
    SCOPED_TRACE(values);
    const Offsets offsets = random_offsets(100, 30, random);
    check(coarse_points(offsets.back(), values, random), offsets, true, met);
  }
}

/// Squares with one or two points inside, and some without: as many regions as sets.
TEST(Flattened, AHundredThousandTinyRegions) {
  for (const bool small : {false, true}) {
    Met met;
    FixtureRandom random(13);
    Coordinates points;
    Offsets offsets{0};
    for (int s = 0; s < (small ? 5000 : 110000); ++s) {
      for (const double corner : {0.0, 0.0, 8.0, 0.0, 8.0, 8.0, 0.0, 8.0}) points.push_back(corner);
      const std::int64_t inside = s % 10 == 9 ? 0 : random.integer(1, 2);
      for (std::int64_t i = 0; i < 2 * inside; ++i)
        points.push_back(static_cast<double>(random.integer(1, 7)));
      offsets.push_back(points.size() / 2);
    }
    check(points, offsets, false, met, {small ? kSmallTuning : ""});
    EXPECT_GE(met.regions, small ? 4500u : 99000u);
  }
}

/// So large that prune thins its candidates by candidates of their own. It leaves little more than the hulls.
TEST(Flattened, OneHugeRegion) {
  Met met;
  for (const char* const name : {"kuzmin", "random-integers"}) {
    SCOPED_TRACE(name);
    const Coordinates points = make_fixture(name, 100000, 11);
    check(points, {0, 100000}, false, met, {""});
  }
  EXPECT_LT(met.survivors, 2 * met.path_vertices);
  for (const char* const name : {"grid", "columns", "rotated-grid", "half-duplicates", "line"}) {
    SCOPED_TRACE(name);
    check(make_fixture(name, 10000, 29), false, met);
  }
}

/// A flat lens of border vertices close to the cut line, and a few points inside: so many kept corners that
/// runs of them are merged.
Coordinates lens() {
  Coordinates points;
  constexpr int kHalf = 3 * kernel::COUNTED_CORNERS;
  for (int i = -kHalf; i <= kHalf; ++i) {
    const double bulge = (1.0 * kHalf * kHalf - 1.0 * i * i) / (1 << 20);
    points.insert(points.end(), {1.0 * i, 1 + bulge, 1.0 * i, -1 - bulge});
  }
  for (int i = 0; i < 5; ++i) points.insert(points.end(), {i / 64.0, (i % 3 - 1) / 4.0});
  return points;
}

/// No kernel is left over that ordinary and degenerate input do not need.
TEST(Flattened, LaunchesAllKernels) {
  Met met;
  met.kernels = {"restart_paths", "restart_segments"};  // which stages_test.cpp launches
  check(lens(), true, met);
  EXPECT_GT(met.levels, 2u);
  FixtureRandom random(26);
  check(coarse_points(40, 3, random), {0, 0, 9, 12, 40}, true, met);
  check(make_fixture("uniform", 5000, 31), true, met);
  research::Options options;
  options.mode = research::Mode::flattened;
  options.profile = true;
  for (const Hull hull : {Hull::prune, Hull::quickhull}) {
    options.hull = hull;
    const Coordinates points = make_fixture("rotated-grid", 20000, 1);
    const Offsets sets{0, 500, 20000};
    const auto in_blocks = research::triangulate(testing::triangulator(), points.data(), sets, options);
    for (const KernelStatistics& kernel : in_blocks.statistics.kernels) met.kernels.insert(kernel.name);
  }
  std::size_t kernels = 0;
  for (const char* const file : {"ingest", "border", "cut", "project", "prune", "chains", "quickhull",
                                 "hull_depth", "merge", "children", "lists", "endgame", "endgame_exact",
                                 "strips", "neighbors", "canonical", "output", "regions"}) {
    const std::string source = host::kernel_source(std::string("flattened/") + file);
    const std::regex pattern("\nkernel void (\\w+)\\(|\nSEGMENTED_ARG_REDUCE\\((\\w+),");
    for (std::sregex_iterator it(source.begin(), source.end(), pattern), end; it != end; ++it) {
      const std::string name = (*it)[1].matched ? (*it)[1] : (*it)[2];
      EXPECT_EQ(met.kernels.count(name), 1u) << name << " of " << file << ".cl";
      ++kernels;
    }
  }
  EXPECT_GT(kernels, 70u);
}

}  // namespace
}  // namespace flaunay::flattened
