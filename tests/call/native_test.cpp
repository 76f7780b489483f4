// Calls on host memory without OpenCL: the same results as on a device, byte by byte.
#include <gtest/gtest.h>
#ifndef _WIN32
#include <sys/wait.h>
#include <unistd.h>
#endif

#include <atomic>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.hpp"
#include "flaunay/research.hpp"
#include "tests/support/device.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/same.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {
namespace {

using Offsets = std::vector<std::size_t>;

Options all_parts() {
  Options options;
  options.halfedges = true;
  return options;
}

Triangulation triangulate(Triangulator& triangulator, const Coordinates& points, const Offsets& offsets) {
  return triangulator.triangulate(points.data(), offsets, all_parts());
}

void expect_same_bytes(const Triangulation& found, const Triangulation& expected) {
  EXPECT_TRUE(same(found.triangles, expected.triangles)) << "triangles";
  EXPECT_TRUE(same(found.neighbors, expected.neighbors)) << "neighbors";
  EXPECT_TRUE(same(found.halfedges, expected.halfedges)) << "halfedges";
  EXPECT_TRUE(same(found.hull, expected.hull)) << "hull";
  EXPECT_TRUE(same(found.representatives, expected.representatives)) << "representatives";
  expect_same_sizes(found, expected);
  // The bounds of filters are those of a group of sets.
  EXPECT_LE(found.statistics.undecided, expected.statistics.undecided);
}

// A triangulator on a device, one on the host, and one that may choose, for the process.
class SmallNative : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const ScopedEnvironment unset("FLAUNAY_DEVICE", nullptr);
    host_ = std::make_unique<Triangulator>("host");
    free_ = std::make_unique<Triangulator>();
  }
  static void TearDownTestSuite() {
    host_.reset();
    free_.reset();
  }
  static Triangulator& on_device() { return triangulator(); }
  static Triangulator& on_host() { return *host_; }
  static Triangulator& free_to_choose() { return *free_; }

  static void compare(const Coordinates& points, const Offsets& offsets) {
    const Triangulation expected = triangulate(on_device(), points, offsets);
    expect_same_bytes(triangulate(on_host(), points, offsets), expected);
    expect_same_bytes(triangulate(free_to_choose(), points, offsets), expected);
  }
  static void compare(const Coordinates& points) { compare(points, {0, points.size() / 2}); }

 private:
  static std::unique_ptr<Triangulator> host_, free_;
};
std::unique_ptr<Triangulator> SmallNative::host_, SmallNative::free_;

Coordinates integers(std::size_t n, std::int64_t most, FixtureRandom& random) {
  Coordinates points;
  for (std::size_t i = 0; i < 2 * n; ++i) points.push_back(static_cast<double>(random.integer(-most, most)));
  return points;
}

Coordinates reals(std::size_t n, FixtureRandom& random) {
  Coordinates points;
  for (std::size_t i = 0; i < 2 * n; ++i) points.push_back(random.unit() - 0.5);
  return points;
}

TEST_F(SmallNative, FixturesAreAsOnADevice) {
  for (const Fixture& fixture : all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    compare(fixture.make(300, 5));
  }
}

// Around the sizes of blocks and of what is done on the calling thread.
TEST_F(SmallNative, EverySizeIsAsOnADevice) {
  FixtureRandom random(11);
  for (const std::size_t n :
       {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 31, 100, 2047, 2048, 2049, 4097, 6000, 6001, 30000}) {
    SCOPED_TRACE(std::to_string(n) + " points");
    compare(reals(n, random));
    compare(integers(n, 20, random));
  }
}

TEST_F(SmallNative, BatchesAreAsOnADevice) {
  FixtureRandom random(12);
  for (const std::size_t largest : {4, 40, 400, 2048, 5000}) {
    Coordinates points;
    Offsets offsets = {0};
    for (int s = 0; s < 30; ++s) {
      const auto n = static_cast<std::size_t>(s % 7 == 0 ? 0 : random.integer(0, static_cast<int>(largest)));
      const Coordinates set = s % 3 == 0 ? integers(n, 6, random) : reals(n, random);
      points.insert(points.end(), set.begin(), set.end());
      offsets.push_back(points.size() / 2);
    }
    SCOPED_TRACE("sets of up to " + std::to_string(largest));
    compare(points, offsets);
  }
  compare({}, {0});
  compare({}, {0, 0, 0});
}

TEST_F(SmallNative, BatchesOfEveryScaleAreAsOnADevice) {
  FixtureRandom random(15);
  for (const std::size_t n : {20, 5000}) {
    Coordinates points;
    Offsets offsets = {0};
    for (const int exponent : {-1000, 0, 900}) {
      for (const double x : reals(n, random)) points.push_back(std::ldexp(x, exponent));
      offsets.push_back(points.size() / 2);
      offsets.push_back(points.size() / 2);
    }
    compare(points, offsets);
  }
}

