// The stages of mode blocks one after the other, each against its twin, on random and on degenerate input,
// under several tunings.
//
// Suites named Small... have tiny inputs, for devices and sanitizers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <regex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "host/opencl/programs.hpp"
#include "tests/blocks/support.hpp"
#include "tests/support/paths.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::blocks {

/// exact: no filter decides anything.
Triangulation check_stages(Runtime& runtime, const Coordinates& coordinates, const Offsets& offsets, Met& met,
                           bool exact) {
  Call call(runtime);
  Triangulation result;
  // Not yet written, as the library's caller has it.
  result.representatives.assign(offsets.back(), -7);
  const auto representatives = runtime.output(result.representatives);
  const Blocks blocks = *make_blocks(call.work, call.runtime.view(coordinates.data(), coordinates.size()),
                                     offsets, representatives);
  HostRings g;
  check_blocks(call, coordinates, offsets, blocks, representatives, g, met);
  if (::testing::Test::HasFatalFailure()) return result;
  if (exact) call.work.bounds = {2, 2, 2};
  Rings rings = divide(call.work, blocks, representatives);
  await_rings(call.work, blocks, rings);
  if (rings.ties_left > 0) make_fans(call.work, blocks, rings);
  met.ties += rings.ties;
  runtime.fetch_later(representatives, result.representatives);
  runtime.finish();
  check_rings(call, coordinates, offsets, blocks, rings, result.representatives, g, met);
  if (::testing::Test::HasFatalFailure()) return result;
  check_mesh(call, blocks, rings, false, g, result, met);
  check_mesh(call, blocks, rings, true, g, result, met);
  return result;
}

void check_stages(Runtime& runtime, const Coordinates& coordinates, Met& met, bool exact) {
  check_stages(runtime, coordinates, {0, coordinates.size() / 2}, met, exact);
}

namespace {

/// Subsets of the points of a grid, of `least` to `most` points, all as sets of one call.
Nested subsets(int width, int height, int least, int most,
               const std::function<cl_double2(double, double)>& place) {
  Nested all;
  for (unsigned subset = 0; subset < 1u << (width * height); ++subset) {
    Coordinates points;
    for (int i = 0; i < width * height; ++i) {
      if ((subset >> i & 1) == 0) continue;
      const cl_double2 p = place(i / height, i % height);
      points.insert(points.end(), {p.s[0], p.s[1]});
    }
    const int size = static_cast<int>(points.size() / 2);
    if (size >= least && size <= most) all.add(points);
  }
  return all;
}

/// Grids as they are, of many bits, and sheared, so that no two points are in a column.
const std::vector<std::pair<std::string, std::function<cl_double2(double, double)>>> kGrids{
    {"grid",
     [](double x, double y) {
       return cl_double2{{x, y}};
     }},
    {"grid of many bits",
     [](double x, double y) {
       return cl_double2{{x * (1 + 0x1p-45), y * (1 + 0x1p-45)}};
     }},
    {"turned grid",
     [](double x, double y) {
       return cl_double2{{5 * x - 3 * y, 3 * x + 5 * y}};
     }},
    {"bent grid", [](double x, double y) {
       return cl_double2{{x + 0x1p-50 * x * x, y - 0x1p-50 * x * y}};
     }}};

TEST(SmallStages, AllSubsetsOfASmallGrid) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    const Nested sets = subsets(3, 2, 0, 4, kGrids[1].second);
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.flat, 10u);
    EXPECT_GT(met.triangles, 20u);
  });
}

TEST(Stages, AllSubsetsOfAGrid) {
  under_each_tuning([](Runtime& runtime) {
    for (const auto& [name, place] : kGrids) {
      SCOPED_TRACE(name);
      Met met;
      const Nested sets = subsets(4, 4, 1, 4, place);
      ASSERT_EQ(sets.offsets.size() - 1, 16u + 120 + 560 + 1820);
      check_stages(runtime, sets.coordinates, sets.offsets, met);
      EXPECT_GT(met.triangles, 2500u);
      const Nested larger = subsets(4, 3, 5, 12, place);
      check_stages(runtime, larger.coordinates, larger.offsets, met, true);
    }
  });
}

