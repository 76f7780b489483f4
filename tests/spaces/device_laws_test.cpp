// What holds in device memory in every space: results have the bytes of the call for host memory, wherever
// points, sets and results lie, and errors name the point.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "flaunay/device_memory.hpp"
#include "tests/spaces/spaces.hpp"
#include "tests/support/embedded.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/same.hpp"

namespace flaunay::testing::spaces {
namespace {

Triangulator& on_host() {
  static Triangulator host("host");
  return host;
}

class DeviceLaws : public ::testing::TestWithParam<TestSpace> {
 protected:
  // Points of the space, whose coordinates and weights are in these buffers.
  DevicePoints points_in(const Memory& memory, const Memory& weights, std::size_t count) const {
    DevicePoints points;
    points.memory = memory.get();
    points.weights = weights.get();
    points.count = count;
    points.space = space_.space;
    return points;
  }
  // The weights of points, if they have some; otherwise no memory.
  Memory weights_of(const Numbers& points) const {
    if (!space_.has_weights) return {};
    Numbers weights;
    for (std::size_t i = 2; i < points.size(); i += space_.width) weights.push_back(points[i]);
    return embedder().upload(weights);
  }
  template <typename T>
  std::vector<T> without_weights(const std::vector<T>& points) const {
    if (!space_.has_weights) return points;
    std::vector<T> coordinates;
    for (std::size_t i = 0; i < points.size(); i += space_.width)
      coordinates.insert(coordinates.end(), {points[i], points[i + 1]});
    return coordinates;
  }

  Parts wanted() const { return {true, true, space_.is_plane(), true, true, space_.is_plane()}; }

  static Enqueue on_own() {
    Enqueue enqueue;
    enqueue.queue = embedder().queue();
    return enqueue;
  }

  template <typename T>
  static void expect_array(const DeviceBuffer& buffer, const std::vector<T>& values) {
    EXPECT_TRUE(same(embedder().download<T>(buffer.memory(), values.size()), values));
  }

  // That a call writes what a call for host memory returns, twice: the second has the memory of the first.
  DeviceTriangulation expect_same(const DevicePoints& points, const Numbers& numbers,
                                  const Offsets& offsets) const {
    const Triangulation expected = space_.triangulate(on_host(), numbers, offsets);
    DeviceTriangulation found;
    for (int call = 0; call < 2; ++call) {
      embedded().triangulate(points, found, wanted(), on_own());
      EXPECT_EQ(found.points, offsets.back());
      EXPECT_EQ(found.images, expected.images);
      EXPECT_EQ(found.space.period.x, expected.space.period.x);
      EXPECT_EQ(found.space.period.y, expected.space.period.y);
      EXPECT_EQ(found.space.period.shear, expected.space.period.shear);
      EXPECT_EQ(found.point_offsets, offsets);
      expect_same_sizes(found, expected);
      EXPECT_TRUE(found.parts.triangles && found.parts.neighbors && found.parts.representatives);
      expect_array(found.places, expected.places);
      expect_array(found.triangles, expected.triangles);
      expect_array(found.corner_offsets, expected.corner_offsets);
      expect_array(found.neighbors, expected.neighbors);
      expect_array(found.halfedges, expected.halfedges);
      expect_array(found.hull, expected.hull);
      expect_array(found.representatives, expected.representatives);
      expect_array(found.areas, expected.areas);
      EXPECT_EQ(found.hidden_count, expected.hidden.size());
      expect_array(found.hidden, expected.hidden);
    }
    return found;
  }
  DeviceTriangulation expect_same(const Numbers& numbers, Offsets offsets = {}) const {
    if (offsets.empty()) offsets = {0, numbers.size() / space_.width};
    const Memory memory = embedder().upload(without_weights(numbers)), weights = weights_of(numbers);
    DevicePoints points = points_in(memory, weights, offsets.back());
    points.offsets = offsets;
    return expect_same(points, numbers, offsets);
  }

