// The device interface as programs use it that have a context, queues and buffers of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <numeric>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "flaunay/constrained.hpp"
#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.hpp"
#include "flaunay/research.hpp"
#include "flaunay/result_arrays.hpp"
#include "tests/support/device.hpp"
#include "tests/support/embedded.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/opencl_calls.hpp"
#include "tests/support/reference.hpp"
#include "tests/support/same.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing {
namespace {

constexpr Parts kAll{true, true, true, true, true, true};
constexpr Parts kTriangles{true, false, false, false, false};

using Offsets = std::vector<std::size_t>;
constexpr std::size_t kAnyNumber = std::numeric_limits<std::size_t>::max();

// Modes that go level by level need double precision.
bool runs(research::Mode mode) {
  const bool goes_by_levels = mode == research::Mode::flattened || mode == research::Mode::recursive_device ||
                              mode == research::Mode::partition;
  return !goes_by_levels || triangulator().device().fp64;
}
DevicePoints points_in(const Memory& memory, std::size_t count) {
  DevicePoints points;
  points.memory = memory.get();
  points.count = count;
  return points;
}

Enqueue on(const Queue& queue) {
  Enqueue enqueue;
  enqueue.queue = queue.get();
  return enqueue;
}

Enqueue on_own() {
  Enqueue enqueue;
  enqueue.queue = embedder().queue();
  return enqueue;
}

Triangulation expected_of(const Coordinates& coordinates, const Offsets& offsets) {
  Options options;
  options.halfedges = options.areas = true;
  return triangulator().triangulate(coordinates.data(), offsets, options);
}

void expect_same(const DeviceTriangulation& result, const Triangulation& expected,
                 cl_command_queue queue = nullptr) {
  EXPECT_TRUE(same(result.triangle_offsets, expected.triangle_offsets));
  EXPECT_TRUE(same(result.hull_offsets, expected.hull_offsets));
  EXPECT_EQ(result.points, expected.representatives.size());
  for_each_array([&](const auto& array, std::size_t) {
    if (!(result.parts.*array.part)) return;
    const auto& values = expected.*array.values;
    const cl_mem memory = (result.*array.buffer).memory();
    using Element = typename std::decay_t<decltype(array)>::Element;
    EXPECT_TRUE(same(embedder().download<Element>(memory, values.size(), queue), values)) << array.name;
  });
}

void expect_usage_error(const std::vector<std::string>& parts, const std::function<void()>& work) {
  expect_error(ErrorKind::usage, parts, work);
}

std::vector<float> narrowed(const Coordinates& coordinates) {
  std::vector<float> narrow(coordinates.begin(), coordinates.end());
  // What underflows or overflows would make other input than is meant.
  for (float& x : narrow) x = std::isfinite(x) ? x : 0.0f;
  return narrow;
}

// Sets of sizes 0 to 40, and one larger than a block.
std::pair<Coordinates, Offsets> nested_sets() {
  Coordinates all;
  Offsets offsets{0};
  const char* const names[] = {"uniform", "grid", "collinear", "circle", "random-integers"};
  for (std::size_t s = 0; s < 30; ++s) {
    const std::size_t n = s == 17 ? 2500 : s * 7 % 41;
    const Coordinates one = make_fixture(names[s % 5], n, s);
    all.insert(all.end(), one.begin(), one.end());
    offsets.push_back(all.size() / 2);
  }
  return {all, offsets};
}

TEST(SmallEmbedding, ResultsAreThoseOfTheHostsInterface) {
  for (const char* const name : {"uniform", "grid", "collinear", "circle", "random-integers"}) {
    for (const std::size_t n : {1u, 2u, 3u, 40u}) {
      SCOPED_TRACE(name + std::to_string(n));
      const Coordinates coordinates = make_fixture(name, n, 3);
      const Memory memory = embedder().upload(coordinates);
      DeviceTriangulation result;
      embedded().triangulate(points_in(memory, n), result, kAll, on_own());
      expect_same(result, expected_of(coordinates, {0, n}));
    }
  }
}

TEST(Embedding, LargerResultsAreThoseOfTheHostsInterface) {
  for (const Fixture& fixture : all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    const Coordinates coordinates = fixture.make(5000, 8);
    const Memory memory = embedder().upload(coordinates);
    DeviceTriangulation result;
    embedded().triangulate(points_in(memory, coordinates.size() / 2), result, kAll, on_own());
    expect_same(result, expected_of(coordinates, {0, coordinates.size() / 2}));
  }
}

TEST(SmallEmbedding, PointsMayBeFloatsAndBeginAnywhere) {
  for (const std::size_t first : {0u, 1u, 13u}) {
    for (const std::size_t n : {0u, 5u, 60u}) {
      SCOPED_TRACE(std::to_string(first) + " " + std::to_string(n));
      // What precedes the points is not finite and must not matter.
      Coordinates coordinates(2 * first, std::nan(""));
      const Coordinates points = make_fixture("grid", n, 2);
      coordinates.insert(coordinates.end(), points.begin(), points.end());
      std::vector<float> narrow(coordinates.begin(), coordinates.end());
      const Memory wide_memory = embedder().upload(coordinates), narrow_memory = embedder().upload(narrow);
      const Triangulation expected = expected_of(points, {0, n});
      for (const Precision precision : {Precision::float64, Precision::float32}) {
        DevicePoints input = points_in(precision == Precision::float64 ? wide_memory : narrow_memory, n);
        input.precision = precision;
        input.first = first;
        DeviceTriangulation result;
        embedded().triangulate(input, result, kAll, on_own());
        expect_same(result, expected);
      }
    }
  }
}

TEST(SmallEmbedding, FloatsOfTheHostAreTheSameNumbers) {
  for (const research::Mode mode :
       {research::Mode::blocks, research::Mode::flattened, research::Mode::dwyer}) {
    if (!runs(mode)) continue;
    const std::vector<float> narrow = narrowed(make_fixture("uniform", 60, 9));
    const Coordinates wide(narrow.begin(), narrow.end());
    research::Options options;
    options.mode = mode;
    const Triangulation a = research::triangulate(triangulator(), narrow.data(), 60, options);
    const Triangulation b = research::triangulate(triangulator(), wide.data(), 60, options);
    EXPECT_TRUE(same(a.triangles, b.triangles));
    EXPECT_TRUE(same(a.neighbors, b.neighbors));
    const Triangulation c = research::triangulate(triangulator(), narrow.data(), Offsets{0, 20, 60}, options);
    EXPECT_EQ(c.triangle_offsets.size(), 3u);
  }
}

TEST(SmallEmbedding, HalfedgesOfEveryMode) {
  const Coordinates coordinates = make_fixture("uniform", 50, 4);
  for (const research::Mode mode :
       {research::Mode::blocks, research::Mode::flattened, research::Mode::recursive, research::Mode::dwyer,
        research::Mode::partition}) {
    if (!runs(mode)) continue;
    SCOPED_TRACE(to_string(mode));
    research::Options options;
    options.mode = mode;
    options.halfedges = options.areas = true;
    for (const bool neighbors : {false, true}) {
      options.neighbors = neighbors;
      const Triangulation result =
          research::triangulate(triangulator(), coordinates.data(), Offsets{0, 30, 50}, options);
      EXPECT_TRUE(same(result.halfedges, reference_halfedges(result.triangles)));
      EXPECT_TRUE(same(result.areas, reference_areas(coordinates, result.triangles)));
      EXPECT_EQ(result.neighbors.empty(), !neighbors);
    }
  }
}

TEST(SmallEmbedding, NestedSetsWithOffsetsFromEitherSide) {
  const auto [coordinates, offsets] = nested_sets();
  const Memory memory = embedder().upload(coordinates);
  const Triangulation expected = expected_of(coordinates, offsets);
  DevicePoints points = points_in(memory, offsets.back());
  points.offsets = offsets;
  DeviceTriangulation result;
  embedded().triangulate(points, result, kAll, on_own());
  expect_same(result, expected);
  EXPECT_EQ(result.point_offsets, offsets);

  points.offsets.clear();
  const Memory device_offsets = embedder().upload(std::vector<std::int32_t>(offsets.begin(), offsets.end()));
  points.device_offsets = device_offsets.get();
  points.sets = offsets.size() - 1;
  embedded().triangulate(points, result, kAll, on_own());
  expect_same(result, expected);
  EXPECT_EQ(result.point_offsets, offsets);
}

TEST(SmallEmbedding, OnlyWhatIsAskedForIsMade) {
  const Coordinates coordinates = make_fixture("uniform", 50, 5);
  const Memory memory = embedder().upload(coordinates);
  const Triangulation expected = expected_of(coordinates, {0, 50});
  std::size_t launches = std::numeric_limits<std::size_t>::max();
  for (const Parts& parts :
       {kAll, Parts{true, true, false, false, false}, Parts{true, false, true, false, false}, kTriangles,
        Parts{false, false, false, true, false}, Parts{false, false, false, false, true}}) {
    DeviceTriangulation result;
    embedded().triangulate(points_in(memory, 50), result, parts, on_own());
    for_each_array([&](const auto& array, std::size_t) {
      EXPECT_EQ((result.*array.buffer).memory() != nullptr, parts.*array.part) << array.name;
    });
    expect_same(result, expected);
    // In rounds, hulls are put in order by some launches of their own.
    const bool has_more = result.statistics.rounds > 0 && parts.hull;
    if (!has_more) {
      EXPECT_LE(result.statistics.kernel_launches, launches);
    }
    if (parts.triangles) launches = result.statistics.kernel_launches + 1;
  }
  DeviceTriangulation result;
  for (const Parts& parts : {Parts{false, true, false, false, false}, Parts{false, false, true, false, false},
                             Parts{false, false, false, false, false, true}}) {
    cl_event done = reinterpret_cast<cl_event>(8);
    Enqueue enqueue;
    enqueue.event = &done;
    expect_usage_error({"triangles"},
                       [&] { embedded().triangulate(points_in(memory, 50), result, parts, enqueue); });
    EXPECT_EQ(done, nullptr);
  }
}

TEST(SmallEmbedding, ResultsInTheCallersBuffers) {
  const std::size_t n = 40;
  const Coordinates coordinates = make_fixture("uniform", n, 6);
  const Memory memory = embedder().upload(coordinates);
  const Triangulation expected = expected_of(coordinates, {0, n});
  const std::vector<std::int32_t> blank(6 * n + 8, -99);
  std::vector<Memory> buffers;
  DeviceTriangulation result;
  for_each_array([&](const auto& array, std::size_t) {
    buffers.push_back(embedder().upload(blank));
    result.*array.buffer = DeviceBuffer(buffers.back().get());
  });
  embedded().triangulate(points_in(memory, n), result, kAll, on_own());
  expect_same(result, expected);
  for_each_array([&](const auto& array, std::size_t k) {
    const DeviceBuffer& buffer = result.*array.buffer;
    EXPECT_EQ(buffer.memory(), buffers[k].get());
    EXPECT_TRUE(buffer.is_callers());
    const auto& wanted = expected.*array.values;
    const auto values = embedder().download<std::int32_t>(buffers[k].get(), blank.size());
    for (std::size_t i = wanted.size() * sizeof wanted[0] / 4; i < values.size(); ++i) {
      ASSERT_EQ(values[i], -99) << array.name << " " << i;
    }
  });
  // A buffer of the caller is never replaced.
  for_each_array([&](const auto& array, std::size_t) {
    const std::size_t element = sizeof(typename std::decay_t<decltype(array)>::Element);
    const std::size_t bytes = most_rows(array.row, n) * array.columns * element;
    const Memory small = embedder().make_buffer(bytes - 1), enough = embedder().make_buffer(bytes);
    result.*array.buffer = DeviceBuffer(small.get());
    expect_usage_error({array.name, "too small", std::to_string(bytes - 1), std::to_string(bytes)},
                       [&] { embedded().triangulate(points_in(memory, n), result, kAll, on_own()); });
    result.*array.buffer = DeviceBuffer(enough.get());
    embedded().triangulate(points_in(memory, n), result, kAll, on_own());
    expect_same(result, expected);
  });
}

TEST(SmallEmbedding, QueuesInOrderAndNot) {
  const Coordinates coordinates = nested_sets().first;
  const Offsets offsets{0, coordinates.size() / 4, coordinates.size() / 2};
  const Memory memory = embedder().upload(coordinates);
  const Triangulation expected = expected_of(coordinates, offsets);
  DevicePoints points = points_in(memory, offsets.back());
  points.offsets = offsets;
  const Queue unordered = embedder().make_queue(CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
  const Queue ordered = embedder().make_queue();
  DeviceTriangulation result;
  // One buffer on one queue after the other, without waiting in between.
  for (int k = 0; k < 6; ++k) {
    const Queue& queue = k % 2 == 0 ? unordered : ordered;
    cl_event done = nullptr;
    Enqueue enqueue = on(queue);
    enqueue.event = &done;
    embedded().triangulate(points, result, kAll, enqueue);
    if (k < 3) continue;
    ASSERT_NE(done, nullptr);
    check(clWaitForEvents(1, &done), "clWaitForEvents");
    expect_same(result, expected);
    clReleaseEvent(done);
  }
  embedded().triangulate(points, result, kAll);  // its own queue
  expect_same(result, expected, embedded().queue());
}

TEST(Embedding, WaitsForEventsAndEndsWithOne) {
  const std::size_t n = 3000;
  const Coordinates coordinates = make_fixture("uniform", n, 7);
  const Memory memory = embedder().make_buffer(16 * n);
  cl_int code = CL_SUCCESS;
  const cl_event ready = clCreateUserEvent(embedder().context(), &code);
  check(code, "clCreateUserEvent");
  const Queue other = embedder().make_queue();
  std::thread writer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    clEnqueueWriteBuffer(other.get(), memory.get(), CL_TRUE, 0, 16 * n, coordinates.data(), 0, nullptr,
                         nullptr);
    clSetUserEventStatus(ready, CL_COMPLETE);
  });
  cl_event done = nullptr;
  Enqueue enqueue = on_own();
  enqueue.wait_for = {ready};
  enqueue.event = &done;
  DeviceTriangulation result;
  embedded().triangulate(points_in(memory, n), result, kAll, enqueue);
  writer.join();
  clReleaseEvent(ready);
  ASSERT_NE(done, nullptr);
  check(clWaitForEvents(1, &done), "clWaitForEvents");
  cl_int status = -1;
  clGetEventInfo(done, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr);
  EXPECT_EQ(status, CL_COMPLETE);
  clReleaseEvent(done);
  expect_same(result, expected_of(coordinates, {0, n}));
}

