// Segments as they come from the caller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace flaunay::constrained {

/// The set of a point.
std::size_t set_of(const std::vector<std::size_t>& offsets, std::int32_t point);

/// Throws Error(usage) if an index is no point, if the ends of a segment are in different sets, or if the
/// number of indices is odd.
void check_segments(const std::vector<std::size_t>& offsets, const std::vector<std::int32_t>& segments);

}  // namespace flaunay::constrained