  const TestSpace space_ = GetParam();
  const std::vector<Case> cases_ = cases(space_);
};
INSTANTIATE_TEST_SUITE_P(SmallSpaces, DeviceLaws, ::testing::ValuesIn(all_spaces()),
                         [](const auto& of) { return of.param.name; });

TEST_P(DeviceLaws, ResultsAreThoseOfTheHost) {
  for (const Case& given : cases_) {
    SCOPED_TRACE(given.name);
    expect_same(given.numbers);
  }
}

class LargeDeviceLaws : public DeviceLaws {};
INSTANTIATE_TEST_SUITE_P(Spaces, LargeDeviceLaws, ::testing::ValuesIn(all_spaces()),
                         [](const auto& of) { return of.param.name; });

TEST_P(LargeDeviceLaws, ResultsAreThoseOfTheHost) {
  const std::vector<Case> large = large_cases(space_);
  for (const Case& given : large) {
    SCOPED_TRACE(given.name);
    const DeviceTriangulation found = expect_same(given.numbers);
    // Less than triangles take.
    if (&given == &large[0] && embedded().device().fp64) {
      EXPECT_LT(found.statistics.bytes_to_host, 24 * found.points);
    }
  }
  // Some sets are done before others.
  Offsets offsets;
  const Numbers sets = joined(large, space_.width, offsets);
  expect_same(sets, offsets);
  if (space_.is_plane() && space_.has_weights) {
    // Of magnitudes for which each set has its own scale, and weights that all of these take.
    Numbers scaled = sets;
    for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
      const int shift = static_cast<int>(s % 3) * 300 - 400;
      for (std::size_t k = 3 * offsets[s]; k < 3 * offsets[s + 1]; ++k)
        scaled[k] = std::ldexp(k % 3 < 2 ? sets[k] : std::floor(8 * sets[k]), k % 3 < 2 ? shift : 2 * shift);
    }
    expect_same(scaled, offsets);
  }
  // With the sizes of GPUs.
  expect_same_arrays(space_.triangulate(triangulator_with("gpu:32"), sets, offsets),
                     space_.triangulate(on_host(), sets, offsets));
}

TEST_P(DeviceLaws, PointsOfSetsBeginAnywhereInEitherPrecision) {
  constexpr std::size_t kFirst = 3;
  Offsets offsets;
  const Numbers points = joined(cases_, space_.width, offsets);
  const std::vector<std::int32_t> ids(offsets.begin(), offsets.end());
  const Memory device_offsets = embedder().upload(ids);
  const auto expect_in = [&](const auto& numbers, Precision precision) {
    using T = typename std::decay_t<decltype(numbers)>::value_type;
    const Numbers wide(numbers.begin(), numbers.end());
    const std::vector<T> coordinates = without_weights(numbers);
    std::vector<T> all(kFirst * coordinates.size() / offsets.back(), std::numeric_limits<T>::quiet_NaN());
    all.insert(all.end(), coordinates.begin(), coordinates.end());
    const Memory memory = embedder().upload(all), weights = weights_of(wide);
    for (const bool are_on_device : {false, true}) {
      DevicePoints given = points_in(memory, weights, offsets.back());
      given.precision = precision;
      given.first = kFirst;
      if (are_on_device) {
        given.device_offsets = device_offsets.get();
        given.sets = offsets.size() - 1;
      } else {
        given.offsets = offsets;
      }
      expect_same(given, wide, offsets);
    }
  };
  expect_in(points, Precision::float64);
  expect_in(std::vector<float>(points.begin(), points.end()), Precision::float32);
}

TEST_P(DeviceLaws, ResultsGoToTheCallersBuffers) {
  const Numbers& numbers = cases_[6].numbers;
  const std::size_t n = numbers.size() / space_.width;
  const Memory memory = embedder().upload(without_weights(numbers)), weights = weights_of(numbers);
  const Triangulation expected = space_.triangulate(on_host(), numbers, {0, n});
  DeviceTriangulation found;
  struct Wanted {
    DeviceBuffer* buffer;
    std::size_t bytes;
  };
  std::vector<Wanted> buffers = {{&found.triangles, 24}, {&found.neighbors, 24}, {&found.representatives, 4}};
  if (!expected.places.empty()) buffers.push_back({&found.places, 16});
  if (!expected.corner_offsets.empty()) buffers.push_back({&found.corner_offsets, 12});
  if (space_.has_weights) buffers.push_back({&found.hidden, 4});
  for (const auto& [buffer, bytes] : buffers) *buffer = DeviceBuffer(embedder().make_buffer(bytes * n).get());
  const auto run = [&] { embedded().triangulate(points_in(memory, weights, n), found, wanted(), on_own()); };
  run();
  expect_array(found.triangles, expected.triangles);
  expect_array(found.neighbors, expected.neighbors);
  for (const auto& [buffer, bytes] : buffers) {
    const DeviceBuffer kept = *buffer;
    *buffer = DeviceBuffer(embedder().make_buffer(bytes * n - 1).get());
    expect_error(ErrorKind::usage, "too small", run);
    *buffer = kept;
  }
  found.neighbors = found.triangles;
  expect_error(ErrorKind::usage, "two things", run);
  if (!space_.has_weights) return;
  found.neighbors = {};
  found.hidden = DeviceBuffer(weights.get());
  expect_error(ErrorKind::usage, "two things", run);
}

TEST_P(DeviceLaws, ErrorsNameThePoint) {
  Numbers numbers = cases_[6].numbers;
  const std::size_t n = numbers.size() / space_.width;
  numbers[13 * space_.width + 1] = std::numeric_limits<double>::infinity();
  numbers[16 * space_.width] = std::nan("");
  const Memory memory = embedder().upload(without_weights(numbers)), weights = weights_of(numbers);
  cl_event done = reinterpret_cast<cl_event>(8);
  Enqueue enqueue = on_own();
  enqueue.event = &done;
  DeviceTriangulation found;
  expect_error(ErrorKind::input, "point 13 is not finite",
               [&] { embedded().triangulate(points_in(memory, weights, n), found, wanted(), enqueue); });
  EXPECT_EQ(done, nullptr);
  expect_error(ErrorKind::usage, "too small",
               [&] { embedded().triangulate(points_in(memory, weights, n + 1), found, wanted(), on_own()); });
  if (!space_.has_weights) return;
  const Memory finite = embedder().upload(without_weights(cases_[6].numbers)),
               few = embedder().upload(Numbers(n - 1));
  Numbers values(n, 0.0);
  values[5] = std::nan("");
  values[17] = 1e300;
  const Memory wrong = embedder().upload(values);
  expect_error(ErrorKind::usage, {"weights", "too small"},
               [&] { embedded().triangulate(points_in(finite, few, n), found, wanted(), on_own()); });
  expect_error(ErrorKind::input, "point 5 has a weight that is not finite: nan",
               [&] { embedded().triangulate(points_in(finite, wrong, n), found, wanted(), on_own()); });
}

void expect_refused(ErrorKind kind, const char* problem, const Memory& memory, const Space& space,
                    std::size_t first, std::size_t count) {
  DevicePoints points;
  points.memory = memory.get();
  points.first = first;
  points.count = count;
  points.space = space;
  DeviceTriangulation found;
  expect_error(kind, problem, [&] { embedded().triangulate(points, found); });
}

TEST(SmallSpacesOnDevice, SpacesThatAreNoneAreRefused) {
  const Memory memory = embedder().upload(Numbers(60, 0.5));
  const auto expect = [&](const char* problem, const Space& space) {
    expect_refused(ErrorKind::usage, problem, memory, space, 0, 20);
  };
  for (const Period& period : {Period{0, 1}, {1, -1}, {std::nan(""), 1}, {HUGE_VAL, HUGE_VAL}, {1, 1e30}})
    expect("period", Space::torus(period));
  expect("7 is no SphereCoordinates", Space::sphere(static_cast<SphereCoordinates>(7)));
}

TEST(SmallSpacesOnDevice, PointsThatAreNotOnTheSphereAreNamed) {
  const Memory memory = embedder().upload(Numbers{1, 0, 0, 0, 0, 0, 3, 91});
  const auto expect = [&](const char* problem, SphereCoordinates coordinates, std::size_t first,
                          std::size_t count) {
    expect_refused(ErrorKind::input, problem, memory, Space::sphere(coordinates), first, count);
  };
  expect("point 1 is the vector 0", SphereCoordinates::directions, 0, 2);
  expect("point 3: the latitude 91", SphereCoordinates::degrees, 0, 4);
  expect("point 0: the latitude 91", SphereCoordinates::degrees, 3, 1);
}

TEST(SmallSpacesOnDevice, AResultForgetsWhatEarlierCallsHaveLeft) {
  const Numbers square = {0.1, 0.1, 0.9, 0.1, 0.9, 0.9, 0.1, 0.9, 0.5, 0.4};
  const std::vector<std::int32_t> diagonal = {0, 2};
  const Memory memory = embedder().upload(square), ends = embedder().upload(diagonal),
               weights = embedder().upload(Numbers{0, 0, 0, 0, -9});
  DevicePoints points;
  points.memory = memory.get();
  points.count = 5;
  DevicePoints heavy = points, on_torus = points;
  heavy.weights = weights.get();
  on_torus.space = Space::torus({1, 1});
  DeviceTriangulation result;
  const auto expect_left = [&](SpaceKind kind, bool is_constrained, bool has_hidden) {
    EXPECT_EQ(result.space.kind, kind);
    EXPECT_EQ(result.is_constrained, is_constrained);
    EXPECT_EQ(result.constraint_count > 0, is_constrained);
    EXPECT_EQ(result.hidden_count > 0, has_hidden);
    EXPECT_EQ(result.is_weighted, has_hidden);
    EXPECT_EQ(result.images > 0, kind == SpaceKind::torus);
  };
  embedded().triangulate(on_torus, result);
  expect_left(SpaceKind::torus, false, false);
  embedded().constrained(points, {ends.get(), 1}, result);
  expect_left(SpaceKind::plane, true, false);
  embedded().triangulate(heavy, result);
  expect_left(SpaceKind::plane, false, true);
  embedded().constrained(points, {ends.get(), 1}, result);
  embedded().triangulate(on_torus, result);
  expect_left(SpaceKind::torus, false, false);
  embedded().triangulate(points, result);
  expect_left(SpaceKind::plane, false, false);
  // Calls that know no weights refuse them.
  expect_error(ErrorKind::usage, "have weights", [&] {
    embedded().constrained(heavy, {ends.get(), 1}, result);
  });
}

TEST(SmallSpacesOnDevice, ANoteSaysWhatTheDeviceLeavesToTheHost) {
  const TestSpace weighted = all_spaces()[1];
  const Statistics made =
      weighted.triangulate(triangulator(), cases(weighted)[6].numbers, {0, 60}).statistics;
  const bool is_left = !triangulator().device().fp64;
  EXPECT_EQ(made.device == "host", is_left);
  EXPECT_EQ(made.note.find("for weights: triangulated on the host") != std::string::npos, is_left);
}

}  // namespace
}  // namespace flaunay::testing::spaces
