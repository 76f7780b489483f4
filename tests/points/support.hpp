// What the tests of the stages of mode blocks share: runtimes, the state of a call, and input that a cut, a
// sort or a merge might stumble over.
#pragma once

#include <CL/cl.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "host/opencl/device.hpp"
#include "host/runtime.hpp"
#include "points/distribute.hpp"
#include "tests/support/cut_tree_twin.hpp"
#include "tests/support/device.hpp"
#include "tests/support/divide_twin.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/mesh_twin.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/runtimes.hpp"
#include "tests/support/same.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::points {

using host::Runtime;
using testing::BlocksTwin;
using testing::comes_first;
using testing::Coordinates;
using testing::FixtureRandom;
using testing::HostRings;
using testing::make_fixture;
using testing::MeshTwin;
using testing::RingCheck;
using testing::same;
using testing::sample_indices;
using testing::spread_indices;
using testing::TreeTwin;

using Offsets = std::vector<std::size_t>;

/// One for each tuning; "own" is the device's or what the environment names. "tiles": work-groups take tiles
/// so small that little input has many. "tiles:N": tiles as on GPUs, but for groups of N.
inline std::unique_ptr<Runtime> make_runtime(const std::string& name) {
  const bool has_tiles = name.compare(0, 5, "tiles") == 0;
  auto runtime = testing::make_tuned_runtime(name == "small" || name == "tiles" ? "small"
                                             : has_tiles                        ? "gpu"
                                                                                : "own");
  Tuning tuning = tuning_of(*runtime);
  if (name == "odd") {
    // One work-item for all blocks, many chunks, no tiles.
    tuning.tile_group = 0;
    tuning.block_points = 13;
    tuning.block_workers = 1;
    tuning.chunk_least = 2;  // as few as a scan can do with
    tuning.chunks_most = 0;
  }
  if (has_tiles) tuning.tile_group = name == "tiles" ? 3 : std::stoul(name.substr(6));
  if (has_tiles) tuning.block_points = 11;
  if (name == "single") {
    // Blocks without merges of their own, in memory that is shared if it was not.
    tuning.block_points = 1;
    tuning.block_workers = 1000;
    tuning.chunk_least = 3;
    tuning.chunks_most = 11;
    if (runtime->memory().in_host_memory) tuning.in_host_memory = !tuning.in_host_memory;
  }
  if (name == "lanes" || name == "small lanes") {
    // As a GPU solves blocks; with small groups and blocks, too.
    const bool is_small = name == "small lanes";
    tuning.blocks_in_parallel = 1;
    tuning.halve_group = is_small ? 4 : 64;
    tuning.block_group = is_small ? 2 : 32;
    tuning.merge_items = is_small ? 30 : 1000;
    tuning.star_points = is_small ? 150 : 0;
    tuning.seam_points = is_small ? 4 : 32;
    tuning.sewing_group = is_small ? 2 : 16;
    if (is_small) tuning.block_points = 13;
  }
  runtime->set_sizes(std::make_shared<Tuning>(tuning));
  return runtime;
}
using Runtimes = testing::SharedRuntimes<make_runtime>;
[[maybe_unused]] inline ::testing::Environment* const kRuntimes =
    ::testing::AddGlobalTestEnvironment(new Runtimes);

/// Under the tuning that the environment names alone, if it names one.
template <typename Check>
void under_each_tuning(const Check& check) {
  const bool chosen = std::getenv("FLAUNAY_TUNING") != nullptr;
  for (const std::string name : {"own", "small", "odd", "single", "lanes", "small lanes", "tiles"}) {
    if (chosen && name != "own") continue;
    // There, work-groups have one work-item each.
    const bool has_groups = name == "tiles" || name.find("lanes") != std::string::npos;
    if (testing::tests_native() && has_groups) continue;
    SCOPED_TRACE("tuning " + name);
    check(Runtimes::get(name));
  }
}

/// With tiles, whatever the environment names.
template <typename Check>
void under_tiles(const std::string& name, const Check& check) {
  SCOPED_TRACE("tuning " + name);
  Runtime& runtime = Runtimes::get(name);
  if (runtime.is_native()) GTEST_SKIP() << "native kernels have no work-groups";
  check(runtime);
}

/// With tiles, and groups of many sizes, which elements and tiles need not fill.
template <typename Check>
void under_each_group_of_tiles(const Check& check) {
  for (const char* const name : {"tiles", "tiles:1", "tiles:5", "tiles:100", "tiles:256"}) {
    under_tiles(name, check);
    if (::testing::Test::IsSkipped()) return;
  }
}

/// What triangulator.cpp sets up around the stages.
class Call {
 public:
  explicit Call(Runtime& used)
      : runtime(used), persistent_(used.memory()), scope_(used.arena()), work{used, persistent_} {}

