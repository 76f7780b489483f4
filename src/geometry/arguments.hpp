// The checks of arguments that callers pass to public functions of C++ and C. A call makes them before
// anything else: before it multiplies a count, allocates memory or reads an array.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string_view>
#include <type_traits>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "flaunay/neighbors.hpp"
#include "geometry/enumerators.hpp"
#include "mesh/limits.h"

namespace flaunay {

/// Throws Error(usage) with the message `what`, or with what it returns, unless the condition holds.
template <typename Message>
void expect(bool holds, const Message& what) {
  if (holds) return;
  if constexpr (std::is_invocable_v<Message>) {
    throw Error(ErrorKind::usage, what());
  } else {
    throw Error(ErrorKind::usage, what);
  }
}

/// The largest number of elements that 32-bit indices count.
constexpr std::size_t kMostIndexed = std::numeric_limits<std::int32_t>::max();
/// The largest number of points in the plane: a mesh has up to 6 half-edges per point, numbered by 32-bit
/// integers.
constexpr std::size_t kMostPointsAtOnce = kMostIndexed / kernel::EDGES_PER_VERTEX;
/// The largest number of points of triangulations in chunks. Sums and products with numbers of bytes do not
/// overflow.
constexpr std::uint64_t kMostPointsInChunks = std::uint64_t{1} << 44;
/// The largest number of rows times columns, so that the bytes of an array do not overflow.
constexpr std::size_t kMostCountable = std::size_t{1} << (sizeof(std::size_t) == 8 ? 40 : 26);

/// Throws Error(input) if there are more than `most` elements. name: what they are, as a plural.
void check_count(std::uint64_t count, const char* name, std::uint64_t most = kMostIndexed);
/// Throws Error(input) if there are more than `most` elements, and Error(usage) if there are some but the
/// pointer to them is null.
void check_array(const void* array, std::uint64_t count, const char* name, std::uint64_t most = kMostIndexed);
/// check_array for points in the plane, on a sphere or on a torus.
void check_points(const void* coordinates, std::uint64_t count);
/// check_array for queries. Kernels use 32-bit indices for their coordinates.
void check_queries(const void* coordinates, std::uint64_t count);
/// Checks the numbers of columns and rows of an array. Returns how many entries the array has.
std::size_t check_columns(std::size_t columns, std::size_t rows);

/// Throws Error(usage) for a number that is no enumerator. Enumerators are numbered from 0 to end - 1. type:
/// the name of the enumeration.
void check_enumerator(int value, int end, std::string_view type);
template <typename Enum>
void check_enumerator(Enum value) {
  check_enumerator(static_cast<int>(value), end_of_enumerators<Enum>(), name_of_enumeration<Enum>());
}

/// Throws Error(usage) unless offsets of sets begin with 0 and do not decrease.
void check_offsets(const std::vector<std::size_t>& offsets);
/// Throws Error(usage) unless offsets of sets begin with 0, do not decrease and end with n.
void check_offsets(const std::vector<std::size_t>& offsets, std::size_t n);

/// Whether all are below `end`, and none below `least`. O(n).
inline bool are_indices(const std::vector<std::int32_t>& ids, std::size_t end, std::int32_t least = 0) {
  return std::all_of(ids.begin(), ids.end(), [&](std::int32_t i) {
    return i >= least && (i < 0 || static_cast<std::size_t>(i) < end);
  });
}

/// Whether the offsets cut an array of `size` elements into `parts` parts. O(parts).
inline bool are_offsets(const std::vector<std::size_t>& offsets, std::size_t parts, std::size_t size) {
  return offsets.size() == parts + 1 && offsets.front() == 0 && offsets.back() == size &&
         std::is_sorted(offsets.begin(), offsets.end());
}

/// Throws Error(usage) for options that make no sense, and Error(input) for too many results of m queries.
inline void check_neighbors(const NeighborOptions& options, std::size_t m) {
  expect(options.count > 0, "the number of nearest points must be 1 or more");
  expect(options.max_distance >= 0, "the largest distance must be 0 or more");
  check_count(options.count, "neighbours of each query",
              std::min(kMostIndexed, kMostCountable / std::max<std::size_t>(m, 1)));
}

}  // namespace flaunay
