// Triangulations in chunks against single calls: the same triangles with the same neighbours, the same hull
// and representatives, whatever the chunks and the solvers.
#include "flaunay/chunks.hpp"

#include <CL/cl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "large/chunks/run.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/stalling.hpp"

namespace flaunay::chunks {
namespace {

using testing::Coordinates;
using testing::make_fixture;
using Row = std::array<std::int64_t, 3>;

constexpr std::int64_t kNotWritten = -7;

Triangulator& triangulator() {
  static Triangulator only;
  return only;
}

Solver solver() {
  return {"test", [](const double* coordinates, std::size_t n) {
            Triangulator own;
            Options options;
            options.areas = true;
            return own.triangulate(coordinates, n, options);
          }};
}

/// Arrays that grow.
class VectorSink : public MeshSink {
 public:
  bool wants(MeshArray) const override { return true; }
  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override {
    std::vector<std::int64_t>& to = arrays[array];
    to.resize(std::max<std::size_t>(to.size(), first + count), kNotWritten);
    std::copy_n(values, count, to.begin() + static_cast<std::ptrdiff_t>(first));
  }
  void write_doubles(MeshArray array, std::uint64_t first, const double* values, std::size_t count) override {
    EXPECT_EQ(array, MeshArray::areas);
    areas.resize(std::max<std::size_t>(areas.size(), first + count), kNotWritten);
    std::copy_n(values, count, areas.begin() + static_cast<std::ptrdiff_t>(first));
  }
  std::map<MeshArray, std::vector<std::int64_t>> arrays;
  std::vector<double> areas;
};

/// Each triangle with its neighbours as triangles, sorted: what does not depend on the order of rows.
template <typename Index>
std::vector<std::array<Row, 4>> sorted_rows(const std::vector<Index>& triangles,
                                            const std::vector<Index>& neighbors) {
  const auto row = [&](Index t) { return Row{triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]}; };
  std::vector<std::array<Row, 4>> rows;
  for (std::size_t t = 0; 3 * t < triangles.size(); ++t) {
    std::array<Row, 4> all{row(static_cast<Index>(t))};
    for (std::size_t k = 0; k < 3; ++k) {
      const Index other = neighbors[3 * t + k];
      all[k + 1] = other < 0 ? Row{other, other, other} : row(other);
    }
    rows.push_back(all);
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

/// Each triangle with its area, sorted.
template <typename Index>
std::vector<std::pair<Row, double>> sorted_areas(const std::vector<Index>& triangles,
                                                 const std::vector<double>& areas) {
  std::vector<std::pair<Row, double>> rows;
  for (std::size_t t = 0; t < areas.size(); ++t) {
    rows.push_back({{triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2]}, areas[t]});
  }
  std::sort(rows.begin(), rows.end());
  return rows;
}

template <typename Index>
std::vector<std::int64_t> wide(const std::vector<Index>& values) {
  return {values.begin(), values.end()};
}

Plan small_plan(std::size_t chunk_points, int most_handed_on_percent = 70) {
  Plan plan;
  plan.chunk_points = chunk_points;
  plan.largest_chunk = 1u << 30;
  plan.buffer_bytes = 1 << 16;
  plan.most_handed_on_percent = most_handed_on_percent;
  return plan;
}

ChunkStatistics compare(const Coordinates& points, const Plan& plan,
                        const std::vector<Solver>& solvers = {solver()}) {
  const std::size_t n = points.size() / 2;
  Options with_areas;
  with_areas.areas = true;
  const Triangulation expected = triangulator().triangulate(points.data(), n, with_areas);
  ArrayPoints source(points.data(), n);
  VectorSink sink;
  const ChunkStatistics statistics = run(source, nullptr, sink, plan, solvers, {});
  EXPECT_EQ(sink.arrays[MeshArray::triangles].size(), expected.triangles.size());
  EXPECT_EQ(sink.arrays[MeshArray::neighbors].size(), expected.neighbors.size());
  EXPECT_EQ(sink.areas.size(), expected.areas.size());
  if (::testing::Test::HasFailure()) return statistics;
  EXPECT_TRUE(sorted_rows(sink.arrays[MeshArray::triangles], sink.arrays[MeshArray::neighbors]) ==
              sorted_rows(wide(expected.triangles), wide(expected.neighbors)));
  EXPECT_TRUE(sorted_areas(sink.arrays[MeshArray::triangles], sink.areas) ==
              sorted_areas(expected.triangles, expected.areas));
  EXPECT_EQ(sink.arrays[MeshArray::hull], wide(expected.hull));
  EXPECT_EQ(sink.arrays[MeshArray::representatives], wide(expected.representatives));
  EXPECT_EQ(statistics.points, n);
  EXPECT_EQ(statistics.duplicates, expected.statistics.duplicates);
  EXPECT_EQ(statistics.triangles, expected.triangles.size() / 3);
  EXPECT_EQ(statistics.hull_vertices, expected.hull.size());
  std::uint64_t triangles = 0;
  for (const ChunkRound& round : statistics.rounds) triangles += round.triangles;
  EXPECT_EQ(triangles, statistics.triangles);
  return statistics;
}

TEST(SmallChunks, OfUniformPoints) {
  const ChunkStatistics statistics = compare(make_fixture("uniform", 2000, 1), small_plan(50, 99));
  EXPECT_GE(statistics.rounds.size(), 3u);
  EXPECT_GE(statistics.rounds[0].chunks, 40u);
  EXPECT_GT(statistics.scratch_bytes, 2000u * 24);
}

TEST(Chunks, OfFixtures) {
  for (const testing::Fixture& fixture : testing::all_fixtures()) {
    SCOPED_TRACE(fixture.name);
    for (const std::size_t n : {1, 2, 3, 7, 60, 400, 1500}) {
      for (const std::size_t chunk_points : {5, 12, 50}) {
        if (n > (testing::is_sanitized() ? 5 : 30) * chunk_points) continue;
        SCOPED_TRACE(std::to_string(n) + " points, " + std::to_string(chunk_points) + " a chunk");
        compare(fixture.make(n, n), small_plan(chunk_points));
        if (n <= 400) compare(fixture.make(n, n), small_plan(chunk_points, 99));
        compare(testing::perturbed(fixture.make(n, 2), 3), small_plan(chunk_points));
        if (HasFailure()) return;
      }
    }
  }
}

TEST(Chunks, OfPointsThatStall) {
  std::size_t most_rounds = 0;
  for (const std::size_t n : {60, 500, 2000}) {
    for (const auto& [name, points] : testing::stalling(n, n)) {
      SCOPED_TRACE(name + ", " + std::to_string(n) + " points");
      compare(points, small_plan(50));
      if (HasFailure()) return;
    }
  }
  // Without the rule, as long as rounds finish anything.
  for (const char* const name : {"uniform", "kuzmin", "line", "grid"}) {
    SCOPED_TRACE(name);
    most_rounds =
        std::max(most_rounds, compare(make_fixture(name, 3000, 5), small_plan(20, 99)).rounds.size());
  }
  EXPECT_GE(most_rounds, 5u);
}

Coordinates with_copies(Coordinates points, std::size_t copies, std::uint64_t seed) {
  testing::FixtureRandom random(seed);
  const auto n = static_cast<std::int64_t>(points.size() / 2);
  for (std::size_t k = 0; k < copies; ++k) {
    const auto i = static_cast<std::size_t>(random.integer(0, n - 1));
    points.insert(points.end(), {points[2 * i], points[2 * i + 1]});
  }
  return points;
}

TEST(Chunks, WithMoreEqualPointsThanAChunkHas) {
  Coordinates points = make_fixture("uniform", 600, 3);
  for (int k = 0; k < 700; ++k) points.insert(points.end(), {points[8], points[9]});
  for (int k = 0; k < 300; ++k) points.insert(points.begin(), {-0.0, 0.25});
  const ChunkStatistics statistics = compare(points, small_plan(50));
  EXPECT_EQ(statistics.duplicates, 700u + 299);
  compare(Coordinates(2 * 1000, 0.5), small_plan(50));
  compare(with_copies(make_fixture("uniform", 20, 4), 2000, 5), small_plan(50));
  compare(with_copies(make_fixture("grid", 400, 4), 2000, 5), small_plan(30));
}

TEST(Chunks, OfASampleWithoutOtherPoints) {
  // All samples are equal, all others come before them, and there are too few to cut the chunk again.
  Coordinates points(2 * 140000, 1.0);
  for (std::size_t k = 0; k < 6; ++k) {
    points[2 * (7 + 21001 * k)] = 0.1 * static_cast<double>(k);
    points[2 * (7 + 21001 * k) + 1] = 0.07 * static_cast<double>(k * k);
  }
  EXPECT_EQ(compare(points, small_plan(100000)).rounds.size(), 1u);
}

/// Fails at its calls from `first` on.
Solver failing(std::size_t first, std::atomic<std::size_t>& calls) {
  return {"failing", [first, &calls](const double* coordinates, std::size_t n) {
            if (calls++ >= first) throw Error(ErrorKind::device, "the device is gone");
            return solver().triangulate(coordinates, n);
          }};
}

TEST(Chunks, AreTakenBySeveralSolvers) {
  const Coordinates points = make_fixture("kuzmin", 4000, 6);
  compare(points, small_plan(100), {solver(), solver(), solver()});
  const ChunkStatistics statistics = compare(points, small_plan(100), {solver(), solver()});
  EXPECT_EQ(statistics.devices.size(), 2u);
  EXPECT_GT(statistics.device_points[0], 0u);
}

/// A part of an OpenCL device, with a context of its own; null if the device cannot be divided.
struct SubDevices {
  SubDevices() {
    cl_platform_id platform = nullptr;
    cl_uint count = 0;
    if (clGetPlatformIDs(1, &platform, &count) != CL_SUCCESS || count == 0) return;
    cl_device_id device = nullptr;
    if (clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, nullptr) != CL_SUCCESS) return;
    const cl_device_partition_property properties[] = {CL_DEVICE_PARTITION_EQUALLY, 1, 0};
    cl_uint parts = 0;
    if (clCreateSubDevices(device, properties, 0, nullptr, &parts) != CL_SUCCESS) return;
    devices.resize(parts);
    if (clCreateSubDevices(device, properties, parts, devices.data(), nullptr) != CL_SUCCESS) devices.clear();
  }
  ~SubDevices() {
    for (const cl_device_id device : devices) clReleaseDevice(device);
  }
  std::vector<cl_device_id> devices;
};

TEST(Chunks, AreTakenBySubDevices) {
  const SubDevices parts;
  if (parts.devices.size() < 2) GTEST_SKIP() << "no device that can be divided";
  const Coordinates points = make_fixture("kuzmin", 20000, 8);
  const std::size_t n = points.size() / 2;
  std::vector<Triangulator> triangulators;
  ChunkOptions options;
  options.chunk_points = 4000;
  for (const cl_device_id device : {parts.devices[0], parts.devices[1]}) {
    const cl_context context = clCreateContext(nullptr, 1, &device, nullptr, nullptr, nullptr);
    triangulators.emplace_back(context, device);
    clReleaseContext(context);
  }
  for (Triangulator& each : triangulators) options.triangulators.push_back(&each);
  std::vector<std::int32_t> triangles(6 * n), neighbors(6 * n), hull(n);
  const ChunkStatistics statistics = triangulate_chunks(
      points.data(), n, MeshArrays<std::int32_t>{triangles.data(), neighbors.data(), hull.data()}, options);
  const Triangulation expected = triangulator().triangulate(points.data(), n);
  triangles.resize(3 * statistics.triangles);
  neighbors.resize(3 * statistics.triangles);
  EXPECT_TRUE(sorted_rows(triangles, neighbors) == sorted_rows(expected.triangles, expected.neighbors));
  EXPECT_EQ(statistics.device_points.size(), 2u);
  EXPECT_GT(statistics.device_points[0], 0u);
  EXPECT_GT(statistics.device_points[1], 0u);
}

TEST(Chunks, AreTakenByADeviceAndTheHost) {
  const Coordinates points = make_fixture("uniform", 20000, 8);
  const std::size_t n = points.size() / 2;
  ChunkOptions options;
  options.chunk_points = 3000;
  options.devices = {"#0", "host"};
  std::vector<std::int64_t> triangles(6 * n), neighbors(6 * n);
  std::vector<double> areas(2 * n);
  const ChunkStatistics statistics = triangulate_chunks(
      points.data(), n,
      MeshArrays<std::int64_t>{triangles.data(), neighbors.data(), nullptr, nullptr, areas.data()}, options);
  Options with_areas;
  with_areas.areas = true;
  const Triangulation expected = triangulator().triangulate(points.data(), n, with_areas);
  triangles.resize(3 * statistics.triangles);
  neighbors.resize(3 * statistics.triangles);
  areas.resize(statistics.triangles);
  EXPECT_TRUE(sorted_areas(triangles, areas) == sorted_areas(expected.triangles, expected.areas));
  EXPECT_TRUE(sorted_rows(triangles, neighbors) ==
              sorted_rows(wide(expected.triangles), wide(expected.neighbors)));
  EXPECT_EQ(statistics.devices.size(), 2u);
  EXPECT_EQ(statistics.devices[1], "host");
}

TEST(Chunks, OfALostSolverAreDoneByOthers) {
  const Coordinates points = make_fixture("uniform", 4000, 7);
  for (const std::size_t first : {0, 1, 5, 30}) {
    SCOPED_TRACE(first);
    std::atomic<std::size_t> calls{0}, more_calls{0};
    compare(points, small_plan(100), {failing(first, calls), solver()});
    compare(points, small_plan(100), {solver(), failing(first, calls), failing(first + 2, more_calls)});
  }
}

TEST(Chunks, EndWithTheErrorOfTheLastSolver) {
  const Coordinates points = make_fixture("uniform", 4000, 7);
  for (const std::size_t first : {0, 1, 5, 30}) {
    std::atomic<std::size_t> calls{0}, more_calls{0};
    ArrayPoints source(points.data(), points.size() / 2);
    VectorSink sink;
    try {
      run(source, nullptr, sink, small_plan(100), {failing(first, calls), failing(first / 2, more_calls)},
          {});
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::device);
      EXPECT_STREQ(error.what(), "the device is gone");
    }
  }
}