/// Two empty sets, one point, all sizes about that of a block.
Nested sizes_about_blocks(std::size_t block_points, std::size_t most, std::uint64_t seed) {
  Nested all;
  all.add({});
  all.add({});
  all.add({0.25, -0.0});
  for (std::size_t size = block_points; size <= most; size *= 2) {
    for (const std::size_t n : {size - 1, size, size + 1}) {
      FixtureRandom random(seed + n);
      all.add(make_fixture("uniform", n, seed + n));
      all.add(coarse(n, 4, 4, random));
      if (n % 3 == 0) all.add({});
    }
  }
  all.add({});
  return all;
}

TEST(SmallStages, SetsOfAllSizes) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    const Nested sets = sizes_about_blocks(6, 12, 5);
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.duplicates, 5u);
  });
}

TEST(Stages, SetsOfSizesAboutBlocks) {
  under_each_tuning([](Runtime& runtime) {
    const std::size_t block = tuning_of(runtime).block_points;
    Met met;
    const Nested sets = sizes_about_blocks(block, std::max<std::size_t>(2 * block, 200), 6);
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.merges, 10u);
  });
}

TEST(SmallStages, AwkwardInput) {
  under_each_tuning([](Runtime& runtime) {
    for (const auto& [name, points] : awkward(26, 7)) {
      SCOPED_TRACE(name);
      Met met;
      check_stages(runtime, points, met);
    }
  });
}

TEST(Stages, AwkwardInput) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    for (const std::size_t n : {26, 120, 2500}) {
      for (const auto& [name, points] : awkward(n, 8)) {
        SCOPED_TRACE(name + ", " + std::to_string(n) + " points");
        check_stages(runtime, points, met, n == 120);
      }
    }
    if (tuning_of(runtime).block_points > 100) return;
    EXPECT_GT(met.empty_blocks, 100u);
    EXPECT_GT(met.large_blocks, 10u);
  });
}

TEST(SmallStages, Fixtures) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    for (const char* const name : {"uniform", "integer-star", "slender"}) {
      SCOPED_TRACE(name);
      check_stages(runtime, make_fixture(name, 20, 9), met);
    }
    check_stages(runtime, make_fixture("ladder", 13, 9), met, true);
  });
}

TEST(Stages, Fixtures) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    for (const testing::Fixture& fixture : testing::all_fixtures()) {
      SCOPED_TRACE(fixture.name);
      check_stages(runtime, fixture.make(kReferencePoints, 10), met);
      const Coordinates some = fixture.make(60, 11);
      check_stages(runtime, some, met, true);
      check_stages(runtime, testing::perturbed(some, 12), met);
      check_stages(runtime, fixture.make(1500, 13), met);
    }
  });
}

TEST(Stages, ThousandsOfTinySets) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(14);
    Nested sets;
    for (int s = 0; s < 4000; ++s)
      sets.add(coarse(static_cast<std::size_t>(random.integer(0, 9)), 5, 4, random));
    Met met;
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.flat, 500u);
    EXPECT_GT(met.duplicates, 500u);
    EXPECT_GT(met.triangles, 5000u);
  });
}

TEST(Stages, SetsOfVeryDifferentSizes) {
  under_each_tuning([](Runtime& runtime) {
    FixtureRandom random(15);
    Nested sets;
    for (const std::size_t n : {3, 5000, 0, 7, 40, 800, 1, 0, 12}) sets.add(make_fixture("uniform", n, n));
    sets.add(coarse(700, 20, 20, random));
    Met met;
    check_stages(runtime, sets.coordinates, sets.offsets, met);
    EXPECT_GT(met.duplicates, 200u);
  });
}

TEST(Stages, OneLargeSet) {
  under_each_tuning([](Runtime& runtime) {
    Met met;
    runtime.arena().reset_peak();
    check_stages(runtime, make_fixture("uniform", 20000, 16), met);
    // However small blocks and chunks are, with 16 samples for each; a table of both would be larger.
    EXPECT_LT(runtime.arena().peak_bytes(), 20000u * 1600);
    EXPECT_GE(met.merges, 15u);
    check_stages(runtime, make_fixture("grid", 12000, 17), met);
  });
}

/// What tells blocks of many equal points from others is their size: on both sides of it.
TEST(SmallStages, BlocksAboutTheRoomOfManyWorkers) {
  under_each_tuning([](Runtime& runtime) {
    const std::size_t block = std::min<std::size_t>(tuning_of(runtime).block_points, 13);
    Met met;
    for (const std::size_t n : {4 * block, 4 * block + 1}) {
      Nested sets;
      sets.add(Coordinates(2 * n, 0.5));
      sets.add(make_fixture("uniform", 9, n));
      check_stages(runtime, sets.coordinates, sets.offsets, met);
    }
    EXPECT_EQ(met.large_blocks, tuning_of(runtime).block_points <= 13 ? 1u : 0u);
  });
}

