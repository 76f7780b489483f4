// Calls on the host from several threads at once. The thread sanitizer watches them: see scripts/attack.sh.
#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "flaunay/chunks.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/flaunay.hpp"
#include "tests/constrained/nasty.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::testing {
namespace {

constexpr int kThreads = 8;

/// Runs the work on threads of their own, all at once.
void at_once(const std::function<void(int thread)>& work) {
  std::atomic<int> waiting{kThreads};
  std::vector<std::thread> threads;
  for (int t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      --waiting;
      while (waiting > 0) std::this_thread::yield();
      work(t);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

/// What is asked of a triangulator. Each result is a function of the input alone.
class Work {
 public:
  Work() : points_(make_fixture("uniform", kPoints, 5)), input_(nasty_detail::diameters(150, 1)) {
    constraints_.segments = input_.segments.data();
    constraints_.segment_count = input_.segments.size() / 2;
    options_.crossings = Crossings::split;
    options_.labels = true;
  }

  /// How many arrays are other than those of the first call.
  int run(Triangulator& triangulator) const {
    const Triangulation mesh = triangulator.triangulate(points_.data(), kPoints);
    const Triangulation few = triangulator.triangulate(points_.data(), {0, 100, 300});
    const ConstrainedTriangulation split =
        triangulator.constrained(input_.points.data(), {0, input_.points.size() / 2}, constraints_, options_);
    const Voronoi dual = triangulator.voronoi(points_.data(), kPoints, mesh);
    Locator locator(triangulator, points_.data(), kPoints, mesh);
    const Arrays found = {mesh.triangles,         few.triangles, split.triangles,
                          split.constraint_edges, dual.cells,    locator.nearest(points_.data(), kPoints)};
    const std::lock_guard lock(mutex_);
    if (expected_.empty()) expected_ = found;
    int wrong = 0;
    for (std::size_t k = 0; k < found.size(); ++k) wrong += found[k] != expected_[k];
    return wrong;
  }

 private:
  using Arrays = std::vector<std::vector<std::int32_t>>;
  static constexpr std::size_t kPoints = 7000;

  Coordinates points_;
  SegmentInput input_;
  Constraints constraints_;
  ConstrainedOptions options_;
  mutable std::mutex mutex_;
  mutable Arrays expected_;
};

class SmallCallsAtOnce : public ::testing::Test {
 private:
  ScopedEnvironment threads_{"FLAUNAY_THREADS", "3"};
};

TEST_F(SmallCallsAtOnce, OnTriangulatorsOfTheirOwn) {
  const Work work;
  std::atomic<int> wrong{0};
  at_once([&](int) {
    for (int round = 0; round < 5; ++round) {
      Triangulator own("host");
      wrong += work.run(own);
    }
  });
  EXPECT_EQ(wrong, 0);
}

// One of them gets its answer; the others are told that it is in use.
TEST_F(SmallCallsAtOnce, OnOneTriangulator) {
  const Work work;
  Triangulator shared("host");
  std::atomic<int> wrong{0}, done{0};
  at_once([&](int) {
    for (int round = 0; round < 30; ++round) {
      try {
        wrong += work.run(shared);
        ++done;
      } catch (const Error& error) {
        if (error.kind() != ErrorKind::usage) ++wrong;
        std::this_thread::yield();
      }
    }
  });
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(work.run(shared), 0);
}

TEST_F(SmallCallsAtOnce, InChunks) {
  const std::size_t n = 40000;
  const Coordinates points = make_fixture("clusters", n, 5);
  std::vector<std::int32_t> expected;
  for (const int callers : {1, 4}) {
    std::atomic<int> wrong{0};
    at_once([&](int t) {
      if (t >= callers) return;
      std::vector<std::int32_t> triangles(6 * n), neighbors(6 * n), hull(n), representatives(n);
      ChunkOptions options;
      options.devices = {"host", "host", "host"};
      options.memory_bytes = std::uint64_t{1} << 30;
      options.chunk_points = 5000;
      double last = 0;
      options.progress = [&last](const std::string&, int, double share) { last = share; };
      const MeshArrays<std::int32_t> results{triangles.data(), neighbors.data(), hull.data(),
                                             representatives.data()};
      triangles.resize(3 * triangulate_chunks(points.data(), n, results, options).triangles);
      if (callers == 1) expected = triangles;
      wrong += triangles != expected || last != 1;
    });
    EXPECT_EQ(wrong, 0);
  }
}

}  // namespace
}  // namespace flaunay::testing