TEST(SmallEmbedding, NoPointsAreNoError) {
  DeviceTriangulation result;
  cl_event done = nullptr;
  Enqueue enqueue = on_own();
  enqueue.event = &done;
  embedded().triangulate(DevicePoints(), result, kAll, enqueue);
  ASSERT_NE(done, nullptr);
  check(clWaitForEvents(1, &done), "clWaitForEvents");
  clReleaseEvent(done);
  EXPECT_EQ(result.triangle_offsets, (Offsets{0, 0}));
  EXPECT_EQ(result.hull_offsets, (Offsets{0, 0}));
  EXPECT_EQ(result.points, 0u);
  DevicePoints no_sets;
  no_sets.offsets = {0};
  embedded().triangulate(no_sets, result, kAll, on_own());
  EXPECT_EQ(result.triangle_offsets, (Offsets{0}));
}

// Arrays of a GPU are buffers that are used again: other points may want some of other sizes.
constexpr std::size_t kNewBuffersOfGpu = 8;

TEST(Embedding, AGpusSizesNeedLittleMoreMemoryTheSecondTime) {
  const ScopedEnvironment gpu("FLAUNAY_TUNING", "gpu");
  const std::size_t n = 30000;
  Triangulator fresh(embedder().context(), embedder().device());
  DeviceTriangulation result;
  fresh.triangulate(points_in(embedder().upload(make_fixture("uniform", n, 10)), n), result, kAll, on_own());
  for (const Coordinates& other :
       {make_fixture("uniform", n, 12), make_fixture("grid", n, 13), Coordinates(2 * n, 0.5)}) {
    const Memory memory = embedder().upload(other);
    opencl_calls().reset();
    fresh.triangulate(points_in(memory, n), result, kAll, on_own());
    EXPECT_LE(opencl_calls().buffers, kNewBuffersOfGpu);
    check(clFinish(embedder().queue()), "clFinish");
  }
}

TEST(SmallEmbedding, AProfiledCallKeepsTheOrderOfTheOwnQueue) {
  const std::size_t n = 500;
  const Coordinates old_points = make_fixture("uniform", n, 1), new_points = make_fixture("uniform", n, 2);
  Triangulator own(embedder().context(), embedder().device());
  const Memory memory = embedder().upload(old_points);
  Enqueue profiled;
  profiled.profile = true;
  DeviceTriangulation result;
  own.triangulate(points_in(memory, n), result, kAll, profiled);
  // What the owner of the queue enqueues there comes first.
  check(clEnqueueWriteBuffer(own.queue(), memory.get(), CL_FALSE, 0, 16 * n, new_points.data(), 0, nullptr,
                             nullptr),
        "clEnqueueWriteBuffer");
  own.triangulate(points_in(memory, n), result, kAll, profiled);
  expect_same(result, expected_of(new_points, {0, n}), own.queue());
  DeviceVoronoi dual;
  own.voronoi(points_in(memory, n), result, dual, profiled);
  const Voronoi expected = own.voronoi(new_points.data(), n, expected_of(new_points, {0, n}));
  EXPECT_TRUE(same(embedder().download<std::int32_t>(dual.cells.memory(), expected.cells.size(), own.queue()),
                   expected.cells));
}

TEST(SmallEmbedding, DestroyingWaitsForWhatWasEnqueued) {
  const Coordinates coordinates = make_fixture("uniform", 500, 1);
  const Memory memory = embedder().upload(coordinates);
  const Queue queue = embedder().make_queue();
  cl_event done = nullptr;
  Enqueue enqueue = on(queue);
  enqueue.event = &done;
  DeviceTriangulation result;
  std::unique_ptr<Locator> locator;
  {
    Triangulator passing(embedder().context(), embedder().device());
    passing.triangulate(points_in(memory, 500), result, kAll, on(queue));
    locator = std::make_unique<Locator>(passing, points_in(memory, 500), result, on(queue));
    passing.triangulate(points_in(memory, 500), result, kAll, enqueue);
  }
  cl_int status = -1;
  clGetEventInfo(done, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, nullptr);
  EXPECT_EQ(status, CL_COMPLETE);
  clReleaseEvent(done);
  EXPECT_EQ(locator->locate(coordinates.data(), 500).size(), 500u);
}

