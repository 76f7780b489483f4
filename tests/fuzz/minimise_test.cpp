// The parts of the fuzzer of the triangulation: its batches are what they are meant to be, and what fails is
// shrunk to the least that fails.
#include "tests/fuzz/minimise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/constrained/segments.hpp"
#include "tests/fuzz/degenerate.hpp"

namespace flaunay::fuzz {
namespace {

using testing::FixtureRandom;

Batch some_batch(std::uint64_t seed, std::size_t sets, std::size_t points) {
  Batch batch;
  for (std::size_t s = 0; s < sets; ++s) batch.push_back(testing::make_fixture("uniform", points, seed + s));
  return batch;
}

bool any_set(const Batch& batch, const std::function<bool(const Coordinates&)>& holds) {
  return std::any_of(batch.begin(), batch.end(), holds);
}

/// How many points of the set are to the right of x.
std::size_t right_of(const Coordinates& set, double x) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < set.size(); i += 2) count += set[i] > x;
  return count;
}

TEST(Minimise, FindsTheLeastPointsThatFail) {
  // Three points to the right of 0.75 in one set: numbers of one digit, and zeros.
  const Fails fails = [](const Batch& batch) {
    return any_set(batch, [](const Coordinates& set) { return right_of(set, 0.75) >= 3; });
  };
  const Batch batch = some_batch(1, 7, 400);
  ASSERT_TRUE(fails(batch));
  const Batch least = minimise(batch, fails);
  ASSERT_EQ(least.size(), 1u);
  EXPECT_EQ(points_of(least), 3u);
  EXPECT_LE(fixture_text(least, "").size(), 3 * std::string("0.8 0\n").size());
}

TEST(Minimise, FindsTheLeastSegmentsThatFail) {
  // Two segments that cross, among many.
  const auto cross = [](const SegmentSet& set) {
    testing::Plane plane(set.points);
    const auto& s = set.segments;
    for (std::size_t i = 0; i < s.size(); i += 2) {
      for (std::size_t j = 0; j < i; j += 2) {
        if (plane.cross(s[i], s[i + 1], s[j], s[j + 1])) return true;
      }
    }
    return false;
  };
  const SegmentsFail fails = [&](const SegmentBatch& batch) {
    return std::any_of(batch.begin(), batch.end(), cross);
  };
  SegmentBatch batch;
  FixtureRandom random(3);
  for (const Coordinates& points : some_batch(3, 4, 30))
    batch.push_back({points, testing::random_segments(random, 30, 20)});
  ASSERT_TRUE(fails(batch));
  const SegmentBatch least = minimise(batch, fails);
  ASSERT_EQ(least.size(), 1u);
  EXPECT_EQ(least[0].points.size() / 2, 4u);
  EXPECT_EQ(least[0].segments.size() / 2, 2u);
  EXPECT_TRUE(cross(least[0]));
  const std::string text = test_text(least, "why");
  EXPECT_EQ(text.rfind("// why\nexpect_right(Sets({", 0), 0u) << text;
  EXPECT_NE(text.find("}, {0, 4}), {"), std::string::npos) << text;
}

TEST(Minimise, KeepsPointsThatFailTogetherOnly) {
  // A point of the first half and one of the second half of the set: no half fails on its own.
  const Coordinates set = some_batch(2, 1, 1000)[0];
  const double first = set[2 * 123], second = set[2 * 877];
  const Fails fails = [&](const Batch& batch) {
    return any_set(batch, [&](const Coordinates& points) {
      return std::find(points.begin(), points.end(), first) != points.end() &&
             std::find(points.begin(), points.end(), second) != points.end();
    });
  };
  EXPECT_EQ(minimise({set}, fails), (Batch{{first, 0, second, 0}}));
}

TEST(Minimise, KeepsSetsThatFailTogetherOnly) {
  const Fails fails = [](const Batch& batch) {
    return batch.size() >= 2 && batch.front().empty() && !batch.back().empty();
  };
  Batch batch = some_batch(3, 9, 20);
  batch.front().clear();
  EXPECT_EQ(minimise(batch, fails), (Batch{{}, {0, 0}}));
}

TEST(Minimise, KeepsTheBitsThatMatter) {
  const double value = std::nextafter(0.1, 1);
  const Fails fails = [&](const Batch& batch) {
    return !batch.empty() && batch[0].size() == 2 && batch[0][0] == value;
  };
  EXPECT_EQ(minimise({{value, 1.2345678901234567}}, fails), (Batch{{value, 0}}));
}

TEST(Minimise, ScalesExtremeMagnitudes) {
  const Fails fails = [](const Batch& batch) {
    return !batch.empty() && batch[0].size() == 4 && batch[0][0] == 2 * batch[0][2] && batch[0][2] > 0;
  };
  const double value = std::ldexp(1.0, -700);
  EXPECT_EQ(minimise({{2 * value, value, value, -value}}, fails), (Batch{{1, 0, 0.5, 0}}));
}

TEST(Minimise, StopsAfterSoManyCalls) {
  std::size_t calls = 0;
  const Fails fails = [&](const Batch&) {
    ++calls;
    return false;
  };
  const Batch batch = some_batch(4, 3, 100);
  EXPECT_EQ(minimise(batch, fails, 10), batch);
  EXPECT_EQ(calls, 10u);
}

TEST(Minimise, FixturesHaveAComment) {
  EXPECT_EQ(fixture_text({{0.1, -0.0, 1e300, 2}}, "seed 1\nwrong"), "# seed 1\n# wrong\n0.1 -0\n1e+300 2\n");
  EXPECT_EQ(fixture_text({{}, {1, 2}}, ""), "# set 0\n# set 1\n1 2\n");
}

TEST(DegenerateBatch, IsTheSameForTheSameSeedAndFinite) {
  std::set<std::size_t> numbers_of_sets;
  std::size_t empty = 0, of_a_thousand = 0, with_duplicates = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    FixtureRandom random(seed), again(seed);
    const Batch batch = degenerate_batch(random);
    EXPECT_EQ(batch, degenerate_batch(again));
    numbers_of_sets.insert(batch.size());
    for (const Coordinates& set : batch) {
      EXPECT_TRUE(std::all_of(set.begin(), set.end(), [](double v) { return std::isfinite(v); })) << seed;
      empty += set.empty();
      of_a_thousand += set.size() / 2 > 1000;
      std::set<std::pair<double, double>> distinct;
      for (std::size_t i = 0; i < set.size(); i += 2) distinct.insert({set[i], set[i + 1]});
      with_duplicates += distinct.size() < set.size() / 2;
    }
  }
  EXPECT_GT(numbers_of_sets.size(), 8u);
  EXPECT_GT(empty, 10u);
  EXPECT_GT(of_a_thousand, 5u);
  EXPECT_GT(with_duplicates, 100u);
}

}  // namespace
}  // namespace flaunay::fuzz