void expect_error(Coordinates points, const ErrorKind kind, const std::string& text,
                  const Plan& plan = small_plan(50)) {
  ArrayPoints source(points.data(), points.size() / 2);
  VectorSink sink;
  testing::expect_error(kind, text, [&] { run(source, nullptr, sink, plan, {solver()}, {}); });
}

TEST(Chunks, ThatAreWrongAreRefused) {
  Coordinates points = make_fixture("uniform", 1000, 1);
  points[2 * 999 + 1] = NAN;
  expect_error(points, ErrorKind::input, "point 999 is not finite: (");
  points[2 * 999 + 1] = 0x1p1000;
  points[2 * 3] = 0x1p-1000;
  expect_error(points, ErrorKind::input, "point 999 has y = 1.07");
  Plan plan = small_plan(50);
  plan.largest_chunk = 200;
  expect_error(make_fixture("integer-circle", 1000, 1), ErrorKind::input, "but the memory permits 200", plan);
}

/// Fails at its n-th call and at all later ones.
class FailingSink : public VectorSink {
 public:
  explicit FailingSink(std::size_t first) : first_(first) {}
  void write(MeshArray array, std::uint64_t first, const std::int64_t* values, std::size_t count) override {
    if (++calls >= first_) throw std::runtime_error("full");
    VectorSink::write(array, first, values, count);
  }
  std::size_t calls = 0;