TEST_F(SmallNative, SinglePrecisionIsAsOnADevice) {
  FixtureRandom random(13);
  for (const std::size_t n : {3, 100, 5000}) {
    std::vector<float> narrow;
    for (const double x : reals(n, random)) narrow.push_back(static_cast<float>(x));
    const Triangulation expected = on_device().triangulate(narrow.data(), n, all_parts());
    expect_same_bytes(on_host().triangulate(narrow.data(), n, all_parts()), expected);
    expect_same_bytes(free_to_choose().triangulate(narrow.data(), n, all_parts()), expected);
  }
}

TEST_F(SmallNative, ErrorsAreAsOnADevice) {
  const double infinite = std::numeric_limits<double>::infinity();
  for (const Coordinates& wrong :
       {Coordinates{0, 0, 1, infinite, 2, 2}, Coordinates{0, 1e300, 1e-300, 1, 3, 3}}) {
    std::vector<std::string> messages;
    for (Triangulator* used : {&on_device(), &on_host(), &free_to_choose()}) {
      try {
        used->triangulate(wrong.data(), 3);
        ADD_FAILURE() << "no error";
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        messages.push_back(error.what());
      }
    }
    EXPECT_EQ(messages, std::vector<std::string>(3, messages.at(0)));
  }
}

const Coordinates kClip = {0.125, 0, 3, 0.5, 0.25, 4};

TEST_F(SmallNative, VoronoiDiagramsAndQueriesAreAsOnADevice) {
  FixtureRandom random(14);
  for (const std::size_t n : {1, 2, 3, 50, 3000}) {
    for (const Coordinates& points : {reals(n, random), integers(n, 9, random)}) {
      const Coordinates queries = reals(20000, random);  // enough to be sorted
      const Triangulation mesh = triangulate(on_device(), points, {0, n});
      const Voronoi dual = on_device().voronoi(points.data(), n, mesh);
      const ClippedVoronoi cells = on_device().clipped_voronoi(points.data(), n, mesh, kClip.data(), 3);
      const Coordinates relaxed = on_device().relax(points.data(), n, kClip.data(), 3, 2);
      Locator locator(on_device(), points.data(), n, mesh);
      std::vector<double> values(n, 1.5);
      for (Triangulator* used : {&on_host(), &free_to_choose()}) {
        const Voronoi own = used->voronoi(points.data(), n, mesh);
        EXPECT_TRUE(same(own.circumcentres, dual.circumcentres));
        EXPECT_TRUE(same(own.cell_offsets, dual.cell_offsets));
        EXPECT_TRUE(same(own.cells, dual.cells));
        EXPECT_TRUE(same(own.unbounded, dual.unbounded));
        const ClippedVoronoi own_cells = used->clipped_voronoi(points.data(), n, mesh, kClip.data(), 3);
        EXPECT_TRUE(same(own_cells.vertices, cells.vertices));
        EXPECT_TRUE(same(own_cells.offsets, cells.offsets));
        EXPECT_TRUE(same(own_cells.areas, cells.areas));
        EXPECT_TRUE(same(used->relax(points.data(), n, kClip.data(), 3, 2), relaxed));
        Locator other(*used, points.data(), n, mesh);
        EXPECT_TRUE(same(other.locate(queries.data(), 20000), locator.locate(queries.data(), 20000)));
        EXPECT_TRUE(same(other.nearest(queries.data(), 20000), locator.nearest(queries.data(), 20000)));
        const auto found = other.interpolate(values.data(), queries.data(), 20000);
        const auto expected = locator.interpolate(values.data(), queries.data(), 20000);
        ASSERT_EQ(found.size(), expected.size());
        EXPECT_EQ(std::memcmp(found.data(), expected.data(), found.size() * sizeof(double)), 0);
      }
    }
  }
}

