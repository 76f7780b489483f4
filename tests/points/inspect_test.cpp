// The stage `inspect`, and floats as doubles.
#include "points/inspect.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "tests/points/support.hpp"

namespace flaunay::points {
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

}  // namespace
}  // namespace flaunay::points
