// Sorting by coordinates, as fast as one thread can.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace flaunay::recursive {

struct Keyed {
  std::uint64_t key;
  std::int32_t index;
};

/// An integer that is in order as the double is; x is not NaN and not -0.
std::uint64_t sort_key(double x);

/// Stable, by key: a radix sort where that pays. O(n log n).
void sort_by_key(std::vector<Keyed>& elements);

/// What a comparison sort of n elements takes at most, by binary insertion or by merging: the sum of
/// ceil(log2 k) for k = 1..n. This stands in for the work of sorting, which is done without comparisons.
std::uint64_t comparisons_to_sort(std::size_t n);

/// The depth of the same: ceil(log2 n) rounds of merging, in which each element searches its place by
/// bisection.
std::uint64_t depth_of_sort(std::size_t n);

}  // namespace flaunay::recursive