// What docs/embedding.md says. merging: without rounds.
void expect_documented_waits(const Statistics& statistics, std::size_t merging) {
  if (statistics.rounds == 0) {
    EXPECT_EQ(statistics.host_waits, merging);
  } else {
    EXPECT_GE(statistics.host_waits, 1 + statistics.rounds);
    EXPECT_LE(statistics.host_waits, 3 + statistics.rounds);
  }
}

// Counted where the calls are made, and by flaunay itself.
TEST(Embedding, ASecondCallAllocatesNothingAndOnlySizesCross) {
  const std::size_t n = 100000;
  const Memory first = embedder().upload(make_fixture("uniform", n, 10));
  const Memory second = embedder().upload(make_fixture("grid", n, 11));
  Triangulator fresh(embedder().context(), embedder().device());
  DeviceTriangulation result;
  OpenclCalls& calls = opencl_calls();
  calls.reset();
  fresh.triangulate(points_in(first, n), result, kAll, on_own());
  EXPECT_GT(calls.buffers, 0u);
  EXPECT_EQ(calls.buffers, result.statistics.device_allocations);
  const std::size_t most_new = result.statistics.rounds > 0 ? kNewBuffersOfGpu : 0;
  for (const Memory& memory : {first, second, first}) {
    calls.reset();
    fresh.triangulate(points_in(memory, n), result, kAll, on_own());
    EXPECT_LE(calls.buffers, most_new);
    EXPECT_EQ(result.statistics.device_allocations, calls.buffers);
    EXPECT_EQ(calls.bytes_to_host, result.statistics.bytes_to_host);
    EXPECT_EQ(calls.bytes_to_device, result.statistics.bytes_to_device);
    EXPECT_EQ(calls.waits, result.statistics.host_waits);
    // Some numbers for each of the 64 blocks: the points alone are 1,600,000 bytes.
    EXPECT_LE(calls.bytes_to_host + calls.bytes_to_device, 64u * 200);
    expect_documented_waits(result.statistics, 5);
  }
  fresh.triangulate(points_in(first, 1000), result, kAll, on_own());
  expect_documented_waits(result.statistics, 4);
  // Nor do points that need more of it: others at random, or all in one block; nor fewer.
  for (const Coordinates& other :
       {make_fixture("uniform", n, 12), make_fixture("line", n, 13), Coordinates(2 * n, 0.5)}) {
    const Memory memory = embedder().upload(other);
    calls.reset();
    fresh.triangulate(points_in(memory, n), result, kAll, on_own());
    EXPECT_LE(calls.buffers, most_new);
  }
  calls.reset();
  fresh.triangulate(points_in(first, n / 3), result, kTriangles, on_own());
  EXPECT_LE(calls.buffers, 4 * most_new);
}

TEST(Embedding, WorksInTheCallersWorkspace) {
  Triangulator fresh(embedder().context(), embedder().device());
  const Queue queue = embedder().make_queue();
  // The worst that a size can need: all points in one block; a tree for each set; no duplicates at all;
  // rounds that end with a merge.
  const std::vector<std::pair<Coordinates, Offsets>> inputs = {
      {make_fixture("uniform", 20000, 1), {0, 20000}},
      {make_fixture("circle", 20000, 1), {0, 20000}},
      {Coordinates(40000, 0.25), {0, 20000}},
      {make_fixture("grid", 20000, 2), {0, 3000, 6000, 6000, 9000, 20000}},
      {make_fixture("collinear", 3000, 2), {0, 1, 1, 1, 2, 3000}},
      nested_sets(),
      {make_fixture("uniform", 1, 2), {0, 1}}};
  for (const auto& [coordinates, offsets] : inputs) {
    const std::size_t n = offsets.back(), sets = offsets.size() - 1;
    SCOPED_TRACE(std::to_string(n) + " points in " + std::to_string(sets));
    const std::size_t bytes = fresh.workspace_bytes(n, sets);
    const Memory workspace = embedder().make_buffer(bytes), too_small = embedder().make_buffer(bytes - 1);
    const std::vector<float> narrow = narrowed(coordinates);
    const Memory memory = embedder().upload(narrow);  // which needs a copy as well
    DevicePoints points = points_in(memory, n);
    points.precision = Precision::float32;
    points.offsets = offsets;
    DeviceTriangulation result;
    fresh.use_workspace(too_small.get());
    expect_usage_error({"workspace", "too small", std::to_string(bytes)},
                       [&] { fresh.triangulate(points, result, kTriangles, on(queue)); });
    fresh.use_workspace(workspace.get());
    fresh.triangulate(points, result, kAll, on(queue));
    opencl_calls().reset();
    fresh.triangulate(points, result, kAll, on(queue));
    EXPECT_EQ(opencl_calls().buffers, 0u);
    check(clFinish(queue.get()), "clFinish");
    expect_same(result, expected_of(Coordinates(narrow.begin(), narrow.end()), offsets));
  }
  fresh.use_workspace(nullptr);
  const Coordinates coordinates = make_fixture("uniform", 100, 1);
  EXPECT_EQ(fresh.triangulate(coordinates.data(), 100).triangles,
            expected_of(coordinates, {0, 100}).triangles);
}

TEST(SmallEmbedding, TheWorkspaceIsABufferOfTheContext) {
  Triangulator& t = embedded();
  Embedder stranger(embedder().device());
  const Memory foreign = stranger.make_buffer(1 << 20);
  expect_usage_error({"workspace", "context"}, [&] { t.use_workspace(foreign.get()); });
  const Memory read_only = embedder().make_buffer(1 << 20, CL_MEM_READ_ONLY);
  expect_usage_error({"workspace", "CL_MEM_READ_ONLY"}, [&] { t.use_workspace(read_only.get()); });
  for (const cl_mem_flags flags : {CL_MEM_HOST_NO_ACCESS, CL_MEM_HOST_READ_ONLY, CL_MEM_WRITE_ONLY}) {
    const Memory closed = embedder().make_buffer(1 << 20, flags);
    expect_usage_error({"workspace", "CL_MEM_HOST_"}, [&] { t.use_workspace(closed.get()); });
  }
  const Memory whole = embedder().make_buffer(1 << 20);
  const cl_buffer_region region{0, 1 << 19};
  cl_int code = CL_SUCCESS;
  const Memory part(
      clCreateSubBuffer(whole.get(), CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region, &code),
      clReleaseMemObject);
  check(code, "clCreateSubBuffer");
  expect_usage_error({"workspace", "sub-buffer"}, [&] { t.use_workspace(part.get()); });
}

TEST(Embedding, TwoThreadsInOneContext) {
  const std::size_t n = 4000;
  const auto work = [&](std::uint64_t seed) {
    Triangulator own(embedder().context(), embedder().device());
    const Queue queue = embedder().make_queue();
    const Coordinates coordinates = make_fixture("uniform", n, seed);
    const Memory memory = embedder().make_buffer(16 * n);
    DeviceTriangulation result;
    std::vector<std::vector<std::int32_t>> seen;
    for (int k = 0; k < 10; ++k) {
      clEnqueueWriteBuffer(queue.get(), memory.get(), CL_FALSE, 0, 16 * n, coordinates.data(), 0, nullptr,
                           nullptr);
      own.triangulate(points_in(memory, n), result, kAll, on(queue));
      seen.push_back(embedder().download<std::int32_t>(result.neighbors.memory(),
                                                       3 * result.statistics.triangles, queue.get()));
    }
    return seen;
  };
  std::vector<std::vector<std::int32_t>> other;
  std::thread thread([&] { other = work(21); });
  const auto mine = work(22);
  thread.join();
  for (const auto& [all, seed] : {std::pair(mine, 22), std::pair(other, 21)}) {
    const Triangulation expected = expected_of(make_fixture("uniform", n, seed), {0, n});
    ASSERT_EQ(all.size(), 10u);
    for (const auto& neighbors : all) EXPECT_TRUE(same(neighbors, expected.neighbors));
  }
}

const Coordinates kTriangle = {0, 0, 1, 0, 0, 1};

