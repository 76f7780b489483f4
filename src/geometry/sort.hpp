// Sorting by coordinates on one thread.
#pragma once

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

/// The largest number of comparisons of a sort of n elements by binary insertion or merging: the sum of
/// ceil(log2 k) for k = 1..n. Sorting is counted by this number, although it is done without comparisons.
std::uint64_t comparisons_to_sort(std::size_t n);

/// The critical path of such a sort: ceil(log2 n) rounds of merging, in which each element finds its place by
/// binary search.
std::uint64_t depth_of_sort(std::size_t n);

}  // namespace flaunay::geometry
