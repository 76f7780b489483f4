// The memory that mode blocks is said to need, against what it takes.
#include "blocks/memory.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "blocks/run.hpp"
#include "tests/blocks/support.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/runtimes.hpp"

namespace flaunay::blocks {

using testing::make_fixture;

namespace {

// What a call takes of both arenas. The points are a copy, and results are in buffers of their own.
WorkspaceBytes taken(Runtime& runtime, const Coordinates& coordinates, const Offsets& offsets) {
  const std::size_t n = offsets.back();
  Arena persistent(runtime.memory()), results(runtime.memory());
  Arena& scratch = runtime.arena();
  const Arena::Scope scope(scratch);
  scratch.reset_peak();
  const auto points = [&] {
    const auto copy = scratch.allocate<cl_double>(2 * n);
    runtime.write(copy, 0, 2 * n, coordinates.data());
    return copy;
  };
  DeviceMesh mesh;
  for (auto* rows : {&mesh.triangles, &mesh.neighbors, &mesh.halfedges})
    *rows = results.allocate<cl_int>(6 * n);
  mesh.hull = results.allocate<cl_int>(n);
  const Options options;
  statistics::Phases phases(options);
  const auto outcome =
      run(runtime, persistent, offsets,
          {points, persistent.allocate<cl_int>(n), true, [&](const MeshSizes&) { return mesh; }}, phases);
  EXPECT_TRUE(static_cast<bool>(outcome)) << "points are too wide for fixed point";
  runtime.finish();
  return {persistent.peak_bytes(), scratch.peak_bytes()};
}

// Of which each next one can be multiplied by another power of two.
Coordinates scaled_by_set(Coordinates points, const Offsets& offsets) {
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    for (std::size_t i = 2 * offsets[s]; i < 2 * offsets[s + 1]; ++i) {
      points[i] = std::ldexp(points[i], s % 2 == 0 ? 400 : -400);
    }
  }
  return points;
}

// Sets of `size` points, and what is left.
Offsets sets_of(std::size_t n, std::size_t size, std::size_t sets) {
  Offsets offsets{0};
  for (std::size_t s = 1; s < sets; ++s) offsets.push_back(std::min(n, s * size));
  offsets.push_back(n);
  return offsets;
}

// Each kind of points and of sets takes at most what is said, and the worst of them not much less. least: the
// share of that in percent.
void check_bounds(Runtime& runtime, std::size_t n, std::size_t sets, std::size_t least) {
  SCOPED_TRACE(std::to_string(n) + " points in " + std::to_string(sets) + " sets");
  const WorkspaceBytes needed = workspace_bytes(runtime, n, sets);
  const std::size_t block = tuning_of(runtime).block_points;
  WorkspaceBytes most{};
  for (const Offsets& offsets :
       {sets_of(n, n / sets, sets), sets_of(n, block + 1, sets), sets_of(n, 0, sets)}) {
    for (const char* const name : {"uniform", "grid", "kuzmin", "circle", "equal", "scaled"}) {
      SCOPED_TRACE(std::string(name) + ", the first set has " + std::to_string(offsets[1]));
      const bool is_equal = name == std::string("equal"), is_scaled = name == std::string("scaled");
      Coordinates points =
          is_equal ? Coordinates(2 * n, 0.5) : make_fixture(is_scaled ? "uniform" : name, n, 7);
      if (runtime.capabilities().fixed_point) {
        for (double& c : points) c = std::nearbyint(c * 0x1p20) / 0x1p20;
      }
      if (is_scaled) points = scaled_by_set(points, offsets);
      const WorkspaceBytes found = taken(runtime, points, offsets);
      EXPECT_LE(found.persistent, needed.persistent);
      EXPECT_LE(found.scratch, needed.scratch);
      most = {std::max(most.persistent, found.persistent), std::max(most.scratch, found.scratch)};
    }
    if (sets == 1) break;
  }
  if (runtime.sizes().separate_buffers != 0) return;  // these are not counted
  EXPECT_GE(100 * most.persistent, least * needed.persistent);
  EXPECT_GE(100 * most.scratch, least * needed.scratch);
}

std::vector<std::string> tunings() {
  if (testing::tests_native()) return {"cpu", "small-blocks", "block_points=64,round_points=32"};
  return {"cpu", "small-blocks",       "fixed_point=1",
          "gpu", "gpu,round_points=0", "gpu,block_points=64,round_points=32"};
}

}  // namespace

/// Most is said in rounds, since of points that go on the most open edges are counted that can be.
TEST(Memory, NoCallTakesMoreThanIsSaid) {
  for (const std::string& tuning : tunings()) {
    SCOPED_TRACE(tuning);
    const auto runtime = testing::make_tuned_runtime(tuning);
    const std::size_t least = tuning_of(*runtime).round_points > 0 ? 55 : 75;
    check_bounds(*runtime, 1, 1, least);
    check_bounds(*runtime, 100, 1, least);
    check_bounds(*runtime, 100, 100, least);
    check_bounds(*runtime, 3000, 1, least);
    check_bounds(*runtime, 5000, 1, least);
    check_bounds(*runtime, 5000, 4, least);
    check_bounds(*runtime, 5000, 3000, least);
    // More sets than are counted one by one.
    check_bounds(*runtime, 5000, 20000, least);
  }
}

/// A bound for n points is one for fewer, so that memory for the largest call is enough for all.
TEST(Memory, FewerPointsNeedNoMore) {
  const auto runtime = testing::make_tuned_runtime("cpu");
  WorkspaceBytes before{};
  for (std::size_t n = 1; n < 3000000; n += n / 3 + 1) {
    const WorkspaceBytes needed = workspace_bytes(*runtime, n, 1);
    EXPECT_GE(needed.persistent, before.persistent) << n;
    EXPECT_GE(needed.scratch, before.scratch) << n;
    before = needed;
  }
}

/// Whatever the largest block may be.
TEST(Memory, GrowsWithThePoints) {
  for (const char* kind : {"cpu", "gpu"}) {
    const auto runtime = testing::make_tuned_runtime(kind);
    const WorkspaceBytes few = workspace_bytes(*runtime, 1000000, 1),
                         many = workspace_bytes(*runtime, 100000000, 1);
    EXPECT_LE(many.persistent, 110 * few.persistent) << kind;
    EXPECT_LE(many.scratch, 110 * few.scratch) << kind;
  }
}

}  // namespace flaunay::blocks
