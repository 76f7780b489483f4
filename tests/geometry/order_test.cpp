// Sorting by coordinates on the device (kernels/predicates/order.h), by exact comparison and step by step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "tests/points/support.hpp"
#include "tests/support/test_kernels.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::points {
namespace {

struct SortCase {
  std::string name;
  std::vector<cl_double2> points;
  std::vector<cl_uint> places;  ///< in the order of elements
};

std::vector<SortCase> sort_cases(const std::vector<std::size_t>& sizes, FixtureRandom& random) {
  std::vector<SortCase> cases;
  for (const std::size_t n : sizes) {
    auto inputs = awkward(n, n + 1);
    inputs.emplace_back("uniform", make_fixture("uniform", n, n));
    inputs.emplace_back("far away", make_fixture("far-away", n, n));
    inputs.emplace_back("log-spiral", make_fixture("log-spiral", n, n));
    for (const auto& [name, coordinates] : inputs) {
      SortCase one{name + ", " + std::to_string(n) + " points", points_of(coordinates),
                   std::vector<cl_uint>(n)};
      std::iota(one.places.begin(), one.places.end(), 0);
      cases.push_back(one);
      std::reverse(one.places.begin(), one.places.end());
      one.name += ", reversed";
      cases.push_back(one);
      random.shuffle(one.places);
      one.name += " and shuffled";
      cases.push_back(one);
    }
  }
  return cases;
}

/// The leading 16 of the bits in which the coordinates of the points differ.
std::vector<cl_uint> coarse_keys(const std::vector<cl_double2>& points, int axis) {
  std::vector<cl_ulong> keys;
  for (const cl_double2& p : points) {
    // The place in the order of doubles: of negative ones the bits descend.
    const double c = p.s[axis] == 0 ? 0.0 : p.s[axis];
    const double magnitude = std::fabs(c);
    cl_ulong bits = 0;
    std::memcpy(&bits, &magnitude, sizeof bits);
    keys.push_back(c < 0 ? (cl_ulong{1} << 63) - 1 - bits : (cl_ulong{1} << 63) + bits);
  }
  std::vector<cl_uint> coarse;
  if (keys.empty()) return coarse;
  const auto [least, most] = std::minmax_element(keys.begin(), keys.end());
  int dropped = 0;
  while ((*most - *least) >> dropped >= cl_ulong{1} << 16) ++dropped;
  for (const cl_ulong key : keys) coarse.push_back(static_cast<cl_uint>((key - *least) >> dropped));
  return coarse;
}

cl_ulong element_of(cl_uint key, cl_uint place) { return cl_ulong{key} << 32 | place; }
cl_uint key_of(cl_ulong element) { return static_cast<cl_uint>(element >> 32); }
cl_uint place_of(cl_ulong element) { return static_cast<cl_uint>(element); }

std::vector<cl_uint> places_of(const std::vector<cl_ulong>& elements, std::size_t first, std::size_t count) {
  std::vector<cl_uint> places;
  for (std::size_t i = first; i < first + count; ++i) places.push_back(place_of(elements[i]));
  return places;
}

/// What the tests met, so that they can say that they met it.
struct MetSorting {
  std::size_t finished = 0, given_up = 0, ties = 0;
};

void check_sorting(Runtime& runtime, const std::vector<SortCase>& cases, int axis, MetSorting& met) {
  SCOPED_TRACE("axis " + std::to_string(axis));
  const Arena::Scope scope(runtime.arena());
  std::vector<cl_int> offsets{0};
  std::vector<cl_double2> points;
  std::vector<cl_ulong> elements;
  for (const SortCase& one : cases) {
    points.insert(points.end(), one.points.begin(), one.points.end());
    for (const cl_uint place : one.places) elements.push_back(element_of(0xdeadbeef, place));
    offsets.push_back(static_cast<cl_int>(points.size()));
  }
  const std::size_t n = points.size();
  const auto device_offsets = testing::upload(runtime, offsets);
  const auto device_points = testing::upload(runtime, points);
  const auto spare = testing::guarded<cl_ulong>(runtime, n);
  const auto sorted = testing::guarded<cl_ulong>(runtime, n);
  const auto coarse = testing::guarded<cl_ulong>(runtime, n);
  const auto finished = testing::guarded<cl_int>(runtime, cases.size());
  const auto ties = testing::guarded<cl_ulong>(runtime, n);
  const auto merged = testing::guarded<cl_ulong>(runtime, n);
  const auto uploaded = testing::upload(runtime, elements);
  const auto again = testing::upload(runtime, elements);
  testing::map_unchecked(runtime, "order", "sort_cases", cases.size(), cl_int{axis}, device_offsets,
                         device_points, uploaded, spare, sorted);
  testing::map_unchecked(runtime, "order", "sort_steps", cases.size(), cl_int{axis}, device_offsets,
                         device_points, again, spare, coarse, finished, ties, merged);
  const auto host_sorted = testing::download(runtime, sorted, n);
  const auto host_coarse = testing::download(runtime, coarse, n);
  const auto host_finished = testing::download(runtime, finished, cases.size());
  const auto host_ties = testing::download(runtime, ties, n);
  const auto host_merged = testing::download(runtime, merged, n);
  testing::download(runtime, spare, n);
  testing::download(runtime, uploaded, n);

  for (std::size_t c = 0; c < cases.size(); ++c) {
    const SortCase& one = cases[c];
    SCOPED_TRACE(one.name);
    const auto first = static_cast<std::size_t>(offsets[c]);
    const std::size_t size = one.places.size();
    std::vector<cl_uint> expected = one.places;
    std::stable_sort(expected.begin(), expected.end(),
                     [&](cl_uint i, cl_uint j) { return comes_first(one.points[i], one.points[j], axis); });
    EXPECT_TRUE(same(places_of(host_sorted, first, size), expected));
    EXPECT_TRUE(same(places_of(host_merged, first, size), expected));

    const std::vector<cl_uint> keys = coarse_keys(one.points, axis);
    std::vector<cl_ulong> by_key;
    for (const cl_uint place : one.places) by_key.push_back(element_of(keys[place], place));
    std::stable_sort(by_key.begin(), by_key.end(),
                     [](cl_ulong a, cl_ulong b) { return key_of(a) < key_of(b); });
    const auto begin = host_coarse.begin() + static_cast<std::ptrdiff_t>(first);
    EXPECT_TRUE(same(std::vector<cl_ulong>(begin, begin + static_cast<std::ptrdiff_t>(size)), by_key));

    // Insertion moves an element past those of its key that it precedes; given up beyond four a point.
    std::size_t moves = 0;
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t j = i; j > 0 && key_of(by_key[j - 1]) == key_of(by_key[i]) && moves <= 4 * size; --j) {
        moves += comes_first(one.points[place_of(by_key[i])], one.points[place_of(by_key[j - 1])], axis);
      }
    }
    EXPECT_EQ(host_finished[c], moves <= 4 * size ? 1 : 0);
    if (moves <= 4 * size) {
      EXPECT_TRUE(same(places_of(host_ties, first, size), expected));
    }
    met.ties += moves > 0;
    ++(moves <= 4 * size ? met.finished : met.given_up);
  }
}

void check_sorting(const std::vector<std::size_t>& sizes) {
  const testing::TestKernels kernels;
  Runtime runtime(host::find_device(""), settings_for(host::find_device("")));
  FixtureRandom random(4);
  const std::vector<SortCase> cases = sort_cases(sizes, random);
  MetSorting met;
  for (const int axis : {0, 1}) check_sorting(runtime, cases, axis, met);
  EXPECT_GT(met.finished, 20u);
  EXPECT_GT(met.given_up, 3u);
  EXPECT_GT(met.ties, 10u);
}

TEST(SmallOrder, SortsStablyByExactComparison) { check_sorting({0, 1, 2, 3, 17, 40}); }

TEST(Order, SortsStablyByExactComparison) { check_sorting({0, 1, 2, 255, 256, 257, 5000}); }

}  // namespace
}  // namespace flaunay::points
