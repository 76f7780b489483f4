// The host's twin of the stage `ingest`: checks, scales, sorts, finds duplicates, renumbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recursive/predicates.hpp"

namespace flaunay::recursive {

/// Distinct points by id, the rank in (set, x, y).
struct PointSets {
  std::vector<Point> points;  ///< scaled by a power of two
  std::vector<std::int32_t>
      source;  ///< id to the smallest index of an input point of its set with these coordinates
  std::vector<std::int32_t> set_offsets;      ///< sets + 1 ids
  std::vector<std::int32_t> representatives;  ///< per input point, an index of the input
  Predicates predicates{};
  std::uint64_t comparisons = 0;  ///< that a comparison sort takes; see comparisons_to_sort
};

/// Throws Error(input) for points that are not finite, whose magnitudes differ too much, or that are too many
/// for 32-bit indices, Error(usage) for bad offsets. O(n log n).
PointSets ingest(const double* coordinates, const std::vector<std::size_t>& offsets);

}  // namespace flaunay::recursive