/// Every call that uses a triangulator's memory or queue, by name.
std::vector<std::pair<std::string, std::function<void()>>> calls_on(
    Triangulator& t, Locator& locator, const Coordinates& xy, const Triangulation& mesh, const Memory& memory,
    DeviceTriangulation& on_device, const Enqueue& enqueue) {
  const std::size_t n = xy.size() / 2;
  const auto buffer = std::make_shared<DeviceBuffer>();
  const auto dual = std::make_shared<DeviceVoronoi>();
  const auto clipped = std::make_shared<DeviceClippedVoronoi>();
  const auto relaxed = std::make_shared<DeviceBuffer>();
  const auto periodic = std::make_shared<DeviceTriangulation>();
  const auto weighted = std::make_shared<DeviceTriangulation>();
  const Memory weights = embedder().upload(std::vector<double>(n));
  const auto narrow = std::make_shared<std::vector<float>>(xy.begin(), xy.end());
  const DevicePoints points = points_in(memory, n);
  DevicePoints on_torus = points;
  on_torus.space = Space::torus({});
  return {
      {"triangulate", [=, &t, &xy] { t.triangulate(xy.data(), n); }},
      {"triangulate float", [=, &t] { t.triangulate(narrow->data(), n); }},
      {"triangulate on device",
       [=, &t, &on_device, &enqueue] { t.triangulate(points, on_device, kAll, enqueue); }},
      {"use_workspace", [&t] { t.use_workspace(nullptr); }},
      {"voronoi", [=, &t, &xy, &mesh] { t.voronoi(xy.data(), n, mesh); }},
      {"clipped voronoi",
       [=, &t, &xy, &mesh] {
         t.clipped_voronoi(xy.data(), n, mesh, kTriangle.data(), kTriangle.size() / 2);
       }},
      {"clipped voronoi on device",
       [=, &t, &on_device, &enqueue] {
         t.clipped_voronoi(points, on_device, kTriangle.data(), kTriangle.size() / 2, *clipped, enqueue);
       }},
      {"relax", [=, &t, &xy] { t.relax(xy.data(), n, kTriangle.data(), kTriangle.size() / 2); }},
      {"relax on device",
       [=, &t, &enqueue] { t.relax(points, kTriangle.data(), kTriangle.size() / 2, 1, *relaxed, enqueue); }},
      {"voronoi on device", [=, &t, &on_device, &enqueue] { t.voronoi(points, on_device, *dual, enqueue); }},
      {"periodic on device", [=, &t, &enqueue] { t.triangulate(on_torus, *periodic, kAll, enqueue); }},
      {"weighted on device",
       [=, &t, &enqueue] {
         DevicePoints given = points;
         given.weights = weights.get();
         t.triangulate(given, *weighted, triangles_alone(), enqueue);
       }},
      {"locator", [=, &t, &xy, &mesh] { Locator(t, xy.data(), n, mesh); }},
      {"locator on device", [=, &t, &on_device, &enqueue] { Locator(t, points, on_device, enqueue); }},
      {"locate", [=, &locator, &xy] { locator.locate(xy.data(), n); }},
      {"nearest", [=, &locator, &xy] { locator.nearest(xy.data(), n); }},
      {"interpolate", [=, &locator, &xy] { locator.interpolate(xy.data(), xy.data(), n); }},
      {"gradients", [=, &locator, &xy] { locator.gradients(xy.data()); }},
      {"locate on device", [=, &locator, &enqueue] { locator.locate(points, *buffer, enqueue); }},
      {"nearest on device", [=, &locator, &enqueue] { locator.nearest(points, *buffer, enqueue); }},
      {"research",
       [=, &t, &xy] {
         research::Options options;
         options.mode = research::Mode::flattened;
         research::triangulate(t, xy.data(), n, options);
       }},
      {"partition", [=, &t, &xy] { research::partition(t, xy.data(), n, 2); }},
  };
}

/// A triangulator does one call at a time: a call that another thread makes meanwhile, or the callback of the
/// running one, is an error, and the running one goes on.
TEST(SmallEmbedding, ACallDuringAnotherIsAUsageError) {
  const Coordinates xy = make_fixture("uniform", 300, 8);
  const Triangulation mesh = embedded().triangulate(xy.data(), 300);
  const Memory memory = embedder().upload(xy);
  DeviceTriangulation on_device;
  embedded().triangulate(points_in(memory, 300), on_device, kAll, on_own());
  Locator locator(embedded(), xy.data(), 300, mesh);
  cl_event done = nullptr;
  Enqueue enqueue = on_own();
  enqueue.event = &done;
  const auto calls = calls_on(embedded(), locator, xy, mesh, memory, on_device, enqueue);
  std::size_t refused = 0;
  const auto try_all = [&] {
    for (const auto& [name, call] : calls) {
      SCOPED_TRACE(name);
      done = reinterpret_cast<cl_event>(&refused);  // what an event is before the call
      expect_usage_error({"in use", "for each thread"}, call);
      const bool has_event = name.find("on device") != std::string::npos;
      EXPECT_EQ(done == nullptr, has_event);
      ++refused;
    }
  };
  Options options;
  bool is_first = true;
  options.progress = [&](const std::string&, int, double) {
    if (!std::exchange(is_first, false)) return;
    std::thread(try_all).join();
    try_all();
    // These only read what never changes.
    EXPECT_GT(embedded().workspace_bytes(100), 0u);
    EXPECT_FALSE(embedded().device().name.empty());
  };
  const Triangulation again = embedded().triangulate(xy.data(), 300, options);
  EXPECT_EQ(refused, 2 * calls.size());
  EXPECT_TRUE(same(again.triangles, mesh.triangles));
  for (const auto& [name, call] : calls) {
    SCOPED_TRACE(name);
    if ((name == "research" || name == "partition") && !runs(research::Mode::partition)) continue;
    EXPECT_NO_THROW(call());
    if (name.find("on device") != std::string::npos) clReleaseEvent(done);
  }
}

/// Whatever happens to be done at the same time: a result, or that error.
TEST(Embedding, ThreadsThatShareATriangulatorGetResultsOrErrors) {
  const Coordinates xy = make_fixture("uniform", 500, 9);
  const Triangulation expected = expected_of(xy, {0, 500});
  const Triangulation mesh = embedded().triangulate(xy.data(), 500);
  Locator locator(embedded(), xy.data(), 500, mesh);
  const auto work = [&] {
    for (int k = 0; k < 200; ++k) {
      try {
        EXPECT_TRUE(same(embedded().triangulate(xy.data(), 500).triangles, expected.triangles));
        EXPECT_EQ(locator.nearest(xy.data(), 500)[499], 499);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage) << error.what();
      }
    }
  };
  std::vector<std::thread> threads;
  for (int k = 0; k < 3; ++k) threads.emplace_back(work);
  for (std::thread& thread : threads) thread.join();
}

TEST(SmallEmbedding, MovesWithItsContext) {
  const Coordinates coordinates = make_fixture("uniform", 30, 5);
  const Memory memory = embedder().upload(coordinates);
  DeviceTriangulation result;
  Triangulator first(embedder().context(), embedder().device());
  Triangulator second(std::move(first));
  EXPECT_EQ(second.context(), embedder().context());
  EXPECT_EQ(second.device_id(), embedder().device());
  second.triangulate(points_in(memory, 30), result, kAll, on_own());
  expect_same(result, expected_of(coordinates, {0, 30}));
  first = std::move(second);
  first.triangulate(points_in(memory, 30), result, kAll, on_own());
  expect_same(result, expected_of(coordinates, {0, 30}));
}

TEST(SmallEmbedding, ResultsOutliveTheTriangulator) {
  const Coordinates coordinates = make_fixture("uniform", 30, 5);
  const Memory memory = embedder().upload(coordinates);
  DeviceTriangulation result;
  {
    Triangulator passing(embedder().context(), embedder().device());
    passing.triangulate(points_in(memory, 30), result, kAll, on_own());
  }
  expect_same(result, expected_of(coordinates, {0, 30}));
}

/// Whether q lies in the triangle, on its border or in it.
bool contains(const Coordinates& points, const std::int32_t* corners, const double* q) {
  for (int k = 0; k < 3; ++k) {
    if (reference_orient2d(&points[2 * corners[k]], &points[2 * corners[(k + 1) % 3]], q) < 0) return false;
  }
  return true;
}

std::int32_t located(const Coordinates& points, const Triangulation& mesh, std::size_t set, const double* q) {
  for (std::size_t t = mesh.triangle_offsets[set]; t < mesh.triangle_offsets[set + 1]; ++t) {
    if (contains(points, &mesh.triangles[3 * t], q)) return static_cast<std::int32_t>(t);
  }
  return -1;
}

/// Of small integers, whose squares are exact.
std::int32_t nearest(const Coordinates& points, const Triangulation& mesh, std::size_t first,
                     std::size_t last, const double* q) {
  const auto key = [&](std::size_t i) {
    const double x = points[2 * i], y = points[2 * i + 1];
    return std::array<double, 3>{(x - q[0]) * (x - q[0]) + (y - q[1]) * (y - q[1]), x, y};
  };
  std::int32_t best = -1;
  for (std::size_t i = first; i < last; ++i) {
    if (best < 0 || key(i) < key(best)) best = mesh.representatives[i];
  }
  return best;
}

// Sets of small integers, one of them empty and one on a line, and as many queries on and beside them.
struct Queried {
  Coordinates points, queries, values;
  Offsets offsets{0}, query_offsets{0};

  Queried() {
    const char* const names[] = {"random-integers", "grid", "uniform", "grid"};
    const std::size_t sizes[] = {40, 49, 0, 30}, query_sizes[] = {30, 0, 5, 60};
    FixtureRandom random(5);
    for (int s = 0; s < 4; ++s) {
      Coordinates one = make_fixture(names[s], sizes[s], 3);
      points.insert(points.end(), one.begin(), one.end());
      offsets.push_back(points.size() / 2);
      for (std::size_t k = 0; k < 2 * query_sizes[s]; ++k) {
        queries.push_back(static_cast<double>(random.integer(-2, 12)) / 2);
      }
      query_offsets.push_back(queries.size() / 2);
    }
    for (std::size_t i = 0; i < points.size() / 2; ++i)
      values.push_back(3 * points[2 * i] - 2 * points[2 * i + 1]);
  }

