// Sorting by coordinates on one thread.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flaunay::geometry {

struct Keyed {
  std::uint64_t key;
  std::int32_t index;
};

/// An integer key whose order is the order of x. x must not be NaN or -0.
std::uint64_t sort_key(double x);

/// Sorts stably by key, many elements by a radix sort. O(n log n).
void sort_by_key(std::vector<Keyed>& elements);

/// The number of a place on a curve that fills a box (Morton 1966), from its coordinates as parts of the box,
/// between 0 and 1. NaN counts as 0.
std::uint64_t place_on_curve(double x, double y);

/// Sorts ids so that those whose places are near in the plane are near in the list, and returns them with
/// their places on the curve. place(id): a point.
template <typename Place>
std::vector<Keyed> sort_by_place(std::vector<std::int32_t>& ids, const Place& place) {
  double low_x = HUGE_VAL, low_y = HUGE_VAL, high_x = -HUGE_VAL, high_y = -HUGE_VAL;
  for (const std::int32_t id : ids) {
    const auto p = place(id);
    low_x = std::min(low_x, p.x);
    low_y = std::min(low_y, p.y);
    high_x = std::max(high_x, p.x);
    high_y = std::max(high_y, p.y);
  }
  std::vector<Keyed> keyed;
  keyed.reserve(ids.size());
  for (const std::int32_t id : ids) {
    const auto p = place(id);
    keyed.push_back({place_on_curve((p.x - low_x) / (high_x - low_x), (p.y - low_y) / (high_y - low_y)), id});
  }
  sort_by_key(keyed);
  std::transform(keyed.begin(), keyed.end(), ids.begin(), [](const Keyed& k) { return k.index; });
  return keyed;
}

/// The largest number of comparisons of a sort of n elements by binary insertion or merging: the sum of
/// ceil(log2 k) for k = 1..n. Sorting is counted by this number, although it is done without comparisons.
std::uint64_t comparisons_to_sort(std::size_t n);

/// The critical path of such a sort: ceil(log2 n) rounds of merging, in which each element finds its place by
/// binary search.
std::uint64_t depth_of_sort(std::size_t n);

}  // namespace flaunay::geometry
