// Segments that cross, for the error that names two of them: the first segment that crosses an earlier one,
// and the first one that it crosses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::constrained {

/// Says which segments these are, so that a caller can name the objects to which they belong.
class CrossingError : public Error {
 public:
  CrossingError(const std::string& message, std::int32_t first, std::int32_t second)
      : Error(ErrorKind::input, message), crossed(first), segment(second) {}
  std::int32_t crossed;  ///< the one with the smaller index
  std::int32_t segment;  ///< the one that crosses it
};

/// Throws the CrossingError for segments that cross, if that takes few comparisons: of the first segments of
/// a single set, O(sqrt(s)) of s segments, each with each. Wrong segments are left to others. O(s), and O(n)
/// if segments cross. segments: 2 points each.
void check_first_segments(const double* coordinates, const std::vector<std::size_t>& offsets,
                          const std::int32_t* segments, std::size_t segment_count);

/// Throws the CrossingError if there are segments that cross at a place that is no point. Segments must be
/// right (see check_segments). O((n + s + k) log n log s) for k edges of the segments, as a rule.
void check_crossings(const double* coordinates, const std::vector<std::size_t>& offsets,
                     const std::vector<std::int32_t>& segments);

}  // namespace flaunay::constrained