 private:
  std::size_t first_;
};

TEST(Chunks, WriteNothingAfterAnError) {
  const Coordinates points = make_fixture("uniform", 5000, 1);
  ArrayPoints source(points.data(), points.size() / 2);
  for (const std::size_t first : {1, 2, 20, 60, 150}) {
    FailingSink sink(first);
    EXPECT_THROW(run(source, nullptr, sink, small_plan(50), {solver(), solver()}, {}), std::runtime_error);
    EXPECT_EQ(sink.calls, first);
  }
}

TEST(Chunks, CanBeInterrupted) {
  const Coordinates points = make_fixture("uniform", 5000, 1);
  ArrayPoints source(points.data(), points.size() / 2);
  for (const std::string when : {"sampling", "distributing", "triangulating"}) {
    VectorSink sink;
    ChunkOptions options;
    options.progress = [&](const std::string& stage, int, double) {
      if (stage == when) throw std::runtime_error("enough");
    };
    EXPECT_THROW(run(source, nullptr, sink, small_plan(50), {solver(), solver()}, options),
                 std::runtime_error);
  }
}

TEST(Chunks, AreOneWhenAllFits) {
  const Coordinates points = make_fixture("uniform", 1000, 1);
  const ChunkStatistics statistics = compare(points, small_plan(1000));
  EXPECT_EQ(statistics.rounds.size(), 1u);
}

