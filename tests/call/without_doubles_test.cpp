// Devices that compute in fixed point: what they leave to their doubles or to the host gives the same bytes,
// and statistics say what the host did. CTest runs this with support/no_fp64.c, so that no device has double
// precision, and with a tuning for fixed point on a device that has it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/chunks.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.hpp"
#include "flaunay/research.hpp"
#include "flaunay/result_arrays.hpp"
#include "tests/support/embedder.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/same.hpp"
#include "tests/support/shared_triangulator.hpp"
#include "tests/support/test_kernels.hpp"

namespace flaunay::testing {
namespace {

using Floats = std::vector<float>;
using Offsets = std::vector<std::size_t>;
constexpr int kMostPlaces = 62;
constexpr Parts kAll{true, true, true, true, true, true};

bool has_fp64() {
  static const bool has = triangulator().device().fp64;
  return has;
}
Triangulator& on_host() {
  static Triangulator host("host");
  return host;
}
Embedder& embedder() {
  static Embedder embedder(triangulator().device_id());
  return embedder;
}
Triangulator& embedded() {
  static Triangulator embedded(embedder().context(), embedder().device());
  return embedded;
}

// The largest exponent of floats is beyond this, so that they can represent points of such spans.
constexpr int kMostPlacesOfFloats = 120;

// Integers up to 2^(places - 1), whose bits span just so many binary places.
Coordinates spanning(int places, std::size_t n = 700, std::uint64_t seed = 1) {
  FixtureRandom random(seed);
  Coordinates points;
  const double most = std::ldexp(1.0, places - 1);
  while (points.size() < 2 * n) {
    const double x = random.unit() * most;
    points.push_back(
        std::floor(places > kMostPlacesOfFloats ? x : static_cast<double>(static_cast<float>(x))));
  }
  points[0] = most;
  points[1] = 1;
  return points;
}

Floats as_floats(const Coordinates& points) { return {points.begin(), points.end()}; }

void expect_same(const Triangulation& found, const Triangulation& expected) {
  for_each_array([&](const auto& array, std::size_t) {
    EXPECT_TRUE(same(found.*array.values, expected.*array.values)) << array.name;
  });
  EXPECT_EQ(found.triangle_offsets, expected.triangle_offsets);
  EXPECT_EQ(found.hull_offsets, expected.hull_offsets);
}

// left: whether something was left that needs doubles.
void expect_note(const Statistics& statistics, bool left, const std::string& part) {
  const std::string device = triangulator().device().name;
  if (left && !has_fp64()) {
    EXPECT_NE(statistics.note.find(device), std::string::npos) << statistics.note;
    EXPECT_NE(statistics.note.find(part), std::string::npos) << statistics.note;
  } else {
    EXPECT_EQ(statistics.note, "");
    EXPECT_EQ(statistics.device, device);
  }
}

Options all_options() {
  Options options;
  options.halfedges = options.areas = true;
  return options;
}

const int kSpans[] = {1, 20, 61, 62, 63, 64, 120, 500};

TEST(WithoutDoubles, DevicesAreUsable) {
  const DeviceInfo own = triangulator().device();
  EXPECT_TRUE(own.fixed_point);
  EXPECT_TRUE(own.self_test_passed);
  for (const DeviceInfo& info : list_devices(true)) {
    EXPECT_TRUE(info.self_test_passed) << info.name << ": " << info.self_test_failure;
    EXPECT_TRUE(info.fixed_point);
    EXPECT_EQ(info.fp64, has_fp64());
  }
  const DeviceInfo host = on_host().device();
  EXPECT_TRUE(host.fp64);
  EXPECT_FALSE(host.fixed_point);
}

TEST(WithoutDoubles, EverySpanInHostMemory) {
  for (const int places : kSpans) {
    SCOPED_TRACE(places);
    const Coordinates points = spanning(places);
    const std::size_t n = points.size() / 2;
    const Triangulation expected = on_host().triangulate(points.data(), n, all_options());
    const Triangulation found = triangulator().triangulate(points.data(), n, all_options());
    expect_same(found, expected);
    expect_note(found.statistics, places > kMostPlaces, "span " + std::to_string(places));
    EXPECT_EQ(found.statistics.triangles, expected.statistics.triangles);
    EXPECT_EQ(found.statistics.duplicates, expected.statistics.duplicates);
    if (places > kMostPlacesOfFloats) continue;
    const Floats floats = as_floats(points);
    const Triangulation of_floats = triangulator().triangulate(floats.data(), n, all_options());
    expect_same(of_floats, expected);
    EXPECT_EQ(of_floats.statistics.note, found.statistics.note);
  }
}

// Doubles round the extents of these sets, by which they are cut.
TEST(WithoutDoubles, ExtentsThatDoublesRound) {
  if (!has_fp64()) GTEST_SKIP() << "the run with doubles compiles the same kernels";
  Triangulator& with_lanes = triangulator_with("gpu,fixed_point=1");
  Coordinates points = {-1,         1,         0x1.08p56, -0x1.cp56, -0x1.cp56, -0x1.08p56,
                        -0x1.08p56, -0x1.cp56, -0x1.cp56, 0x1.08p56, -1,        0};
  Offsets offsets{0, 6};
  FixtureRandom random(56);
  const double large[] = {0x1p56, 0x1.08p56, 0x1.cp56};
  for (int set = 0; set < 300; ++set) {
    for (std::int64_t i = random.integer(5, 12); i > 0; --i) {
      for (int k = 0; k < 2; ++k) {
        points.push_back(random.integer(0, 1) * static_cast<double>(random.integer(-2, 2)) +
                         (random.integer(0, 2) == 0 ? 0 : static_cast<double>(random.integer(-1, 1))) *
                             large[random.integer(0, 2)]);
      }
    }
    offsets.push_back(points.size() / 2);
  }
  for (const Offsets& sets : {Offsets{0, 6}, offsets}) {
    expect_same(with_lanes.triangulate(points.data(), sets, all_options()),
                on_host().triangulate(points.data(), sets, all_options()));
  }
}

// Where neither doubles nor fixed point suffice, the error is the same, too.
TEST(WithoutDoubles, ErrorsAreThoseOfTheHost) {
  Coordinates too_wide = spanning(53), infinite = spanning(100);
  too_wide[9] = 1e-300;
  infinite[7] = INFINITY;
  for (const Coordinates& points : {too_wide, infinite}) {
    const auto message = [&points](Triangulator& used) -> std::string {
      try {
        used.triangulate(points.data(), points.size() / 2);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::input);
        return error.what();
      }
      return "no error";
    };
    EXPECT_EQ(message(triangulator()), message(on_host()));
  }
}

TEST(WithoutDoubles, SetsOfWhichOneIsTooWide) {
  for (const int places : {30, 62, 63, 200}) {
    SCOPED_TRACE(places);
    Coordinates points;
    Offsets offsets{0};
    for (const int each : {10, places, 40}) {
      const Coordinates set = spanning(each, 150, static_cast<std::uint64_t>(each));
      points.insert(points.end(), set.begin(), set.end());
      offsets.push_back(points.size() / 2);
    }
    const Triangulation expected = on_host().triangulate(points.data(), offsets, all_options());
    const Triangulation found = triangulator().triangulate(points.data(), offsets, all_options());
    expect_same(found, expected);
    expect_note(found.statistics, places > kMostPlaces, "triangulated on the host");
  }
}

// Sets of very different magnitudes, each of which fits.
TEST(WithoutDoubles, SetsThatFitOneByOne) {
  Coordinates points;
  Offsets offsets{0};
  for (const double scale : {0x1p-300, 1.0, 0x1p+300}) {
    for (const double x : spanning(50, 150)) points.push_back(x * scale);
    offsets.push_back(points.size() / 2);
  }
  const Triangulation found = triangulator().triangulate(points.data(), offsets, all_options());
  expect_same(found, on_host().triangulate(points.data(), offsets, all_options()));
  expect_note(found.statistics, false, "");
}

// Points in device memory, and that memory.
struct DeviceCall {
  DevicePoints points;
  Memory memory;
};

template <typename T>
DeviceCall device_call(const std::vector<T>& coordinates, std::size_t first) {
  DeviceCall call;
  std::vector<T> padded(2 * first, T(7));
  padded.insert(padded.end(), coordinates.begin(), coordinates.end());
  call.memory = embedder().upload(padded);
  call.points.memory = call.memory.get();
  call.points.count = coordinates.size() / 2;
  call.points.first = first;
  call.points.precision = sizeof(T) == sizeof(float) ? Precision::float32 : Precision::float64;
  return call;
}

// The arrays of a mesh in device memory, read on this queue.
Triangulation read(const DeviceTriangulation& mesh, cl_command_queue queue) {
  Triangulation result;
  const std::size_t triangles = mesh.triangle_offsets.back();
  for_each_array([&](const auto& array, std::size_t) {
    const std::size_t rows = array.row == RowOf::triangle   ? triangles
                             : array.row == RowOf::halfedge ? 3 * triangles
                             : array.row == RowOf::hull     ? mesh.hull_offsets.back()
                                                            : mesh.points;
    using Element = typename std::decay_t<decltype(array)>::Element;
    const cl_mem memory = (mesh.*array.buffer).memory();
    result.*array.values = embedder().download<Element>(memory, rows * array.columns, queue);
  });
  result.triangle_offsets = mesh.triangle_offsets;
  result.hull_offsets = mesh.hull_offsets;
  return result;
}

TEST(WithoutDoubles, EverySpanInDeviceMemory) {
  const Queue in_order = embedder().make_queue(),
              unordered = embedder().make_queue(CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
  for (const int places : kSpans) {
    SCOPED_TRACE(places);
    const Coordinates points = spanning(places);
    const std::size_t n = points.size() / 2;
    const Triangulation expected = on_host().triangulate(points.data(), n, all_options());
    for (const bool narrow : {false, true}) {
      if (narrow && places > kMostPlacesOfFloats) continue;
      for (const cl_command_queue queue :
           {static_cast<cl_command_queue>(nullptr), in_order.get(), unordered.get()}) {
        const DeviceCall call = narrow ? device_call(as_floats(points), 3) : device_call(points, 3);
        DeviceTriangulation mesh;
        cl_event done = nullptr;
        embedded().triangulate(call.points, mesh, kAll, {queue, {}, &done, false});
        check(clWaitForEvents(1, &done), "clWaitForEvents");
        clReleaseEvent(done);
        expect_same(read(mesh, embedder().queue()), expected);
        expect_note(mesh.statistics, places > kMostPlaces, "span " + std::to_string(places));
        EXPECT_EQ(mesh.point_offsets, (Offsets{0, n}));
        EXPECT_EQ(mesh.statistics.triangles, expected.statistics.triangles);
      }
    }
  }
}

// Buffers that the host may neither read nor write, of one call after the other, and a workspace.
TEST(WithoutDoubles, BuffersOfTheCallerAndAWorkspace) {
  const Coordinates wide = spanning(100), narrow = spanning(30);
  const std::size_t n = wide.size() / 2;
  const auto hidden = [](std::size_t bytes) { return embedder().make_buffer(bytes, CL_MEM_HOST_NO_ACCESS); };
  const Memory workspace = embedder().make_buffer(embedded().workspace_bytes(n));
  for (const bool has_workspace : {false, true}) {
    embedded().use_workspace(has_workspace ? workspace.get() : nullptr);
    for (const Coordinates* points : {&wide, &narrow, &wide}) {
      const Memory visible = embedder().upload(*points), input = hidden(2 * n * sizeof(double));
      check(clEnqueueCopyBuffer(embedded().queue(), visible.get(), input.get(), 0, 0, 2 * n * sizeof(double),
                                0, nullptr, nullptr),
            "clEnqueueCopyBuffer");
      const Memory triangles = hidden(24 * n), copy = embedder().make_buffer(24 * n);
      DeviceTriangulation mesh;
      mesh.triangles = DeviceBuffer(triangles.get());
      embedded().triangulate({input.get(), n}, mesh);
      check(clEnqueueCopyBuffer(embedded().queue(), triangles.get(), copy.get(), 0, 0, 24 * n, 0, nullptr,
                                nullptr),
            "clEnqueueCopyBuffer");
      const std::vector<std::int32_t> expected = on_host().triangulate(points->data(), n).triangles;
      EXPECT_TRUE(
          same(embedder().download<std::int32_t>(copy.get(), expected.size(), embedded().queue()), expected));
    }
  }
  embedded().use_workspace(nullptr);
}

TEST(WithoutDoubles, SetsInDeviceMemory) {
  Coordinates points;
  Offsets offsets{0};
  for (const int places : {10, 90, 40}) {
    const Coordinates set = spanning(places, 150);
    points.insert(points.end(), set.begin(), set.end());
    offsets.push_back(points.size() / 2);
  }
  DeviceCall call = device_call(points, 0);
  const std::vector<std::int32_t> numbers(offsets.begin(), offsets.end());
  const Memory device_offsets = embedder().upload(numbers);
  call.points.device_offsets = device_offsets.get();
  call.points.sets = 3;
  DeviceTriangulation mesh;
  embedded().triangulate(call.points, mesh, kAll);
  expect_same(read(mesh, embedded().queue()), on_host().triangulate(points.data(), offsets, all_options()));
  EXPECT_EQ(mesh.point_offsets, offsets);
  expect_note(mesh.statistics, true, "span 90");
}

// What is derived from triangulations, in host and in device memory, of points that fit and of others.
class WithoutDoublesDerived : public ::testing::TestWithParam<int> {
 protected:
  WithoutDoublesDerived()
      : points_(spanning(GetParam(), 400)),
        n_(points_.size() / 2),
        mesh_(on_host().triangulate(points_.data(), n_)),
        memory_(embedder().upload(points_)) {
    embedded().triangulate(device_points(), on_device_, kAll);
  }
  DevicePoints device_points() const { return {memory_.get(), n_}; }
  template <typename T>
  static void expect_array(const DeviceBuffer& buffer, const std::vector<T>& expected) {
    EXPECT_TRUE(same(embedder().download<T>(buffer.memory(), expected.size(), embedded().queue()), expected));
  }
  template <typename T>
  static void expect_values(const DeviceBuffer& buffer, const std::vector<T>& expected) {
    expect_equal(embedder().download<T>(buffer.memory(), expected.size(), embedded().queue()), expected);
  }
  // Not a number is the same as itself.
  static void expect_equal(const std::vector<double>& found, const std::vector<double>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_TRUE(found[i] == expected[i] || (std::isnan(found[i]) && std::isnan(expected[i]))) << i;
    }
  }
  std::vector<double> corners() const {
    const double most = std::ldexp(1.0, GetParam());
    return {0, 0, most, 0, most, most / 2, most / 4, most};
  }

  Coordinates points_;
  std::size_t n_;
  Triangulation mesh_;
  Memory memory_;
  DeviceTriangulation on_device_;
};

TEST_P(WithoutDoublesDerived, Voronoi) {
  const Voronoi expected = on_host().voronoi(points_.data(), n_, mesh_);
  const Voronoi found = triangulator().voronoi(points_.data(), n_, mesh_);
  expect_equal(found.circumcentres, expected.circumcentres);
  EXPECT_TRUE(same(found.cells, expected.cells));
  EXPECT_TRUE(same(found.cell_offsets, expected.cell_offsets));
  EXPECT_TRUE(same(found.unbounded, expected.unbounded));
  DeviceVoronoi result;
  embedded().voronoi(device_points(), on_device_, result);
  expect_values(result.circumcentres, expected.circumcentres);
  expect_array(result.cells, expected.cells);
  expect_array(result.cell_offsets, expected.cell_offsets);
  expect_array(result.unbounded, expected.unbounded);
}

TEST_P(WithoutDoublesDerived, ClippedVoronoi) {
  const std::vector<double> polygon = corners();
  const ClippedVoronoi expected = on_host().clipped_voronoi(points_.data(), n_, mesh_, polygon.data(), 4);
  const ClippedVoronoi found = triangulator().clipped_voronoi(points_.data(), n_, mesh_, polygon.data(), 4);
  expect_equal(found.vertices, expected.vertices);
  expect_equal(found.areas, expected.areas);
  expect_equal(found.centroids, expected.centroids);
  DeviceClippedVoronoi result;
  embedded().clipped_voronoi(device_points(), on_device_, polygon.data(), 4, result);
  EXPECT_EQ(2 * result.vertex_count, expected.vertices.size());
  expect_values(result.vertices, expected.vertices);
  expect_array(result.offsets, expected.offsets);
  expect_values(result.areas, expected.areas);
}

TEST_P(WithoutDoublesDerived, Relaxation) {
  const std::vector<double> polygon = corners();
  const std::vector<double> expected = on_host().relax(points_.data(), n_, polygon.data(), 4, 2);
  expect_equal(triangulator().relax(points_.data(), n_, polygon.data(), 4, 2), expected);
  DeviceBuffer result;
  embedded().relax(device_points(), polygon.data(), 4, 2, result);
  expect_values(result, expected);
}

TEST_P(WithoutDoublesDerived, Queries) {
  Coordinates queries = spanning(GetParam(), 300, 9);
  queries.insert(queries.end(), points_.begin(), points_.begin() + 40);
  const std::size_t m = queries.size() / 2;
  std::vector<double> values;
  for (std::size_t i = 0; i < 2 * n_; ++i) values.push_back(std::sin(static_cast<double>(i)));
  Locator of_host(on_host(), points_.data(), n_, mesh_), named(triangulator(), points_.data(), n_, mesh_),
      there(embedded(), device_points(), on_device_);
  // Made from host memory, it answers queries in device memory, too.
  Locator both(embedded(), points_.data(), n_, mesh_);
  const Memory query_memory = embedder().upload(queries), value_memory = embedder().upload(values);
  const DevicePoints device_queries{query_memory.get(), m};

  EXPECT_TRUE(same(named.locate(queries.data(), m), of_host.locate(queries.data(), m)));
  EXPECT_TRUE(same(named.nearest(queries.data(), m), of_host.nearest(queries.data(), m)));
  for (Locator* locator : {&there, &both}) {
    DeviceBuffer triangles, nearest;
    locator->locate(device_queries, triangles);
    locator->nearest(device_queries, nearest);
    expect_array(triangles, of_host.locate(queries.data(), m));
    expect_array(nearest, of_host.nearest(queries.data(), m));
  }
  // Of single precision, and so fine that they are left to doubles.
  std::vector<float> narrow(queries.begin(), queries.end());
  const std::vector<double> rounded(narrow.begin(), narrow.end());
  const Memory narrow_memory = embedder().upload(narrow);
  const DevicePoints narrow_queries{narrow_memory.get(), m, Precision::float32};
  Coordinates fine = queries;
  fine[1] = 0x1p-400;
  const Memory fine_memory = embedder().upload(fine);
  EXPECT_TRUE(same(named.nearest(fine.data(), m), of_host.nearest(fine.data(), m)));
  for (Locator* locator : {&there, &both}) {
    DeviceBuffer triangles, nearest;
    locator->locate(narrow_queries, triangles);
    expect_array(triangles, of_host.locate(rounded.data(), m));
    locator->nearest(DevicePoints{fine_memory.get(), m}, nearest);
    expect_array(nearest, of_host.nearest(fine.data(), m));
  }
  InterpolationOptions options;
  options.columns = 2;
  const std::vector<double> gradients = of_host.gradients(values.data(), 2);
  expect_equal(named.gradients(values.data(), 2), gradients);
  DeviceBuffer device_gradients;
  there.gradients(value_memory.get(), device_gradients, 2);
  expect_values(device_gradients, gradients);
  for (const Interpolation method :
       {Interpolation::linear, Interpolation::nearest, Interpolation::clough_tocher, Interpolation::sibson,
        Interpolation::laplace}) {
    options.method = method;
    const std::vector<double> expected = of_host.interpolate(values.data(), queries.data(), m, options);
    expect_equal(named.interpolate(values.data(), queries.data(), m, options), expected);
    for (Locator* locator : {&there, &both}) {
      DeviceBuffer results;
      locator->interpolate(value_memory.get(), device_queries, results, options);
      expect_values(results, expected);
    }
  }
  InterpolationOptions with_gradients = options;
  with_gradients.method = Interpolation::clough_tocher;
  with_gradients.device_gradients = device_gradients.memory();
  DeviceBuffer results;
  there.interpolate(value_memory.get(), device_queries, results, with_gradients);
  with_gradients.device_gradients = nullptr;
  with_gradients.gradients = gradients.data();
  expect_values(results, of_host.interpolate(values.data(), queries.data(), m, with_gradients));
}

INSTANTIATE_TEST_SUITE_P(Spans, WithoutDoublesDerived, ::testing::Values(20, 50, 70));

// A square grid of points that are moved a little, and segments through its rows.
struct Rows {
  explicit Rows(double smallest) {
    FixtureRandom random(4);
    for (std::int32_t k = 0; k < kSide * kSide; ++k) {
      points.push_back(k % kSide + static_cast<double>(static_cast<float>(0.4 * random.unit())));
      points.push_back(k / kSide + static_cast<double>(static_cast<float>(0.4 * random.unit())));
      if (k % kSide == kSide - 1) segments.insert(segments.end(), {k - kSide + 1, k});
    }
    points[0] = smallest;
    constraints.segments = segments.data();
    constraints.segment_count = segments.size() / 2;
  }
  static constexpr std::int32_t kSide = 24;
  std::size_t n() const { return points.size() / 2; }
  Coordinates points;
  std::vector<std::int32_t> segments;
  Constraints constraints;
};

TEST(WithoutDoubles, Constraints) {
  for (const double smallest : {0.25, 0x1p-90}) {
    const Rows rows(smallest);
    ConstrainedOptions options;
    options.labels = true;
    const ConstrainedTriangulation expected =
        on_host().constrained(rows.points.data(), rows.n(), rows.constraints, options);
    const ConstrainedTriangulation found =
        triangulator().constrained(rows.points.data(), rows.n(), rows.constraints, options);
    expect_same(found, expected);
    EXPECT_TRUE(same(found.constrained, expected.constrained));
    EXPECT_TRUE(same(found.constraint_edges, expected.constraint_edges));
    EXPECT_TRUE(same(found.depths, expected.depths));
    EXPECT_TRUE(same(found.regions, expected.regions));
    expect_note(found.statistics, smallest < 1e-9, "triangulated on the host");

    const Memory memory = embedder().upload(rows.points), ends = embedder().upload(rows.segments);
    DeviceTriangulation mesh;
    embedded().constrained({memory.get(), rows.n()}, {ends.get(), rows.segments.size() / 2}, mesh);
    const auto array = [](const DeviceBuffer& buffer, std::size_t count) {
      return embedder().download<std::int32_t>(buffer.memory(), count, embedded().queue());
    };
    EXPECT_EQ(array(mesh.triangles, expected.triangles.size()), expected.triangles);
    EXPECT_EQ(array(mesh.neighbors, expected.neighbors.size()), expected.neighbors);
    EXPECT_EQ(array(mesh.constraint_edges, expected.constraint_edges.size()), expected.constraint_edges);
    EXPECT_EQ(array(mesh.piece_edges, expected.piece_edges.size()), expected.piece_edges);
    expect_note(mesh.statistics, smallest < 1e-9, "triangulated on the host");
  }
}

// Seeds of holes are no multiples of the points' unit, and crossings are rounded.
TEST(WithoutDoubles, HolesAndCrossings) {
  for (const double smallest : {0.25, 0x1p-90}) {
    Rows rows(smallest);
    constexpr std::int32_t kSide = Rows::kSide;
    for (const std::int32_t first : {3 * kSide + 2, 9 * kSide + 11, 15 * kSide + 7}) {
      const std::int32_t corners[] = {first, first + 3, first + 3 * kSide + 3, first + 3 * kSide};
      for (int k = 0; k < 4; ++k)
        rows.segments.insert(rows.segments.end(), {corners[k], corners[(k + 1) % 4]});
    }
    const std::vector<double> holes = {3.7 + 1e-13, 4.5, 12.3, 10.4 + 1e-14};
    rows.constraints.segments = rows.segments.data();
    rows.constraints.segment_count = rows.segments.size() / 2;
    rows.constraints.holes = holes.data();
    rows.constraints.hole_count = holes.size() / 2;
    ConstrainedOptions options;
    options.labels = true;
    options.crossings = Crossings::split;
    const auto result_of = [&](Triangulator& used) {
      return used.constrained(rows.points.data(), rows.n(), rows.constraints, options);
    };
    const ConstrainedTriangulation expected = result_of(on_host()), found = result_of(triangulator());
    EXPECT_GT(expected.added_points.size(), 0U);
    expect_same(found, expected);
    EXPECT_TRUE(same(found.constrained, expected.constrained));
    EXPECT_TRUE(same(found.added_points, expected.added_points));
    EXPECT_TRUE(same(found.depths, expected.depths));
    EXPECT_TRUE(same(found.regions, expected.regions));
    EXPECT_TRUE(same(found.piece_edges, expected.piece_edges));
    rows.constraints.hole_count = 0;
    EXPECT_LT(expected.triangles.size(), result_of(on_host()).triangles.size());
  }
}

TEST(WithoutDoubles, Refinement) {
  const Rows rows(0.25);
  ConstrainedOptions options;
  options.refinement.min_angle = 25;
  const auto result_of = [&](Triangulator& used) {
    return used.constrained(rows.points.data(), rows.n(), rows.constraints, options);
  };
  const ConstrainedTriangulation expected = result_of(on_host()), found = result_of(triangulator());
  EXPECT_GT(expected.added_points.size(), 0U);
  expect_same(found, expected);
  EXPECT_TRUE(same(found.added_points, expected.added_points));
  expect_note(found.statistics, true, "refined on the host");
}

TEST(WithoutDoubles, Polygons) {
  Polygons polygons;
  const Coordinates ring = {0, 0, 4, 0, 4, 4, 0, 4, 1, 1, 1, 3, 3, 3, 3, 1};
  polygons.coordinates = ring.data();
  polygons.ring_offsets = {0, 4, 8};
  polygons.polygon_offsets = {0, 2};
  expect_same(triangulator().polygons(polygons), on_host().polygons(polygons));
}

TEST(WithoutDoubles, Modes) {
  const Coordinates points = spanning(40);
  const std::size_t n = points.size() / 2;
  const auto expect_note = [](const Statistics& statistics) {
    EXPECT_EQ(statistics.device == "host", !has_fp64());
    EXPECT_EQ(statistics.note.find("fp64") != std::string::npos, !has_fp64());
  };
  const Triangulation expected = on_host().triangulate(points.data(), n);
  for (const research::ModeInfo& mode : research::list_modes()) {
    SCOPED_TRACE(mode.name);
    research::Options options;
    options.mode = mode.mode;
    const auto found = research::triangulate(triangulator(), points.data(), n, options);
    EXPECT_EQ(found.triangles.size(), expected.triangles.size());
    if (!mode.on_host && mode.mode != research::Mode::blocks) expect_note(found.statistics);
  }
  expect_note(research::partition(triangulator(), points.data(), n, 2).statistics);
}

TEST(WithoutDoubles, Chunks) {
  for (const int places : {40, 90}) {
    const Coordinates points = spanning(places, 30000);
    const std::size_t n = points.size() / 2;
    const auto compute = [&](const std::string& device, std::vector<std::int32_t>& triangles) {
      triangles.resize(6 * n);
      ChunkOptions options;
      options.devices = {device};
      options.chunk_points = 5000;
      MeshArrays<std::int32_t> arrays;
      arrays.triangles = triangles.data();
      const ChunkStatistics statistics = triangulate_chunks(points.data(), n, arrays, options);
      triangles.resize(3 * statistics.triangles);
      return statistics;
    };
    std::vector<std::int32_t> expected, found;
    const ChunkStatistics of_host = compute("host", expected);
    const ChunkStatistics statistics = compute(device_under_test(), found);
    EXPECT_TRUE(same(found, expected));
    EXPECT_EQ(of_host.host_points, 0U);
    EXPECT_EQ(statistics.host_points > 0, places > kMostPlaces && !has_fp64());
    EXPECT_EQ(statistics.note.empty(), statistics.host_points == 0);
  }
}

// A device whose doubles fail the self test computes in fixed point, and leaves the rest to the host.
TEST(WithoutDoubles, DoublesThatAreNotExact) {
  if (!has_fp64()) GTEST_SKIP() << "there are no doubles";
  const ScopedEnvironment own_tuning("FLAUNAY_TUNING", nullptr);
  EXPECT_FALSE(Triangulator(device_under_test()).device().fixed_point);
  const ChangedKernels inexact("call/self_test.cl", [](const std::string& text) {
    std::string changed = text;
    const std::string end = "failed[0] = bits;";
    changed.replace(changed.find(end), end.size(), "failed[0] = bits | 8;");
    return changed;
  });
  Triangulator inexact_device(device_under_test());
  EXPECT_TRUE(inexact_device.device().fp64);
  EXPECT_TRUE(inexact_device.device().fixed_point);
  EXPECT_TRUE(list_devices(true).front().self_test_passed);
  for (const int places : {40, 63}) {
    const Coordinates points = spanning(places);
    const std::size_t n = points.size() / 2;
    const Triangulation found = inexact_device.triangulate(points.data(), n, all_options());
    expect_same(found, on_host().triangulate(points.data(), n, all_options()));
    EXPECT_EQ(found.statistics.note.empty(), places <= kMostPlaces);
    EXPECT_EQ(found.statistics.device == "host", places > kMostPlaces);
  }
}

// If no device is named and there is no GPU, the host computes and has nothing to say.
TEST(WithoutDoubles, TheOwnChoice) {
  const ScopedEnvironment unset("FLAUNAY_DEVICE", nullptr);
  Triangulator own;
  if (own.device().type != "CPU") GTEST_SKIP() << "there is a GPU";
  const Coordinates points = spanning(100, 5000);
  const Triangulation found = own.triangulate(points.data(), 5000);
  EXPECT_EQ(found.statistics.device, "host");
  EXPECT_EQ(found.statistics.note, "");
  // Device memory is that of the first device.
  EXPECT_NE(own.context(), nullptr);
}

}  // namespace
}  // namespace flaunay::testing
