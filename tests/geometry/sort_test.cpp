// Sorting by coordinates on the host, and what it costs in comparisons.
#include "geometry/sort.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "statistics/costs.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::testing {
namespace {

TEST(Sort, LargeArraysAreStable) {
  FixtureRandom random(9);
  for (const std::size_t n : {0, 1, 2, 100, 5000}) {
    for (const int values : {1, 7, 1 << 30}) {
      std::vector<geometry::Keyed> elements;
      for (std::size_t i = 0; i < n; ++i) {
        const double x = static_cast<double>(random.integer(-values, values)) * 0.1;
        elements.push_back({geometry::sort_key(x + 0.0), static_cast<std::int32_t>(i)});
      }
      auto expected = elements;
      std::stable_sort(expected.begin(), expected.end(),
                       [](const auto& a, const auto& b) { return a.key < b.key; });
      geometry::sort_by_key(elements);
      for (std::size_t i = 0; i < n; ++i) ASSERT_EQ(elements[i].index, expected[i].index);
    }
  }
}

TEST(Sort, KeysAreInTheOrderOfDoubles) {
  const std::vector<double> rising = {-1e300, -2, -1, -1e-310, 0, 1e-310, 0.5, 1, 1e300};
  for (std::size_t i = 1; i < rising.size(); ++i) {
    EXPECT_LT(geometry::sort_key(rising[i - 1]), geometry::sort_key(rising[i]));
  }
}

TEST(Sort, ComparisonsOfBinaryInsertion) {
  std::uint64_t sum = 0;
  for (std::size_t n = 0; n < 100; ++n) {
    if (n > 0) sum += statistics::log2_ceiling(n);
    EXPECT_EQ(geometry::comparisons_to_sort(n), sum) << n;
  }
  EXPECT_EQ(geometry::depth_of_sort(8), 1U + 2 + 3);
}

}  // namespace
}  // namespace flaunay::testing