TEST(Chunks, ReportProgressThatGrows) {
  const Coordinates points = make_fixture("uniform", 5000, 1);
  std::vector<std::int32_t> triangles(3 * points.size()), neighbors(3 * points.size()),
      hull(points.size() / 2);
  ChunkOptions options;
  options.chunk_points = 300;
  options.devices = {"host"};
  double last = 0;
  options.progress = [&](const std::string&, int, double done) {
    EXPECT_GE(done, last);
    last = done;
  };
  const ChunkStatistics statistics =
      triangulate_chunks(points.data(), points.size() / 2,
                         MeshArrays<std::int32_t>{triangles.data(), neighbors.data(), hull.data()}, options);
  EXPECT_EQ(last, 1);
  EXPECT_EQ(statistics.devices, std::vector<std::string>{"host"});
  const Triangulation expected = triangulator().triangulate(points.data(), points.size() / 2);
  triangles.resize(3 * statistics.triangles);
  neighbors.resize(3 * statistics.triangles);
  hull.resize(statistics.hull_vertices);
  EXPECT_TRUE(sorted_rows(wide(triangles), wide(neighbors)) ==
              sorted_rows(wide(expected.triangles), wide(expected.neighbors)));
  EXPECT_EQ(hull, expected.hull);
}

TEST(Chunks, NeedMemory) {
  const Coordinates points = make_fixture("uniform", 10, 1);
  ChunkOptions options;
  options.memory_bytes = 1000;
  EXPECT_THROW(triangulate_chunks(points.data(), 10, MeshArrays<std::int64_t>{}, options), Error);
  options.memory_bytes = 1u << 30;
  options.scratch = "/nowhere/at/all";
  EXPECT_THROW(triangulate_chunks(points.data(), 10, MeshArrays<std::int64_t>{}, options), Error);
}