  /// Two sets at the same places, whose Voronoi cells have to be mended.
  void add_turned_lattices() {
    for (int step = 1; step <= 2; ++step) {
      for (int i = 0; i < 36; i += step)
        points.insert(points.end(), {0.3 * (i / 6) - 0.1 * (i % 6), 0.1 * (i / 6) + 0.3 * (i % 6)});
      offsets.push_back(points.size() / 2);
    }
  }

  std::size_t set_of(std::size_t query) const {
    return std::upper_bound(query_offsets.begin(), query_offsets.end(), query) - query_offsets.begin() - 1;
  }
};

void expect_answers(const Queried& q, const Triangulation& mesh, const std::vector<std::int32_t>& triangles,
                    const std::vector<std::int32_t>& points, const std::vector<double>& values) {
  const std::size_t m = q.queries.size() / 2;
  ASSERT_EQ(triangles.size(), m);
  ASSERT_EQ(points.size(), m);
  ASSERT_EQ(values.size(), m);
  std::size_t inside = 0;
  for (std::size_t i = 0; i < m; ++i) {
    const std::size_t s = q.set_of(i);
    const double* const query = &q.queries[2 * i];
    ASSERT_EQ(triangles[i], located(q.points, mesh, s, query)) << i;
    ASSERT_EQ(points[i], nearest(q.points, mesh, q.offsets[s], q.offsets[s + 1], query)) << i;
    if (triangles[i] < 0) {
      ASSERT_TRUE(std::isnan(values[i])) << i;
    } else {
      ASSERT_NEAR(values[i], 3 * query[0] - 2 * query[1], 1e-9) << i;
      ++inside;
    }
  }
  EXPECT_GT(inside, 0u);
  EXPECT_LT(inside, m);
}

TEST(SmallLocator, AnswersOfTheHostsInterface) {
  const Queried q;
  const Triangulation mesh = expected_of(q.points, q.offsets);
  Locator original(triangulator(), q.points.data(), q.offsets, mesh);
  Locator locator(std::move(original));
  expect_answers(q, mesh, locator.locate(q.queries.data(), q.query_offsets),
                 locator.nearest(q.queries.data(), q.query_offsets),
                 locator.interpolate(q.values.data(), q.queries.data(), q.query_offsets));
}

