// Whether every kernel of the flattened stages is met by their tests.
#include <gtest/gtest.h>

#include <cstddef>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "host/opencl/programs.hpp"
#include "tests/flattened/support.hpp"

namespace flaunay::flattened {
namespace {

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
    check_many_kept_corners(runtime, met);
    MetRegions met_regions;
    check_regions(runtime, make_fixture("grid", 100, 1), 2, true, met_regions);
    for (const auto& [name, time] : runtime.kernel_times()) launched.insert(name);
    runtime.set_profiling(false);
  }
  std::size_t kernels = 0;
  for (const char* const file :
       {"flattened/ingest", "flattened/border", "flattened/cut", "flattened/project", "flattened/prune",
        "flattened/chains", "flattened/quickhull", "flattened/hull_depth", "flattened/merge",
        "flattened/children", "flattened/lists", "flattened/endgame", "flattened/endgame_exact",
        "flattened/strips", "flattened/neighbors", "flattened/canonical", "flattened/output",
        "flattened/regions"}) {
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