/// Rows and all do not depend on who does which block, on chunks, nor on whose memory it is.
TEST(Stages, ResultsDoNotDependOnTuning) {
  Nested sets;
  sets.add(make_fixture("uniform", 900, 18));
  sets.add(make_fixture("random-integers", 30, 19));
  sets.add(make_fixture("ladder", 300, 20));
  for (const std::size_t block_points : {2, 6, 64}) {
    std::vector<Triangulation> results;
    for (const int variant : {0, 1, 2, 3}) {
      const auto own = testing::make_tuned_runtime("own");
      Runtime& runtime = *own;
      Tuning tuning = tuning_of(runtime);
      tuning.block_points = block_points;
      tuning.block_workers = std::array<std::size_t, 4>{1, 3, 64, 5000}[static_cast<std::size_t>(variant)];
      tuning.chunk_least = std::array<std::size_t, 4>{2, 7, 100, 2000}[static_cast<std::size_t>(variant)];
      tuning.chunks_most = variant == 2 ? 3 : 0;
      if (runtime.memory().in_host_memory) tuning.in_host_memory = variant % 2;
      tuning.separate_buffers = variant == 3;
      runtime.set_sizes(std::make_shared<Tuning>(tuning));
      Met met;
      results.push_back(check_stages(runtime, sets.coordinates, sets.offsets, met));
    }
    for (const Triangulation& result : results) {
      EXPECT_TRUE(same(result.triangles, results[0].triangles));
      EXPECT_TRUE(same(result.neighbors, results[0].neighbors));
      EXPECT_TRUE(same(result.hull, results[0].hull));
    }
  }
}

/// Whatever a stage launches on ordinary and degenerate input is all there is: no kernel is left over, none
/// untested.
TEST(Kernels, AllAreLaunched) {
  // Those of points/inspect.cl are in the same program; inspect_test.cpp launches them.
  std::set<std::string> launched{"inspect", "inspect_sets", "scale_sets", "widen_points"};
  std::vector<std::string> files{"points/distribute", "blocks/divide", "blocks/fans", "blocks/mesh",
                                 "blocks/rounds"};
  std::vector<std::string> tunings{"odd"};
  if (!testing::tests_native()) {
    files.insert(files.end(), {"blocks/halve", "blocks/halve_large", "blocks/merge", "blocks/merge_exact",
                               "blocks/seams", "blocks/stars", "points/distribute_tiles", "points/gaps"});
    tunings.insert(tunings.end(), {"small lanes", "tiles"});
  }
  for (const std::string& tuning : tunings) {
    Runtime& runtime = Runtimes::get(tuning);
    runtime.set_profiling(true);
    Met met;
    check_stages(runtime, make_fixture("uniform", 100, 22), met);
    check_stages(runtime, make_fixture("integer-star", 200, 23), met);
    check_stages(runtime, Coordinates(200, 0.5), met);
    check_stages(runtime, make_fixture("uniform", 400, 24), met);
    check_stages(runtime, make_fixture("uniform", 5, 25), met);
    std::vector<std::size_t> one_large_set{0};
    for (std::size_t end = 12; end <= 32; end += 2) one_large_set.push_back(end);
    check_stages(runtime, make_fixture("uniform", 32, 26), one_large_set, met);
    for (const auto& [name, time] : runtime.kernel_times()) launched.insert(name);
    runtime.set_profiling(false);
  }
  Runtime& rounds = Runtimes::get("rounds");
  rounds.set_profiling(true);
  run_rounds_of_all_kinds();
  for (const auto& [name, time] : rounds.kernel_times()) launched.insert(name);
  rounds.set_profiling(false);
  std::size_t kernels = 0;
  for (const std::string& file : files) {
    const std::string source = host::kernel_source(file);
    const std::regex pattern("\nkernel void (\\w+)\\(");
    for (std::sregex_iterator it(source.begin(), source.end(), pattern), end; it != end; ++it) {
      EXPECT_EQ(launched.count((*it)[1]), 1u) << (*it)[1] << " of " << file << ".cl";
      ++kernels;
    }
  }
  EXPECT_EQ(kernels, testing::tests_native() ? 42u : 75u);
}

}  // namespace

}  // namespace flaunay::blocks