TEST(SmallLocator, AnswersInDeviceMemory) {
  const Queried q;
  const Triangulation expected = expected_of(q.points, q.offsets);
  const Memory points_memory = embedder().upload(q.points), values = embedder().upload(q.values);
  DevicePoints points = points_in(points_memory, q.offsets.back());
  points.offsets = q.offsets;
  const Queue unordered = embedder().make_queue(CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
  DeviceTriangulation mesh;
  embedded().triangulate(points, mesh, kAll, on(unordered));
  Locator locator(embedded(), points, mesh, on(unordered));
  const std::size_t m = q.query_offsets.back();
  for (const Precision precision : {Precision::float64, Precision::float32}) {
    const Memory memory = precision == Precision::float64
                              ? embedder().upload(q.queries)
                              : embedder().upload(std::vector<float>(q.queries.begin(), q.queries.end()));
    DevicePoints queries = points_in(memory, m);
    queries.precision = precision;
    queries.offsets = q.query_offsets;
    DeviceBuffer triangles, nearest_points, results;
    locator.locate(queries, triangles, on(unordered));
    locator.nearest(queries, nearest_points, on(unordered));
    locator.interpolate(values.get(), queries, results, on(unordered));
    check(clFinish(unordered.get()), "clFinish");
    expect_answers(q, expected, embedder().download<std::int32_t>(triangles.memory(), m),
                   embedder().download<std::int32_t>(nearest_points.memory(), m),
                   embedder().download<double>(results.memory(), m));
  }
}

/// By every method, from host and from device memory, with gradients that are given and not: the same bytes.
TEST(SmallLocator, InterpolatesInBothMemories) {
  const Queried q;
  const std::size_t n = q.offsets.back(), m = q.query_offsets.back();
  Coordinates rows(3 * n);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = q.values[i / 3] * static_cast<double>(1 + i % 3);
  Locator on_host(triangulator(), q.points.data(), q.offsets, expected_of(q.points, q.offsets));
  const Memory memory = embedder().upload(q.points), values = embedder().upload(rows),
               query_memory = embedder().upload(q.queries);
  DevicePoints points = points_in(memory, n), queries = points_in(query_memory, m);
  points.offsets = q.offsets;
  queries.offsets = q.query_offsets;
  DeviceTriangulation mesh;
  embedded().triangulate(points, mesh, kAll);
  Locator on_device(embedded(), points, mesh);
  InterpolationOptions options;
  options.columns = 3;
  options.fill = -5;
  const std::vector<double> gradients = on_host.gradients(rows.data(), 3);
  DeviceBuffer device_gradients, results;
  on_device.gradients(values.get(), device_gradients, 3);
  check(clFinish(embedded().queue()), "clFinish");
  const auto bytes = [](const std::vector<double>& numbers) {
    return std::string(reinterpret_cast<const char*>(numbers.data()), sizeof(double) * numbers.size());
  };
  EXPECT_EQ(bytes(gradients), bytes(embedder().download<double>(device_gradients.memory(), 6 * n)));
  for (const auto method : {Interpolation::linear, Interpolation::nearest, Interpolation::clough_tocher}) {
    options.method = method;
    options.gradients = nullptr;
    options.device_gradients = nullptr;
    const auto expected = on_host.interpolate(rows.data(), q.queries.data(), q.query_offsets, options);
    ASSERT_EQ(expected.size(), 3 * m);
    for (const bool are_given : {false, true}) {
      options.gradients = are_given ? gradients.data() : nullptr;
      options.device_gradients = nullptr;
      EXPECT_EQ(bytes(on_host.interpolate(rows.data(), q.queries.data(), q.query_offsets, options)),
                bytes(expected));
      options.gradients = nullptr;
      options.device_gradients = are_given ? device_gradients.memory() : nullptr;
      on_device.interpolate(values.get(), queries, results, options);
      check(clFinish(embedded().queue()), "clFinish");
      EXPECT_EQ(bytes(embedder().download<double>(results.memory(), 3 * m)), bytes(expected));
    }
  }
  options.columns = 0;
  expect_usage_error({"columns"},
                     [&] { on_host.interpolate(rows.data(), q.queries.data(), q.query_offsets, options); });
  expect_usage_error({"columns"}, [&] { on_host.gradients(rows.data(), 0); });
  options.columns = 3;
  options.gradients = gradients.data();
  expect_usage_error({"host memory"},
                     [&] { on_device.interpolate(values.get(), queries, results, options); });
  options.device_gradients = device_gradients.memory();
  expect_usage_error({"device memory"},
                     [&] { on_host.interpolate(rows.data(), q.queries.data(), q.query_offsets, options); });
}

TEST(SmallLocator, OutlivesItsTriangulator) {
  const Coordinates points{0, 0, 4, 0, 0, 4};
  const Triangulation mesh = expected_of(points, {0, 3});
  const Locator locator = [&] {
    Triangulator passing;
    return Locator(passing, points.data(), 3, mesh);
  }();
  const Coordinates queries{1, 1, 4, 4};
  EXPECT_EQ(const_cast<Locator&>(locator).locate(queries.data(), 2), (std::vector<std::int32_t>{0, -1}));
}

TEST(SmallLocator, BadUseIsAnError) {
  const Coordinates points = make_fixture("uniform", 30, 5);
  Triangulation mesh = expected_of(points, {0, 30});
  Locator locator(triangulator(), points.data(), 30, mesh);
  const double* const nothing = nullptr;
  expect_usage_error({"3 queries", "NULL"}, [&] { locator.locate(nothing, 3); });
  EXPECT_TRUE(locator.locate(nothing, 0).empty());
  expect_usage_error({"sets"}, [&] { locator.locate(points.data(), {0, 1, 2}); });
  expect_usage_error({"values", "NULL"}, [&] { locator.interpolate(nothing, points.data(), 3); });
  expect_error(ErrorKind::input, {"query 1", "not finite"}, [&] {
    const Coordinates wrong{0, 0, std::nan(""), 0};
    locator.nearest(wrong.data(), 2);
  });
  expect_usage_error({"another number of points"}, [&] { Locator(triangulator(), points.data(), 29, mesh); });
  expect_usage_error({"sets"}, [&] { Locator(triangulator(), points.data(), Offsets{0, 5, 30}, mesh); });
  mesh.neighbors.clear();
  expect_usage_error({"no neighbours"}, [&] { Locator(triangulator(), points.data(), 30, mesh); });

  const Memory memory = embedder().upload(points);
  DeviceTriangulation on_device;
  embedded().triangulate(points_in(memory, 30), on_device, kTriangles, on_own());
  expect_usage_error({"parts"}, [&] { Locator(embedded(), points_in(memory, 30), on_device, on_own()); });
  DeviceVoronoi dual;
  expect_usage_error({"parts"},
                     [&] { embedded().voronoi(points_in(memory, 30), on_device, dual, on_own()); });
  embedded().triangulate(points_in(memory, 30), on_device, kAll, on_own());
  expect_usage_error({"number of points"},
                     [&] { Locator(embedded(), points_in(memory, 29), on_device, on_own()); });
  Locator device_locator(embedded(), points_in(memory, 30), on_device, on_own());
  const Memory small = embedder().make_buffer(4);
  DeviceBuffer result(small.get());
  expect_usage_error({"too small"}, [&] { device_locator.locate(points_in(memory, 30), result, on_own()); });
  expect_usage_error({"values"}, [&] {
    DeviceBuffer results;
    device_locator.interpolate(small.get(), points_in(memory, 30), results, on_own());
  });
  // One buffer for queries and answers.
  DeviceBuffer shared(memory.get());
  expect_usage_error({"two things"}, [&] { device_locator.locate(points_in(memory, 30), shared, on_own()); });
  dual.cells = dual.circumcentres = DeviceBuffer(embedder().make_buffer(1 << 14).get());
  expect_usage_error({"two things"},
                     [&] { embedded().voronoi(points_in(memory, 30), on_device, dual, on_own()); });
  const DeviceTriangulation moved = std::move(on_device);
  DeviceVoronoi other;
  expect_usage_error({"offsets", "moved"},
                     [&] { embedded().voronoi(points_in(memory, 30), on_device, other, on_own()); });
  EXPECT_EQ(moved.points, 30u);
  Embedder stranger(embedder().device());
  Enqueue foreign;
  foreign.queue = stranger.queue();
  expect_usage_error({"queue"}, [&] { device_locator.locate(points_in(memory, 30), result, foreign); });
}

// Of a set with a tree, whose starts are found by representatives.
TEST(SmallLocator, WrongArraysAreAnError) {
  const std::size_t n = 2000;
  const Coordinates points = make_fixture("uniform", n, 5);
  const Triangulation right = expected_of(points, {0, n});
  for (const std::int32_t wrong : {-5, 2000, 2000000000}) {
    Triangulation mesh = right;
    std::fill(mesh.representatives.begin(), mesh.representatives.end(), wrong);
    expect_error(ErrorKind::input, {"representative 0"},
                 [&] { Locator(triangulator(), points.data(), n, mesh); });
    mesh = right;
    std::fill(mesh.neighbors.begin(), mesh.neighbors.end(), wrong);
    expect_error(ErrorKind::input, {"triangle 0"}, [&] { Locator(triangulator(), points.data(), n, mesh); });
    mesh = right;
    mesh.triangles[4] = wrong;
    expect_error(ErrorKind::input, {"triangle "}, [&] { Locator(triangulator(), points.data(), n, mesh); });
  }
}

TEST(SmallVoronoi, OfTheHostAndOfTheDevice) {
  Queried q;
  q.add_turned_lattices();
  const Triangulation mesh = expected_of(q.points, q.offsets);
  const Voronoi dual = triangulator().voronoi(q.points.data(), q.offsets.back(), mesh);
  const std::size_t n = q.offsets.back();
  ASSERT_EQ(dual.cell_offsets.size(), n + 1);
  ASSERT_EQ(dual.cells.size(), mesh.triangles.size());
  ASSERT_EQ(dual.circumcentres.size(), 2 * mesh.triangles.size() / 3);
  for (std::size_t t = 0; t < mesh.triangles.size() / 3; ++t) {
    const double x = dual.circumcentres[2 * t], y = dual.circumcentres[2 * t + 1];
    const auto radius = [&](int k) {
      const std::int32_t i = mesh.triangles[3 * t + k];
      return std::hypot(q.points[2 * i] - x, q.points[2 * i + 1] - y);
    };
    EXPECT_NEAR(radius(1), radius(0), 1e-9 * radius(0));
    EXPECT_NEAR(radius(2), radius(0), 1e-9 * radius(0));
  }
  for (std::size_t i = 0; i < n; ++i) {
    const bool is_on_hull =
        std::find(mesh.hull.begin(), mesh.hull.end(), static_cast<std::int32_t>(i)) != mesh.hull.end();
    EXPECT_EQ(dual.unbounded[i], is_on_hull) << i;
    const std::int32_t begin = dual.cell_offsets[i], end = dual.cell_offsets[i + 1];
    for (std::int32_t k = begin; k < end; ++k) {
      const std::int32_t* const corners = &mesh.triangles[3 * dual.cells[k]];
      const auto at = std::find(corners, corners + 3, static_cast<std::int32_t>(i)) - corners;
      ASSERT_LT(at, 3) << i;
      // Counter-clockwise: the next triangle lies beyond the edge that arrives at the point.
      if (k + 1 == end && is_on_hull) continue;
      const std::int32_t next = k + 1 == end ? dual.cells[begin] : dual.cells[k + 1];
      EXPECT_EQ(mesh.neighbors[3 * dual.cells[k] + (at + 1) % 3], next) << i;
    }
  }

  const Memory memory = embedder().upload(q.points);
  DevicePoints points = points_in(memory, n);
  points.offsets = q.offsets;
  DeviceTriangulation on_device;
  DeviceVoronoi result;
  embedded().triangulate(points, on_device, kAll, on_own());
  embedded().voronoi(points, on_device, result, on_own());
  EXPECT_TRUE(same(embedder().download<double>(result.circumcentres.memory(), dual.circumcentres.size()),
                   dual.circumcentres));
  EXPECT_TRUE(
      same(embedder().download<std::int32_t>(result.cell_offsets.memory(), n + 1), dual.cell_offsets));
  EXPECT_TRUE(same(embedder().download<std::int32_t>(result.cells.memory(), dual.cells.size()), dual.cells));
  EXPECT_TRUE(same(embedder().download<std::uint8_t>(result.unbounded.memory(), n), dual.unbounded));
  EXPECT_TRUE(
      triangulator().voronoi(nullptr, 0, triangulator().triangulate(q.points.data(), 0)).cells.empty());
}

TEST(SmallClippedVoronoi, OfTheHostAndOfTheDevice) {
  Queried q;
  q.add_turned_lattices();
  const Coordinates corners = {-1, 0, 0.5, -1, 2, 0.25, 0.5, 2};
  const std::size_t n = q.offsets.back();
  const Triangulation mesh = expected_of(q.points, q.offsets);
  const ClippedVoronoi cells = triangulator().clipped_voronoi(q.points.data(), n, mesh, corners.data(), 4);
  ASSERT_EQ(cells.offsets.size(), n + 1);
  const Memory memory = embedder().upload(q.points);
  DevicePoints points = points_in(memory, n);
  points.offsets = q.offsets;
  DeviceTriangulation on_device;
  DeviceClippedVoronoi result;
  embedded().triangulate(points, on_device, kAll, on_own());
  embedded().clipped_voronoi(points, on_device, corners.data(), 4, result, on_own());
  EXPECT_EQ(result.vertex_count, cells.vertices.size() / 2);
  EXPECT_TRUE(
      same(embedder().download<double>(result.vertices.memory(), cells.vertices.size()), cells.vertices));
  EXPECT_TRUE(same(embedder().download<std::int32_t>(result.offsets.memory(), n + 1), cells.offsets));
  EXPECT_TRUE(same(embedder().download<double>(result.areas.memory(), n), cells.areas));
  const std::vector<double> centroids = embedder().download<double>(result.centroids.memory(), 2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    if (cells.offsets[i] == cells.offsets[i + 1]) continue;
    EXPECT_EQ(centroids[2 * i], cells.centroids[2 * i]);
    EXPECT_EQ(centroids[2 * i + 1], cells.centroids[2 * i + 1]);
  }
  result.areas = result.centroids;
  expect_usage_error({"two things"}, [&] {
    embedded().clipped_voronoi(points, on_device, corners.data(), 4, result, on_own());
  });
}

// A ring of `count` segments about a point, of points that are added.
void add_ring(Coordinates& points, std::vector<std::int32_t>& segments, double x, double y, double radius,
              std::int32_t count) {
  const auto first = static_cast<std::int32_t>(points.size() / 2);
  for (std::int32_t i = 0; i < count; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / count;
    points.insert(points.end(), {x + radius * std::cos(angle), y + radius * std::sin(angle)});
    segments.insert(segments.end(), {first + i, first + (i + 1) % count});
  }
}

// Between triangulation, segments, domains and refinement the mesh stays on a device that has memory of its
// own. Refinement gets an order of the points and the edges that must stay besides.
TEST(Embedding, StagesOfConstraintsSendTheInputOnce) {
  Coordinates points = make_fixture("uniform", 20000, 3);
  std::vector<std::int32_t> segments;
  add_ring(points, segments, 0.5, 0.5, 0.4, 900);
  add_ring(points, segments, 0.4, 0.5, 0.1, 300);
  const double hole[] = {0.4, 0.5}, seed[] = {0.7, 0.5};
  const Coordinates corners(points.end() - 2400, points.end());
  // A sharp corner, whose edges refinement splits at powers of two.
  const auto sharp = static_cast<std::int32_t>(points.size() / 2);
  points.insert(points.end(), {0.6, 0.45, 0.7, 0.45, 0.7, 0.47});
  segments.insert(segments.end(), {sharp, sharp + 1, sharp, sharp + 2});
  const std::size_t n = points.size() / 2, count = segments.size() / 2;
  const Polygons polygons = {corners.data(), {0, 900, 1200}, {0, 1, 2}};
  const ScopedEnvironment tuning("FLAUNAY_TUNING", "in_host_memory=0");
  Triangulator device(embedder().context(), embedder().device());
  Triangulator host("host");
  for (const bool is_refined : {false, true}) {
    for (const Outside outside : {Outside::keep, Outside::hull, Outside::holes}) {
      Constraints constraints;
      constraints.segments = segments.data();
      constraints.segment_count = count;
      ConstrainedOptions options;
      options.outside = outside;
      options.refinement.min_angle = is_refined ? 20 : 0;
      options.neighbors = options.halfedges = true;
      options.labels = outside == Outside::holes;
      if (outside == Outside::hull) {
        constraints.holes = hole;
        constraints.seeds = seed;
        constraints.seed_attributes = seed;
        constraints.hole_count = constraints.seed_count = 1;
      }
      opencl_calls().reset();
      const auto found = device.constrained(points.data(), n, constraints, options);
      if (device.device().fp64) {
        EXPECT_EQ(opencl_calls().bytes_to_device, found.statistics.bytes_to_device);
        EXPECT_LE(found.statistics.bytes_to_device, (n * 16 + count * 8) * (is_refined ? 18 : 11) / 10);
      }
      expect_same_arrays(found, host.constrained(points.data(), n, constraints, options));
    }
  }
  PolygonOptions options;
  options.map = options.labels = true;
  expect_same_arrays(device.polygons(polygons, options), host.polygons(polygons, options));
}

// Rows of points, and a segment through each row, in both directions.
TEST(SmallConstrainedOnDevice, IsThatOfTheHost) {
  std::vector<double> points;
  std::vector<std::int32_t> segments;
  const std::vector<double> uniform = io::generate("uniform", 24 * 24, 5).coordinates;
  for (std::int32_t k = 0; k < 24 * 24; ++k) {
    points.insert(points.end(), {k % 24 + 0.4 * uniform[2 * k], k / 24 + 0.4 * uniform[2 * k + 1]});
    if (k % 24 == 23) segments.insert(segments.end(), {k - 23, k, k, k - 23});
  }
  const std::size_t n = points.size() / 2;
  Constraints constraints;
  constraints.segments = segments.data();
  constraints.segment_count = segments.size() / 2;
  const ConstrainedTriangulation expected = triangulator().constrained(points.data(), n, constraints);

  const Memory memory = embedder().upload(points), ends = embedder().upload(segments);
  DeviceTriangulation mesh;
  for (int call = 0; call < 2; ++call) {
    embedded().constrained({memory.get(), n}, {ends.get(), segments.size() / 2}, mesh);
  }
  const auto read = [](const DeviceBuffer& buffer, std::size_t count) {
    return embedder().download<std::int32_t>(buffer.memory(), count, embedded().queue());
  };
  EXPECT_EQ(mesh.constraint_count, expected.constraint_edges.size() / 2);
  EXPECT_EQ(read(mesh.triangles, expected.triangles.size()), expected.triangles);
  EXPECT_EQ(read(mesh.neighbors, expected.neighbors.size()), expected.neighbors);
  EXPECT_EQ(read(mesh.constraint_edges, expected.constraint_edges.size()), expected.constraint_edges);
  EXPECT_EQ(read(mesh.piece_edges, expected.piece_edges.size()), expected.piece_edges);
  EXPECT_EQ(embedder().download<std::uint8_t>(mesh.constrained.memory(), expected.constrained.size(),
                                              embedded().queue()),
            expected.constrained);
  DeviceVoronoi dual;
  EXPECT_THROW(embedded().voronoi({memory.get(), n}, mesh, dual), Error);
}

TEST(SmallConstrainedOnDevice, CrossingSegmentsAreNamed) {
  const std::vector<double> points = {0, 0, 2, 2, 0, 2, 2, 0};
  const std::vector<std::int32_t> segments = {0, 1, 2, 3};
  const Memory memory = embedder().upload(points), ends = embedder().upload(segments);
  DeviceTriangulation mesh;
  expect_error(ErrorKind::input, "segments 0", [&] {
    embedded().constrained({memory.get(), 4}, {ends.get(), 2}, mesh);
  });
}

TEST(SmallRelaxOnDevice, IsThatOfTheHost) {
  const std::size_t n = 200;
  const Coordinates points = make_fixture("uniform", n, 31), corners = {0, 0, 1, 0, 1, 1, 0, 1};
  const Coordinates expected = triangulator().relax(points.data(), n, corners.data(), 4, 5);
  const Memory memory = embedder().upload(points);
  DeviceBuffer relaxed;
  embedded().relax(points_in(memory, n), corners.data(), 4, 5, relaxed, on_own());
  EXPECT_TRUE(same(embedder().download<double>(relaxed.memory(), 2 * n), expected));
  EXPECT_TRUE(same(embedder().download<double>(memory.get(), 2 * n), points));
  DevicePoints sets = points_in(memory, n);
  sets.offsets = {0, 100, n};
  expect_usage_error({"several sets"},
                     [&] { embedded().relax(sets, corners.data(), 4, 5, relaxed, on_own()); });
}

TEST(SmallEmbeddingMisuse, Buffers) {
  const Coordinates coordinates = make_fixture("uniform", 20, 5);
  const Memory memory = embedder().upload(coordinates);
  Embedder stranger(embedder().device());
  const Memory foreign = stranger.make_buffer(1 << 12);
  const auto refused = [&](const std::vector<std::string>& parts, const DevicePoints& points,
                           DeviceTriangulation result = {}) {
    expect_usage_error(parts, [&] { embedded().triangulate(points, result, kAll, on_own()); });
  };
  DevicePoints none;
  none.count = 20;
  refused({"no buffer of points"}, none);
  refused({"points", "another context"}, points_in(foreign, 20));
  refused({"points", "too small"}, points_in(memory, 21));
  DevicePoints late = points_in(memory, 20);
  late.first = 1;
  refused({"points", "too small"}, late);
  late.first = std::numeric_limits<std::size_t>::max();
  DeviceTriangulation nothing;
  expect_error(ErrorKind::input, {"points before the first one are too many"},
               [&] { embedded().triangulate(late, nothing, kAll, on_own()); });
  const Memory write_only = embedder().make_buffer(320, CL_MEM_WRITE_ONLY);
  refused({"points", "CL_MEM_WRITE_ONLY"}, points_in(write_only, 20));
  const Memory image_like = embedder().make_buffer(480, CL_MEM_READ_ONLY);
  DeviceTriangulation result;
  result.triangles = DeviceBuffer(image_like.get());
  refused({"triangles", "CL_MEM_READ_ONLY"}, points_in(memory, 20), result);
  result.triangles = DeviceBuffer(foreign.get());
  refused({"triangles", "another context"}, points_in(memory, 20), result);
  const Memory shared = embedder().make_buffer(1 << 12);
  result.triangles = result.neighbors = DeviceBuffer(shared.get());
  refused({"one buffer", "two things"}, points_in(memory, 20), result);
  expect_usage_error({"no buffer"}, [] { (void)DeviceBuffer(nullptr); });
}

TEST(SmallEmbeddingMisuse, Offsets) {
  const Memory memory = embedder().upload(make_fixture("uniform", 20, 5));
  DeviceTriangulation result;
  const auto refused = [&](const std::vector<std::string>& parts, const DevicePoints& points) {
    expect_usage_error(parts, [&] { embedded().triangulate(points, result, kAll, on_own()); });
  };
  DevicePoints points = points_in(memory, 20);
  for (const Offsets& wrong : {Offsets{1, 20}, Offsets{0, 12, 11, 20}}) {
    points.offsets = wrong;
    refused({"offsets", "not decrease"}, points);
    points.offsets.clear();
    const Memory on_device = embedder().upload(std::vector<std::int32_t>(wrong.begin(), wrong.end()));
    points.device_offsets = on_device.get();
    points.sets = wrong.size() - 1;
    refused({"offsets", "not decrease"}, points);
    points.sets += 5;
    refused({"offsets", "too small"}, points);
    points.device_offsets = nullptr;
  }
  const Memory negative = embedder().upload(std::vector<std::int32_t>{0, -3, 20});
  points.device_offsets = negative.get();
  points.sets = 2;
  refused({"offsets"}, points);
  points.offsets = {0, 20};
  refused({"twice"}, points);
  points.device_offsets = nullptr;
  points.offsets = {0, 19};
  refused({"end with 19", "20 points"}, points);
}

TEST(SmallEmbeddingMisuse, Queues) {
  const Memory memory = embedder().upload(make_fixture("uniform", 20, 5));
  DeviceTriangulation result;
  Embedder stranger(embedder().device());
  Enqueue enqueue;
  enqueue.queue = stranger.queue();
  const auto refused = [&](const std::vector<std::string>& parts) {
    expect_usage_error(parts, [&] { embedded().triangulate(points_in(memory, 20), result, kAll, enqueue); });
  };
  refused({"queue", "another context"});
  enqueue = on_own();
  enqueue.profile = true;
  refused({"CL_QUEUE_PROFILING_ENABLE"});
  // Events to wait for.
  enqueue = on_own();
  enqueue.wait_for = {nullptr};
  refused({"event", "CL_INVALID_EVENT"});
  cl_int code = CL_SUCCESS;
  const cl_event foreign = clCreateUserEvent(stranger.context(), &code);
  check(code, "clCreateUserEvent");
  enqueue.wait_for = {foreign};
  refused({"event", "another context"});
  clReleaseEvent(foreign);
  const cl_event failed = clCreateUserEvent(embedder().context(), &code);
  check(code, "clCreateUserEvent");
  clSetUserEventStatus(failed, -5);
  enqueue.wait_for = {failed};
  refused({"event", "has failed", "CL_OUT_OF_RESOURCES"});
  clReleaseEvent(failed);
  // A queue may be released when the call has returned.
  Queue queue = embedder().make_queue();
  embedded().triangulate(points_in(memory, 20), result, kAll, on(queue));
  queue.reset();
  embedded().triangulate(points_in(memory, 20), result, kAll, on_own());

  const Queue timed = embedder().make_queue(CL_QUEUE_PROFILING_ENABLE);
  enqueue = on(timed);
  enqueue.profile = true;
  embedded().triangulate(points_in(memory, 20), result, kAll, enqueue);
  EXPECT_FALSE(result.statistics.kernels.empty());
  enqueue.queue = nullptr;
  embedded().triangulate(points_in(memory, 20), result, kAll, enqueue);
  EXPECT_FALSE(result.statistics.kernels.empty());
  embedded().triangulate(points_in(memory, 20), result, kAll, on(timed));
  EXPECT_TRUE(result.statistics.kernels.empty());
}

TEST(SmallEmbeddingMisuse, ContextAndDevice) {
  expect_usage_error({"context and a device"}, [] { Triangulator t(nullptr, embedder().device()); });
  expect_usage_error({"context and a device"}, [] { Triangulator t(embedder().context(), nullptr); });
  const double* const nothing = nullptr;
  expect_usage_error({"3 points", "NULL"}, [&] { triangulator().triangulate(nothing, 3); });
  EXPECT_TRUE(triangulator().triangulate(nothing, 0).triangles.empty());
}

TEST(SmallEmbeddingMisuse, PointsThatAreNotFiniteAreNamed) {
  Coordinates coordinates = make_fixture("uniform", 20, 5);
  coordinates[2 * 13 + 1] = std::numeric_limits<double>::infinity();
  const Memory memory = embedder().upload(coordinates);
  DeviceTriangulation result;
  cl_event done = reinterpret_cast<cl_event>(8);
  Enqueue enqueue = on_own();
  enqueue.event = &done;
  DevicePoints points = points_in(memory, 17);
  points.first = 3;
  expect_error(ErrorKind::input, {"point 10 is not finite"},
               [&] { embedded().triangulate(points, result, kAll, enqueue); });
  EXPECT_EQ(done, nullptr);
  const Memory closed = embedder().make_buffer(320, CL_MEM_HOST_NO_ACCESS);
  check(clEnqueueCopyBuffer(embedder().queue(), memory.get(), closed.get(), 0, 0, 320, 0, nullptr, nullptr),
        "copy");
  expect_error(ErrorKind::input, {"point 13 is not finite"},
               [&] { embedded().triangulate(points_in(closed, 20), result, kAll, on_own()); });
  points.count = 10;
  embedded().triangulate(points, result, kAll, on_own());
}

TEST(SmallEmbedding, DevicesWithoutFp64AreUsed) {
  const std::string name = triangulator().device().name;
  embedder();  // which is to be made before
  const Coordinates points = make_fixture("grid", 10000, 5);
  const Triangulation expected = triangulator().triangulate(points.data(), 10000);
  opencl_calls().without_fp64 = true;
  Triangulator in_context(embedder().context(), embedder().device()), named(name);
  for (Triangulator* used : {&in_context, &named}) {
    EXPECT_FALSE(used->device().fp64);
    EXPECT_TRUE(used->device().fixed_point);
    const Triangulation found = used->triangulate(points.data(), 10000);
    EXPECT_EQ(found.statistics.device, name);
    EXPECT_TRUE(same(found.triangles, expected.triangles));
  }
  // If there is no GPU and no device is named, points in host memory need none.
  const ScopedEnvironment unset("FLAUNAY_DEVICE", nullptr);
  Triangulator own;
  const std::string expected_name = triangulator().device().type == "GPU" ? name : "host";
  EXPECT_EQ(own.triangulate(points.data(), 10000).statistics.device, expected_name);
  EXPECT_NE(own.context(), nullptr);
  opencl_calls().without_fp64 = false;
}

TEST(SmallEmbeddingMisuse, FailuresOfOpenclAreNamed) {
  const Coordinates coordinates = make_fixture("uniform", 20, 5);
  const Memory memory = embedder().upload(coordinates);
  Triangulator fresh(embedder().context(), embedder().device());
  DeviceTriangulation result;
  opencl_calls().buffers_that_fit = 0;
  try {
    fresh.triangulate(points_in(memory, 20), result, kAll, on_own());
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::device);
    EXPECT_EQ(error.code(), CL_MEM_OBJECT_ALLOCATION_FAILURE);
    EXPECT_EQ(error.call(), "clCreateBuffer");
    EXPECT_NE(std::string(error.what()).find("CL_MEM_OBJECT_ALLOCATION_FAILURE"), std::string::npos);
    Error first(error);
    const Error second(std::move(first));
    EXPECT_EQ(first.call(), "clCreateBuffer");
    EXPECT_EQ(second.call(), "clCreateBuffer");
  }
  opencl_calls().buffers_that_fit = kAnyNumber;
  fresh.triangulate(points_in(memory, 20), result, kAll, on_own());
  expect_same(result, expected_of(coordinates, {0, 20}));
}

