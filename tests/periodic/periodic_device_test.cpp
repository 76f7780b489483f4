// Points on a torus or a cylinder in device memory: the arrays are those of the call for host memory, which
// periodic_test.cpp checks.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "flaunay/device_memory.hpp"
#include "flaunay/flaunay.hpp"
#include "tests/support/embedded.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/same.hpp"
#include "tests/support/shared_triangulator.hpp"

namespace flaunay::testing::tori {
namespace {

using Offsets = std::vector<std::size_t>;

DevicePoints points_in(const Memory& memory, std::size_t count) {
  DevicePoints points;
  points.memory = memory.get();
  points.count = count;
  return points;
}

Enqueue on_own() {
  Enqueue enqueue;
  enqueue.queue = embedder().queue();
  return enqueue;
}

void triangulate_on_torus(DevicePoints points, const Period& period, DeviceTriangulation& result,
                          const Enqueue& enqueue = on_own()) {
  points.space = Space::torus(period);
  embedded().triangulate(points, result, Parts(), enqueue);
}

void expect_same(const DeviceTriangulation& found, const Triangulation& expected) {
  EXPECT_EQ(found.space.period.x, expected.space.period.x);
  EXPECT_EQ(found.space.period.y, expected.space.period.y);
  EXPECT_EQ(found.space.period.shear, expected.space.period.shear);
  EXPECT_EQ(found.images, expected.images);
  EXPECT_EQ(found.point_offsets, expected.point_offsets);
  EXPECT_EQ(found.triangle_offsets, expected.triangle_offsets);
  const auto expect_array = [](const DeviceBuffer& buffer, const auto& values) {
    using Element = typename std::decay_t<decltype(values)>::value_type;
    EXPECT_TRUE(same(embedder().download<Element>(buffer.memory(), values.size()), values));
  };
  expect_array(found.places, expected.places);
  expect_array(found.triangles, expected.triangles);
  expect_array(found.corner_offsets, expected.corner_offsets);
  expect_array(found.neighbors, expected.neighbors);
  expect_array(found.representatives, expected.representatives);
}

// Points on a torus, and on cylinders: as they come, with ties, close to the border, twice, and far away.
std::vector<Coordinates> periodic_points(std::size_t n) {
  const Coordinates uniform = make_fixture("uniform", n, n);
  Coordinates lattice, border, twice = uniform, far;
  for (const double x : uniform) {
    lattice.push_back(std::floor(5 * x) / 5);
    border.push_back((x - 0.5) / 64);
    far.push_back(std::ldexp(x - 0.5, static_cast<int>(far.size() * 37 % 1000)));
  }
  twice.insert(twice.end(), uniform.begin(), uniform.end());
  for (std::size_t i = 0; i < n; ++i) twice.insert(twice.end(), {uniform[2 * i] - 3, uniform[2 * i + 1] + 2});
  return {uniform, lattice, border, twice, far};
}

// Returns whether it is no error: points on a cylinder may be of too different magnitudes.
bool expect_that_of_the_host(const Coordinates& points, const Period& period, DeviceTriangulation& found) {
  const std::size_t n = points.size() / 2;
  const Memory memory = embedder().upload(points);
  const auto run = [&] { triangulate_on_torus(points_in(memory, n), period, found); };
  Triangulation expected;
  try {
    expected = triangulator().triangulate(points.data(), n, Space::torus(period));
  } catch (const Error& error) {
    expect_error(error.kind(), "", run);
    return false;
  }
  run();
  expect_same(found, expected);
  return true;
}

TEST(SmallPeriodicOnDevice, IsThatOfTheHost) {
  std::size_t count = 0;
  for (const std::size_t n : {1u, 2u, 3u, 30u}) {
    for (const Coordinates& points : periodic_points(n)) {
      for (const Period& period : {Period{}, {0.7, 0.3}, {1, HUGE_VAL}, {HUGE_VAL, 0.6}, {0.7, 0.5, 0.3}}) {
        SCOPED_TRACE(std::to_string(n) + " " + std::to_string(period.x) + " " + std::to_string(period.y));
        DeviceTriangulation found;
        count += expect_that_of_the_host(points, period, found);
      }
    }
  }
  EXPECT_GE(count, 70u);
}

TEST(PeriodicOnDevice, LargerIsThatOfTheHost) {
  std::vector<Coordinates> inputs = periodic_points(6000);
  // A gap, which needs more images than uniform points do.
  Coordinates gap;
  for (std::size_t i = 0; i < inputs[0].size(); i += 2) {
    if (std::hypot(inputs[0][i] - 0.5, inputs[0][i + 1]) > 0.3)
      gap.insert(gap.end(), {inputs[0][i], inputs[0][i + 1]});
  }
  inputs.push_back(gap);
  DeviceTriangulation found;
  for (const Coordinates& points : inputs) {
    for (const Period& period : {Period{}, {0.7, 1.3}, {1, HUGE_VAL}, {0.7, 1.3, 0.25}}) {
      if (!expect_that_of_the_host(points, period, found)) continue;
      EXPECT_EQ(found.statistics.triangles, found.triangle_offsets.back());
      // Less than places alone take.
      if (&points == &inputs[0] && period.y == 1 && embedded().device().fp64) {
        EXPECT_LT(found.statistics.bytes_to_host, 8 * points.size());
      }
    }
  }
  // Sets of which some are done before others.
  Coordinates all;
  Offsets offsets{0};
  for (const Coordinates& points : inputs) {
    all.insert(all.end(), points.begin(), points.end());
    offsets.push_back(all.size() / 2);
  }
  const Memory memory = embedder().upload(all);
  DevicePoints sets = points_in(memory, offsets.back());
  sets.offsets = offsets;
  triangulate_on_torus(sets, {}, found);
  expect_same(found, triangulator().triangulate(all.data(), offsets, Space::torus({})));
}

TEST(SmallPeriodicOnDevice, PeriodsThatAreNoneAreRefused) {
  const Memory memory = embedder().upload(make_fixture("uniform", 20, 5));
  DeviceTriangulation found;
  for (const Period& period : {Period{0, 1}, {1, -1}, {std::nan(""), 1}, {HUGE_VAL, HUGE_VAL}, {1, 1e30}})
    expect_error(ErrorKind::usage, "period",
                 [&] { triangulate_on_torus(points_in(memory, 20), period, found); });
}

}  // namespace
}  // namespace flaunay::testing::tori
