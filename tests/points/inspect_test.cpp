// The stage `inspect`, sets with a scaling of their own, and floats as doubles.
#include "points/inspect.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "predicates/bounds.h"
#include "tests/points/support.hpp"

namespace flaunay::points {
using namespace geometry;

namespace {

void check_widening(Runtime& runtime, std::size_t first, std::size_t n) {
  FixtureRandom random(first + n);
  std::vector<float> narrow(2 * (first + n));
  for (float& x : narrow)
    x = static_cast<float>(std::ldexp(random.unit() - 0.5, static_cast<int>(random.integer(-140, 100))));
  host::Arena::Scope scope(runtime.arena());
  const auto wide = testing::guarded<double>(runtime, 2 * n);
  widen(runtime, testing::upload(runtime, narrow), first, n, wide);
  EXPECT_EQ(testing::download(runtime, wide, 2 * n),
            std::vector<double>(narrow.begin() + static_cast<std::ptrdiff_t>(2 * first), narrow.end()));
}

TEST(SmallInspect, FloatsAreTheSameNumbersAsDoubles) {
  under_each_tuning([](Runtime& runtime) {
    for (const std::size_t first : {0, 3}) {
      for (const std::size_t n : {0, 1, 70}) check_widening(runtime, first, n);
    }
  });
}

// Coordinates whose bits are from 2^least to 2^most, and zeros.
Coordinates make_coordinates(std::size_t n, int least, int most, FixtureRandom& random) {
  Coordinates result;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const auto mantissa = static_cast<double>(random.integer(-9, 9));
    result.push_back(std::ldexp(mantissa, static_cast<int>(random.integer(least, most - 3))));
  }
  return result;
}

Magnitudes magnitudes_twin(const Coordinates& points, std::size_t first, std::size_t last) {
  Magnitudes found;
  for (std::size_t i = first; i < last; ++i) {
    for (const double x : {points[2 * i], points[2 * i + 1]}) {
      if (!std::isfinite(x)) {
        found.bad = std::min(found.bad, static_cast<int>(i));
      } else if (x != 0 && found.bad != static_cast<int>(i)) {
        found.largest = std::max(found.largest, std::ilogb(x));
        found.lowest = std::min(found.lowest, lowest_bit(x));
      }
    }
  }
  return found;
}

void check_magnitudes(const Magnitudes& found, const Magnitudes& expected) {
  EXPECT_EQ(found.bad, expected.bad);
  EXPECT_EQ(found.largest, expected.largest);
  EXPECT_EQ(found.lowest, expected.lowest);
}

// Sets of 0 to 200 points, as many as there are ranges, and one of a single point.
struct SetsOfManyScales {
  Coordinates points;
  Offsets offsets{0};

  explicit SetsOfManyScales(std::size_t count) {
    FixtureRandom random(count);
    for (std::size_t s = 0; s < count; ++s) {
      const auto least = static_cast<int>(random.integer(-1074, 500));
      const auto n = static_cast<std::size_t>(s % 3 == 1 ? 0 : s == 6 ? 1 : random.integer(2, 200));
      const Coordinates set = make_coordinates(n, least, least + 500, random);
      points.insert(points.end(), set.begin(), set.end());
      offsets.push_back(points.size() / 2);
    }
  }
};

TEST(SmallInspect, MagnitudesAreThoseOfEachSet) {
  under_each_tuning([](Runtime& runtime) {
    for (const std::size_t count : {1, 2, 30}) {
      SetsOfManyScales sets(count);
      if (count == 30) {
        sets.points[2 * sets.offsets[17]] = std::nan("");
        sets.points.back() = HUGE_VAL;
      }
      host::Arena::Scope scope(runtime.arena());
      const auto points = testing::upload(runtime, sets.points);
      const std::vector<Magnitudes> found = inspect_sets(runtime, points, sets.offsets);
      ASSERT_EQ(found.size(), count);
      for (std::size_t s = 0; s < count; ++s) {
        SCOPED_TRACE("set " + std::to_string(s) + " of " + std::to_string(count));
        check_magnitudes(found[s], magnitudes_twin(sets.points, sets.offsets[s], sets.offsets[s + 1]));
      }
      check_magnitudes(inspect(runtime, points, sets.offsets.back()),
                       magnitudes_twin(sets.points, 0, sets.offsets.back()));
    }
  });
}

TEST(SmallInspect, SetsAreScaledOneByOne) {
  under_each_tuning([](Runtime& runtime) {
    const SetsOfManyScales sets(30);
    host::Arena::Scope scope(runtime.arena());
    const std::size_t n = sets.offsets.back();
    const UniformPoints uniform = *make_uniform(runtime, testing::upload(runtime, sets.points), sets.offsets);
    EXPECT_EQ(uniform.scaling.shift, 0);
    EXPECT_GT(uniform.scaling.bounds.circle, 0);
    Coordinates found(2 * n);
    runtime.read(uniform.coordinates, 0, 2 * n, found.data());
    for (std::size_t s = 0; s + 1 < sets.offsets.size(); ++s) {
      const Magnitudes before = magnitudes_twin(sets.points, sets.offsets[s], sets.offsets[s + 1]);
      const int shift = scaling_for(sets.points.data(), sets.offsets[s], sets.offsets[s + 1], before).shift;
      for (std::size_t i = 2 * sets.offsets[s]; i < 2 * sets.offsets[s + 1]; ++i) {
        ASSERT_EQ(found[i], std::ldexp(sets.points[i], shift)) << "set " << s;
        ASSERT_EQ(std::ldexp(found[i], -shift), sets.points[i]) << "set " << s;
      }
      const Magnitudes after = magnitudes_twin(found, sets.offsets[s], sets.offsets[s + 1]);
      EXPECT_LE(after.largest, kernel::LARGEST_EXPONENT);
      EXPECT_GE(after.lowest, kernel::LOWEST_EXPONENT);
    }
  });
}

TEST(SmallInspect, PointsOfOneScaleAreNotCopied) {
  Runtime& runtime = Runtimes::get("own");
  host::Arena::Scope scope(runtime.arena());
  const Coordinates points = testing::scaled(make_fixture("uniform", 40, 1), 0x1p-500);
  const auto on_device = testing::upload(runtime, points);
  const UniformPoints uniform = *make_uniform(runtime, on_device, {0, 10, 40});
  EXPECT_EQ(uniform.coordinates.memory(), on_device.memory());
  EXPECT_EQ(uniform.scaling.shift, scaling_for(points.data(), 0, 40, magnitudes_twin(points, 0, 40)).shift);
}

}  // namespace
}  // namespace flaunay::points