TEST(SmallEmbedding, PinnedMemoryIsMadeOnceOrDoneWithout) {
  const std::size_t n = 3000;
  const Coordinates coordinates = make_fixture("uniform", n, 5);
  const Triangulation expected = expected_of(coordinates, {0, n});
  const ScopedEnvironment tuning("FLAUNAY_TUNING", "gpu,staging_bytes=5000");
  for (const bool has_some : {true, false}) {
    Triangulator fresh(embedder().context(), embedder().device());
    opencl_calls().reset();
    opencl_calls().without_pinned = !has_some;
    for (int call = 0; call < 2; ++call) {
      const Triangulation found = fresh.triangulate(coordinates.data(), n);
      EXPECT_TRUE(same(found.triangles, expected.triangles)) << has_some << ", call " << call;
      EXPECT_TRUE(same(found.hull, expected.hull)) << has_some << ", call " << call;
      EXPECT_TRUE(same(found.representatives, expected.representatives)) << has_some << ", call " << call;
    }
    opencl_calls().without_pinned = false;
    EXPECT_EQ(opencl_calls().pinned, has_some ? 1u : 0u);
  }
}

// Without room for the first buffer, the second, and so on: an error each time, after which the objects do
// what they did before.
TEST(SmallEmbeddingMisuse, DevicesMayLackMemoryAtAnyTime) {
  const std::size_t n = 300;
  const Coordinates coordinates = make_fixture("uniform", n, 5);
  const Memory memory = embedder().upload(coordinates);
  const std::vector<std::int32_t> segments = {0, 1, 2, 3};
  const Triangulation expected = expected_of(coordinates, {0, n});
  Triangulator kept(embedder().context(), embedder().device());
  const bool uses_buffers_again = has_gpu_sizes(kept);
  const auto attack = [&](const char* what, const std::function<void()>& work) {
    bool is_over = false;
    std::size_t errors = 0;
    for (std::size_t fit = 0; !is_over; fit += 1 + fit / 8) {
      opencl_calls().buffers_that_fit = fit;
      try {
        work();
        is_over = true;
      } catch (const Error& error) {
        ++errors;
        EXPECT_EQ(error.kind(), ErrorKind::device) << what << ", " << fit << ": " << error.what();
        EXPECT_EQ(error.code(), CL_MEM_OBJECT_ALLOCATION_FAILURE) << what << ", " << fit;
      }
      opencl_calls().buffers_that_fit = kAnyNumber;
      EXPECT_TRUE(same(kept.triangulate(coordinates.data(), n).triangles, expected.triangles))
          << what << ", " << fit;
    }
    // With a GPU's sizes, buffers of calls before are used again, and there may be enough.
    if (!uses_buffers_again) {
      EXPECT_GT(errors, 1u) << what;
    }
  };
  attack("points in host memory", [&] { kept.triangulate(coordinates.data(), n); });
  attack("points in device memory", [&] {
    DeviceTriangulation result;
    kept.triangulate(points_in(memory, n), result, kAll, on_own());
    expect_same(result, expected);
  });
  attack("segments", [&] {
    Constraints constraints;
    constraints.segments = segments.data();
    constraints.segment_count = 2;
    ConstrainedOptions options;
    options.crossings = Crossings::split;
    kept.constrained(coordinates.data(), n, constraints, options);
  });
  // Without double precision, it is computed on the host.
  if (kept.device().fp64) attack("a diagram", [&] { kept.voronoi(coordinates.data(), n, expected); });
  attack("a torus", [&] {
    DeviceTriangulation result;
    DevicePoints points = points_in(memory, n);
    points.space = Space::torus({});
    kept.triangulate(points, result, kAll, on_own());
    EXPECT_EQ(result.triangle_offsets.back(), 2 * n);
  });
  const std::vector<double> heavier(n, 1);
  const Memory weights = embedder().upload(heavier);
  attack("weights", [&] {
    DeviceTriangulation result;
    DevicePoints points = points_in(memory, n);
    points.weights = weights.get();
    kept.triangulate(points, result, kAll, on_own());
    expect_same(result, expected);
  });
  attack("a locator", [&] {
    Locator locator(kept, coordinates.data(), n, expected);
    locator.nearest(coordinates.data(), n);
  });
}

}  // namespace
}  // namespace flaunay::testing