TEST(Chunks, WriteWhatIsWantedAlone) {
  const Coordinates points = with_copies(make_fixture("uniform", 500, 1), 30, 2);
  const std::size_t n = points.size() / 2;
  const Triangulation expected = triangulator().triangulate(points.data(), n);
  ChunkOptions options;
  options.chunk_points = 60;
  std::vector<std::int64_t> triangles(6 * n), hull(n), representatives(n);
  const ChunkStatistics statistics =
      triangulate_chunks(points.data(), n, MeshArrays<std::int64_t>{triangles.data()}, options);
  EXPECT_EQ(3 * statistics.triangles, expected.triangles.size());
  triangulate_chunks(points.data(), n, MeshArrays<std::int64_t>{nullptr, nullptr, hull.data()}, options);
  hull.resize(expected.hull.size());
  EXPECT_EQ(hull, wide(expected.hull));
  triangulate_chunks(points.data(), n,
                     MeshArrays<std::int64_t>{nullptr, nullptr, nullptr, representatives.data()}, options);
  EXPECT_EQ(representatives, wide(expected.representatives));
}

TEST(Chunks, OfNoPoints) {
  const ChunkStatistics statistics = triangulate_chunks(nullptr, 0, MeshArrays<std::int64_t>{});
  EXPECT_EQ(statistics.triangles, 0u);
}

}  // namespace
}  // namespace flaunay::chunks
