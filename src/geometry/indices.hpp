// Checks of arrays of indices and of offsets that come from callers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace flaunay::geometry {

/// Whether all are below `end`, and none below `least`. O(n).
inline bool are_indices(const std::vector<std::int32_t>& ids, std::size_t end, std::int32_t least = 0) {
  return std::all_of(ids.begin(), ids.end(), [&](std::int32_t i) {
    return i >= least && (i < 0 || static_cast<std::size_t>(i) < end);
  });
}

/// Whether they cut an array of `size` elements into so many parts. O(parts).
inline bool are_offsets(const std::vector<std::size_t>& offsets, std::size_t parts, std::size_t size) {
  return offsets.size() == parts + 1 && offsets.front() == 0 && offsets.back() == size &&
         std::is_sorted(offsets.begin(), offsets.end());
}

}  // namespace flaunay::geometry