// One triangulator for each thread; small sets use memory of the thread.
TEST_F(SmallNative, ThreadsDoNotDisturbEachOther) {
  FixtureRandom random(15);
  std::vector<Coordinates> inputs;
  std::vector<Triangulation> expected;
  for (std::size_t n = 1; n < 200; ++n) {
    inputs.push_back(reals(n, random));
    expected.push_back(triangulate(on_device(), inputs.back(), {0, n}));
  }
  std::vector<std::thread> threads;
  std::atomic<int> wrong{0};
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      Triangulator own("");
      for (int round = 0; round < 20; ++round) {
        for (std::size_t k = 0; k < inputs.size(); ++k) {
          const Triangulation found = triangulate(own, inputs[k], {0, inputs[k].size() / 2});
          wrong += found.triangles != expected[k].triangles || found.neighbors != expected[k].neighbors;
        }
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

#ifndef _WIN32
// OpenCL cannot be used in a process that was forked after it was, but the host can.
TEST_F(SmallNative, ForkedProcessesCanTriangulate) {
  FixtureRandom random(16);
  const Coordinates points = reals(10000, random);
  const Triangulation expected = triangulate(on_host(), points, {0, 10000});
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    alarm(100);
    _exit(triangulate(on_host(), points, {0, 10000}).triangles == expected.triangles ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "status " << status;
}
#endif

TEST_F(SmallNative, IsNamedHostAndHasNoOpenCL) {
  const DeviceInfo info = on_host().device();
  EXPECT_EQ(info.name, "host");
  EXPECT_GE(info.compute_units, 1u);
  EXPECT_TRUE(info.self_test_passed);
  FixtureRandom random(17);
  const Coordinates points = reals(5000, random);
  EXPECT_EQ(triangulate(on_host(), points, {0, 5000}).statistics.device, "host");
  EXPECT_EQ(triangulate(free_to_choose(), points, {0, 100}).statistics.device, "host");
  EXPECT_GT(on_host().capacity(), 100'000u);
  const auto expect_refused = [](const char* what, const auto& call) {
    try {
      call();
      ADD_FAILURE() << what << ": no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::usage) << what;
      EXPECT_NE(std::string(error.what()).find("host"), std::string::npos) << error.what();
    }
  };
  expect_refused("context", [] { on_host().context(); });
  expect_refused("queue", [] { on_host().queue(); });
  expect_refused("workspace", [] { on_host().workspace_bytes(10); });
  expect_refused("device memory", [] {
    DeviceTriangulation result;
    on_host().triangulate(DevicePoints{}, result);
  });
}

TEST_F(SmallNative, KernelsCanBeTimed) {
  FixtureRandom random(18);
  const Coordinates points = reals(5000, random);
  Options options;
  options.profile = true;
  const Triangulation mesh = on_host().triangulate(points.data(), 5000, options);
  ASSERT_FALSE(mesh.statistics.kernels.empty());
  EXPECT_GT(mesh.statistics.kernels.front().seconds, 0);
  EXPECT_GT(mesh.statistics.kernel_launches, 10u);
}

TEST_F(SmallNative, ProgressComesToItsEnd) {
  for (const std::size_t n : {50, 5000}) {
    FixtureRandom random(19);
    const Coordinates points = reals(n, random);
    double last = -1;
    Options options;
    options.progress = [&](const std::string&, int, double done) {
      EXPECT_GE(done, last);
      last = done;
    };
    free_to_choose().triangulate(points.data(), n, options);
    EXPECT_EQ(last, 1);
  }
}

// With an empty cache, the device's kernels are compiled within the call, and its caller is told.
TEST_F(SmallNative, CompilingIsAnnounced) {
  if (device_under_test() == "host") GTEST_SKIP() << "the host's kernels are compiled with the library";
  const TemporaryFolder folder;
  const ScopedEnvironment cache("FLAUNAY_CACHE_DIR", folder.path().c_str());
  FixtureRandom random(20);
  const Coordinates points = reals(3000, random);
  for (const bool is_expected : {true, false}) {
    Triangulator fresh(device_under_test());
    bool is_announced = false;
    Options options;
    options.progress = [&](const std::string& stage, int, double) {
      is_announced = is_announced || stage == "compiling kernels";
    };
    fresh.triangulate(points.data(), 3000, options);
    if (is_expected || !std::filesystem::is_empty(folder.path())) {
      EXPECT_EQ(is_announced, is_expected);
    }
  }
}

// Whether an engine is made with the triangulator or in its first call.
TEST(SmallEnvironment, IsReadWhenATriangulatorIsMade) {
  FixtureRandom random(21);
  const Coordinates points = reals(3000, random);
  const std::string device = device_under_test();
  const ScopedEnvironment unnamed("FLAUNAY_DEVICE", nullptr), own("FLAUNAY_TUNING", nullptr);
  for (const std::string& name : {std::string(), std::string("host"), device}) {
    SCOPED_TRACE(name);
    const auto rows = [&](Triangulator& by) { return by.triangulate(points.data(), 3000).triangles; };
    Triangulator usual(name);
    std::unique_ptr<Triangulator> small;
    {
      const ScopedEnvironment tuning("FLAUNAY_TUNING", "block_points=50");
      small = std::make_unique<Triangulator>(name);
    }
    const ScopedEnvironment wrong("FLAUNAY_TUNING", "sideways");
    const std::vector<std::int32_t> expected = rows(usual), found = rows(*small);
    EXPECT_NE(found, expected) << "blocks decide on the order of rows";
    EXPECT_EQ(found.size(), expected.size());
    EXPECT_THROW(Triangulator{name}, Error);
  }
  // Also which device is opened later.
  Triangulator free;
  const ScopedEnvironment named("FLAUNAY_DEVICE", "no such device");
  research::Options options;
  options.mode = research::Mode::flattened;
  EXPECT_EQ(research::triangulate(free, points.data(), 3000, options).hull,
            free.triangulate(points.data(), 3000).hull);
}

}  // namespace
}  // namespace flaunay::testing
