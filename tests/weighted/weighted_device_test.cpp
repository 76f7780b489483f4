// Weighted points on a device: the arrays are those of the host, which weighted_test.cpp checks, with the
// sizes of CPUs and of GPUs, in host and in device memory.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "flaunay/device_memory.hpp"
#include "flaunay/weighted.hpp"
#include "tests/support/embedded.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/same.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing::weights {
namespace {

using Numbers = std::vector<double>;
using Offsets = std::vector<std::size_t>;

struct WeightedPoints {
  std::string name;
  Coordinates coordinates;
  Numbers weights;
};

Options all_arrays() {
  Options options;
  options.neighbors = options.halfedges = options.areas = true;
  return options;
}
constexpr Parts kAllParts{true, true, true, true, true, true};

/// Few points and many are hidden; all but corners, by a plane or by one point; heavier ones in the same
/// place; and none, of equal weights.
std::vector<WeightedPoints> weighted_points(std::size_t n) {
  FixtureRandom random(n);
  std::vector<WeightedPoints> all;
  const auto add = [&](const std::string& name, const Coordinates& points, const auto& weight) {
    Numbers weights;
    for (std::size_t k = 0; k < points.size(); k += 2) weights.push_back(weight(points[k], points[k + 1]));
    all.push_back({name, points, weights});
  };
  const Coordinates uniform = make_fixture("uniform", n, n);
  const double share = 1 / static_cast<double>(n);
  add("uniform", uniform, [&](double, double) { return random.unit() * share; });
  add("negative", uniform, [&](double, double) { return random.unit() - 4; });
  add("on a plane", uniform, [](double x, double y) { return std::fma(x, x, y * y); });
  add("equal", uniform, [](double, double) { return 0.25; });
  add("grid", make_fixture("grid", n, 1),
      [&](double, double) { return static_cast<double>(random.integer(0, 3)); });
  add("circle", make_fixture("integer-circle", n, 1),
      [&](double, double) { return static_cast<double>(random.integer(0, 1)); });
  Coordinates few_places, line;
  for (std::size_t i = 0; i < n; ++i) {
    for (int k = 0; k < 2; ++k) few_places.push_back(static_cast<double>(random.integer(0, 2)));
    line.insert(line.end(), {std::floor(random.unit() * static_cast<double>(n)), 0.5});
  }
  // With one place in which weights ascend, and one in which they descend.
  double up = 0;
  add("few places", few_places, [&](double x, double y) {
    return x + y == 0 ? ++up : x + y == 4 ? -++up : static_cast<double>(random.integer(-2, 2));
  });
  add("line", line, [&](double, double) { return static_cast<double>(random.integer(-9, 9)); });
  all.push_back(all[0]);
  all.back().name = "one heavy";
  all.back().weights[n / 2] = 100;
  return all;
}

Triangulation on_host(const WeightedPoints& points, const Offsets& offsets) {
  static Triangulator host("host");
  return host.triangulate(points.coordinates.data(), offsets,
                          Space::plane().with_weights(points.weights.data()), all_arrays());
}

DevicePoints points_in(const Memory& memory, const Offsets& offsets) {
  DevicePoints points;
  points.memory = memory.get();
  points.count = offsets.back();
  points.offsets = offsets;
  return points;
}

DevicePoints with_weights(DevicePoints points, cl_mem weights, const Space& space = Space::plane()) {
  points.weights = weights;
  points.space = space;
  return points;
}

Enqueue on_own() {
  Enqueue enqueue;
  enqueue.queue = embedder().queue();
  return enqueue;
}

void expect_same_in_host_memory(const Triangulation& found, const Triangulation& expected) {
  expect_same_arrays(found, expected);
  EXPECT_TRUE(same(found.hidden, expected.hidden));
}

void expect_same_on_device(const DeviceTriangulation& found, const Triangulation& expected) {
  expect_same_sizes(found, expected);
  const auto expect_array = [](const DeviceBuffer& buffer, const auto& values, const char* name) {
    using Element = typename std::decay_t<decltype(values)>::value_type;
    EXPECT_TRUE(same(embedder().download<Element>(buffer.memory(), values.size()), values)) << name;
  };
  expect_array(found.triangles, expected.triangles, "triangles");
  expect_array(found.neighbors, expected.neighbors, "neighbors");
  expect_array(found.halfedges, expected.halfedges, "halfedges");
  expect_array(found.hull, expected.hull, "hull");
  expect_array(found.representatives, expected.representatives, "representatives");
  expect_array(found.areas, expected.areas, "areas");
  ASSERT_EQ(found.hidden_count, expected.hidden.size());
  expect_array(found.hidden, expected.hidden, "hidden");
}

void expect_as_on_host(const WeightedPoints& points, const Offsets& offsets, DeviceTriangulation& found) {
  SCOPED_TRACE(points.name + " " + std::to_string(offsets.back()));
  const Triangulation expected = on_host(points, offsets);
  for (const char* const tuning : {"", "gpu:32"}) {
    SCOPED_TRACE(tuning);
    expect_same_in_host_memory(triangulator_with(tuning).triangulate(
                                   points.coordinates.data(), offsets,
                                   Space::plane().with_weights(points.weights.data()), all_arrays()),
                               expected);
  }
  const Memory memory = embedder().upload(points.coordinates), weights = embedder().upload(points.weights);
  embedded().triangulate(with_weights(points_in(memory, offsets), weights.get()), found, kAllParts, on_own());
  expect_same_on_device(found, expected);
}

TEST(SmallWeightedOnDevice, IsAsOnTheHost) {
  DeviceTriangulation found;
  for (const std::size_t n : {1, 2, 3, 4, 9, 60}) {
    for (const WeightedPoints& points : weighted_points(n)) expect_as_on_host(points, {0, n}, found);
  }
}

TEST(WeightedOnDevice, ManyPointsAreAsOnTheHost) {
  DeviceTriangulation found;
  std::size_t hidden = 0;
  for (const WeightedPoints& points : weighted_points(20000)) {
    expect_as_on_host(points, {0, points.weights.size()}, found);
    hidden += found.hidden_count;
  }
  EXPECT_GT(hidden, 40000u);
}

TEST(SmallWeightedOnDevice, SetsAreEachAsOnTheHost) {
  WeightedPoints all{"sets", {}, {}};
  Offsets offsets{0, 0};
  for (const std::size_t n : {3, 40}) {
    for (const WeightedPoints& points : weighted_points(n)) {
      // Of magnitudes for which each set has its own scale, and weights that all of these take.
      const int shift = static_cast<int>(offsets.size() % 3) * 300 - 400;
      for (const double x : points.coordinates) all.coordinates.push_back(std::ldexp(x, shift));
      for (const double w : points.weights) all.weights.push_back(std::ldexp(std::floor(w), 2 * shift));
      offsets.push_back(all.weights.size());
    }
  }
  offsets.push_back(offsets.back());
  DeviceTriangulation found;
  expect_as_on_host(all, offsets, found);
  EXPECT_GT(found.hidden_count, 100u);
}

void expect_torus_as_on_host(const WeightedPoints& points, const Offsets& offsets, const Period& period) {
  SCOPED_TRACE(points.name + " " + std::to_string(offsets.back()));
  const Numbers& weights = points.weights;
  static Triangulator host("host");
  const Triangulation expected =
      host.triangulate(points.coordinates.data(), offsets, Space::torus(period).with_weights(weights.data()));
  const Memory memory = embedder().upload(points.coordinates), given = embedder().upload(weights);
  DeviceTriangulation found;
  embedded().triangulate(with_weights(points_in(memory, offsets), given.get(), Space::torus(period)), found,
                         Parts(), on_own());
  EXPECT_EQ(found.triangle_offsets, expected.triangle_offsets);
  EXPECT_EQ(found.images, expected.images);
  ASSERT_EQ(found.hidden_count, expected.hidden.size());
  const auto expect_array = [](const DeviceBuffer& buffer, const auto& values, const char* name) {
    using Element = typename std::decay_t<decltype(values)>::value_type;
    EXPECT_TRUE(same(embedder().download<Element>(buffer.memory(), values.size()), values)) << name;
  };
  expect_array(found.places, expected.places, "places");
  expect_array(found.triangles, expected.triangles, "triangles");
  expect_array(found.corner_offsets, expected.corner_offsets, "corner offsets");
  expect_array(found.neighbors, expected.neighbors, "neighbors");
  expect_array(found.representatives, expected.representatives, "representatives");
  expect_array(found.hidden, expected.hidden, "hidden");
}

TEST(SmallWeightedOnDevice, WithAPeriodIsAsOnTheHost) {
  WeightedPoints all{"sets", {}, {}};
  Offsets offsets{0, 0};
  for (const std::size_t n : {1, 3, 40}) {
    for (const WeightedPoints& points : weighted_points(n)) {
      for (const Period& period : {Period{}, {0.5, HUGE_VAL}})
        expect_torus_as_on_host(points, {0, n}, period);
      all.coordinates.insert(all.coordinates.end(), points.coordinates.begin(), points.coordinates.end());
      all.weights.insert(all.weights.end(), points.weights.begin(), points.weights.end());
      offsets.push_back(all.weights.size());
    }
  }
  expect_torus_as_on_host(all, offsets, {});
}

TEST(WeightedOnDevice, ManyPointsWithAPeriodAreAsOnTheHost) {
  for (const WeightedPoints& points : weighted_points(6000)) expect_torus_as_on_host(points, {0, 6000}, {});
}

TEST(SmallWeightedOnDevice, CallersBuffersAndErrors) {
  WeightedPoints points = weighted_points(40)[0];
  const std::size_t n = points.weights.size();
  const Memory memory = embedder().upload(points.coordinates), few = embedder().upload(Numbers(n - 1)),
               short_hidden = embedder().make_buffer(4 * n - 1), hidden = embedder().make_buffer(4 * n);
  Memory weights = embedder().upload(points.weights);
  const DevicePoints given = points_in(memory, {0, n});
  DeviceTriangulation found;
  const auto run = [&](cl_mem with) {
    embedded().triangulate(with_weights(given, with), found, kAllParts, on_own());
  };
  found.hidden = DeviceBuffer(short_hidden.get());
  expect_error(ErrorKind::usage, {"hidden", "too small"}, [&] { run(weights.get()); });
  found.hidden = DeviceBuffer(weights.get());
  expect_error(ErrorKind::usage, "two things", [&] { run(weights.get()); });
  found.hidden = DeviceBuffer(hidden.get());
  expect_error(ErrorKind::usage, {"weights", "too small"}, [&] { run(few.get()); });
  run(weights.get());
  EXPECT_EQ(found.hidden.memory(), hidden.get());
  expect_same_on_device(found, on_host(points, {0, n}));
  points.weights[17] = 1e300;
  points.weights[5] = NAN;
  weights = embedder().upload(points.weights);
  cl_event done = reinterpret_cast<cl_event>(8);
  Enqueue enqueue = on_own();
  enqueue.event = &done;
  expect_error(ErrorKind::input, "point 5 has a weight that is not finite: nan", [&] {
    embedded().triangulate(with_weights(given, weights.get()), found, kAllParts, enqueue);
  });
  EXPECT_EQ(done, nullptr);
  embedded().triangulate(with_weights({}, nullptr), found);
  EXPECT_EQ(found.hidden_count, 0u);
  EXPECT_EQ(found.triangle_offsets, (Offsets{0, 0}));
}

TEST(SmallWeightedOnDevice, ANoteSaysWhatTheDeviceLeavesToTheHost) {
  const WeightedPoints points = weighted_points(40)[0];
  const Triangulation made = triangulator().triangulate(points.coordinates.data(), points.weights.size(),
                                                        Space::plane().with_weights(points.weights.data()));
  const bool is_left = !triangulator().device().fp64;
  EXPECT_EQ(made.statistics.device == "host", is_left);
  EXPECT_EQ(made.statistics.note.find("for weights: triangulated on the host") != std::string::npos, is_left);
}

}  // namespace
}  // namespace flaunay::testing::weights