  template <typename T>
  std::vector<T> read(const Buffer<T>& buffer, std::size_t count) {
    std::vector<T> values(count);
    runtime.read(buffer, 0, count, values.data());
    return values;
  }

  Runtime& runtime;

 private:
  Arena persistent_;
  Arena::Scope scope_;

 public:
  Workspace work;
};

inline void append(Coordinates& to, const Coordinates& points) {
  to.insert(to.end(), points.begin(), points.end());
}

inline cl_double2 point_of(const Coordinates& points, std::size_t i) {
  return {{points[2 * i], points[2 * i + 1]}};
}

inline std::vector<cl_double2> points_of(const Coordinates& coordinates) {
  std::vector<cl_double2> points;
  for (std::size_t i = 0; i < coordinates.size() / 2; ++i) points.push_back(point_of(coordinates, i));
  return points;
}

/// Integers in [0, width) x [0, height).
inline Coordinates coarse(std::size_t n, std::int64_t width, std::int64_t height, FixtureRandom& random) {
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    points.push_back(static_cast<double>(random.integer(0, width - 1)));
    points.push_back(static_cast<double>(random.integer(0, height - 1)));
  }
  return points;
}

/// What a cut, a sort or a merge might stumble over, beside the fixtures; each of n points.
inline std::vector<std::pair<std::string, Coordinates>> awkward(std::size_t n, std::uint64_t seed) {
  FixtureRandom random(seed);
  std::vector<std::pair<std::string, Coordinates>> all;
  const auto add = [&](const std::string& name, Coordinates points) {
    all.emplace_back(name, std::move(points));
  };
  const auto add_along = [&](const std::string& name, const std::function<cl_double2(double)>& point) {
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    random.shuffle(order);
    Coordinates points;
    for (const std::size_t i : order) {
      const cl_double2 p = point(static_cast<double>(i));
      points.insert(points.end(), {p.s[0], p.s[1]});
    }
    add(name, points);
  };
  add_along("one place", [](double) { return cl_double2{{3, -0.1}}; });
  add_along("column", [](double i) { return cl_double2{{0.3, i}}; });
  add_along("row", [](double i) { return cl_double2{{i, 0.3}}; });
  add_along("oblique line", [](double i) { return cl_double2{{3 * i, 1 - 2 * i}}; });
  add_along("zeros of both signs", [&](double i) {
    return cl_double2{{random.integer(0, 1) ? 0.0 : -0.0, random.integer(0, 1) ? std::floor(i / 4) : -0.0}};
  });
  add_along("neighbouring doubles", [&](double i) {
    if (i == 0) return cl_double2{{1e9, -1e9}};
    return cl_double2{{1 + static_cast<double>(random.integer(0, 40)) * 0x1p-52,
                       1 + static_cast<double>(random.integer(0, 40)) * 0x1p-52}};
  });
  add_along("a heap and few others", [&](double i) {
    return i < 4 * static_cast<double>(n) / 5 ? cl_double2{{0.5, 0.5}}
                                              : cl_double2{{random.unit(), random.unit()}};
  });
  add_along("heaps", [&](double i) {
    const double heap = std::fmod(i, 3);
    return cl_double2{{heap * heap, heap}};
  });
  add("few places", coarse(n, 3, 3, random));
  add("few columns", coarse(n, 2, 1000000, random));
  add("few rows", coarse(n, 1000000, 2, random));
  add("grid", coarse(n, static_cast<std::int64_t>(std::sqrt(n)) + 1,
                     static_cast<std::int64_t>(std::sqrt(n)) + 1, random));
  // Differences of coordinates overflow before points are scaled.
  Coordinates huge = make_fixture("uniform", n, seed);
  for (double& c : huge) c = (c - 0.5) * 0x1.fp1023 * 2;
  add("huge", testing::scaled(make_fixture("grid", n, seed), 0x1p1010));
  add("overflowing", huge);
  add("tiny", testing::scaled(make_fixture("uniform", n, seed), 0x1p-900));
  return all;
}

/// Points of a set in a nested call.
struct Nested {
  Coordinates coordinates;
  Offsets offsets{0};
  void add(const Coordinates& points) {
    append(coordinates, points);
    offsets.push_back(coordinates.size() / 2);
  }
};

/// What the tests met.
struct Met {
  std::size_t merges = 0, empty_blocks = 0, large_blocks = 0, duplicates = 0, flat = 0, triangles = 0,
              ties = 0;
};

/// The blocks of sets of points against their twin; see distribute_test.cpp. g: gets what the twin has.
void check_blocks(Call& call, const Coordinates& coordinates, const Offsets& offsets, const Blocks& blocks,
                  const Buffer<cl_int>& representatives, HostRings& g, Met& met);

}  // namespace flaunay::points
