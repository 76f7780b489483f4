// Points of a sphere in device memory: the arrays are those of the call for host memory, which
// sphere_test.cpp checks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "flaunay/device_memory.hpp"
#include "flaunay/sphere.hpp"
#include "tests/support/embedded.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing::spheres {
namespace {

using Numbers = std::vector<double>;
using Offsets = std::vector<std::size_t>;
constexpr SphereCoordinates kDirections = SphereCoordinates::directions,
                            kDegrees = SphereCoordinates::degrees;

template <typename T>
std::vector<T> download(const DeviceBuffer& buffer, std::size_t count) {
  return embedder().download<T>(buffer.memory(), count, embedded().queue());
}

std::size_t width_of(SphereCoordinates coordinates) { return coordinates == kDirections ? 3 : 2; }

/// Skips `first` points of the buffer.
template <typename T>
void expect_as_on_host(const std::vector<T>& points, Offsets offsets, SphereCoordinates coordinates,
                       std::size_t first = 0) {
  const std::size_t width = width_of(coordinates), n = points.size() / width - first;
  if (offsets.empty()) offsets = {0, n};
  const Numbers wide(points.begin() + static_cast<std::ptrdiff_t>(first * width), points.end());
  const Triangulation expected = triangulator().triangulate(wide.data(), offsets, Space::sphere(coordinates));
  const Memory memory = embedder().upload(points);
  DevicePoints given;
  given.memory = memory.get();
  given.count = n;
  given.first = first;
  given.offsets = offsets;
  given.precision = sizeof(T) == sizeof(double) ? Precision::float64 : Precision::float32;
  given.space = Space::sphere(coordinates);
  DeviceTriangulation result;
  // The second call has the memory of the first one.
  for (int call = 0; call < 2; ++call) {
    embedded().triangulate(given, result);
    EXPECT_EQ(expected.point_offsets, result.point_offsets);
    EXPECT_EQ(expected.triangle_offsets, result.triangle_offsets);
    EXPECT_EQ(expected.places, download<double>(result.places, 2 * n));
    EXPECT_EQ(expected.triangles, download<std::int32_t>(result.triangles, expected.triangles.size()));
    EXPECT_EQ(expected.neighbors, download<std::int32_t>(result.neighbors, expected.neighbors.size()));
    EXPECT_EQ(expected.representatives, download<std::int32_t>(result.representatives, n));
  }
}

Numbers random_directions(std::size_t n, std::uint64_t seed) {
  FixtureRandom random(seed);
  Numbers points;
  for (std::size_t i = 0; i < 3 * n; ++i) points.push_back(random.unit() * 2 - 1);
  return points;
}

Numbers grid(int step, bool with_poles) {
  Numbers points;
  for (int latitude = with_poles ? -90 : step - 90; latitude < 90; latitude += step) {
    for (int longitude = -180; longitude <= 180; longitude += step)
      points.insert(points.end(), {static_cast<double>(longitude), static_cast<double>(latitude)});
  }
  return points;
}

TEST(SmallSphereOnDevice, DirectionsAreAsOnTheHost) {
  for (const std::size_t n : {0, 1, 2, 3, 4, 5, 40}) {
    SCOPED_TRACE(n);
    expect_as_on_host(random_directions(n, n + 1), {}, kDirections);
  }
  // Of any length, in the plane of a meridian, and twice.
  expect_as_on_host(Numbers{1e300, 0, 1e300, 3e-300, 0, 4e-300, -1, 0, 0, 2, 0, 0, -5, 0, -7, 4, 0, 0}, {},
                    kDirections);
  const Numbers points = random_directions(41, 3);
  expect_as_on_host(std::vector<float>(points.begin(), points.end()), {}, kDirections, 1);
}

TEST(SmallSphereOnDevice, DegreesAreAsOnTheHost) {
  expect_as_on_host(grid(45, false), {}, kDegrees, 1);
  expect_as_on_host(grid(45, true), {}, kDegrees, 2);
  expect_as_on_host(std::vector<float>{10, 20, 400.5, -30, 55, 66, -700, 1}, {}, kDegrees);
}

TEST(SmallSphereOnDevice, SetsAreEachAsOnTheHost) {
  Numbers points = random_directions(20, 5);
  for (int k = 0; k < 5; ++k) points.insert(points.end(), {k - 2.0, 0, 1});  // one circle through the pole
  expect_as_on_host(points, {0, 0, 7, 8, 8, 20, 25, 25}, kDirections);
  points.insert(points.end(), {0, 0, -2});
  expect_as_on_host(points, {0, 7, 8, 20, 26}, kDirections);
}

TEST(SphereOnDevice, ManyPointsAreAsOnTheHost) {
  expect_as_on_host(random_directions(20000, 8), {}, kDirections);
  expect_as_on_host(random_directions(20000, 9), {0, 5000, 5003, 20000}, kDirections);
  expect_as_on_host(grid(3, false), {}, kDegrees);
}

std::string error_of(DevicePoints points, SphereCoordinates coordinates, DeviceTriangulation result = {}) {
  points.space = Space::sphere(coordinates);
  try {
    embedded().triangulate(points, result);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SmallSphereOnDevice, ErrorsSayWhatIsWrong) {
  const auto expect = [](const std::string& part, const std::string& error) {
    EXPECT_NE(std::string::npos, error.find(part)) << error;
  };
  const Memory two = embedder().upload(Numbers{1, 0, 0, 0, 0, 0}),
               angles = embedder().upload(Numbers{1, 2, 3, 91, 5, std::numeric_limits<double>::quiet_NaN()});
  DevicePoints points;
  points.memory = two.get();
  points.count = 2;
  expect("point 1 is the vector 0", error_of(points, kDirections));
  points.count = 3;
  expect("too small", error_of(points, kDirections));
  points.memory = angles.get();
  expect("point 1: the latitude 91", error_of(points, kDegrees));
  points.first = 1;
  points.count = 2;
  expect("point 0: the latitude 91", error_of(points, kDegrees));
  points.first = 2;
  points.count = 1;
  expect("point 0 is not finite", error_of(points, kDegrees));
  expect("7 is no SphereCoordinates", error_of(points, static_cast<SphereCoordinates>(7)));
  const Memory good = embedder().upload(random_directions(9, 1)), small = embedder().make_buffer(100);
  points.memory = good.get();
  points.first = 0;
  points.count = 9;
  DeviceTriangulation result;
  result.neighbors = DeviceBuffer(small.get());
  expect("neighbors", error_of(points, kDirections, result));
}

}  // namespace
}  // namespace flaunay::testing::spheres
