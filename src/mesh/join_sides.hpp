// Neighbours of triangles that share an edge.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

namespace flaunay::mesh {

/// Makes triangles that share an edge neighbours of each other, where they have none yet: -1. If triangles
/// have the same edge in the same direction, which means that they lie on each other, returns the smallest
/// corner whose edge is that of a smaller corner, after that one. O(t).
std::optional<std::pair<std::int32_t, std::int32_t>> join_sides(const std::vector<std::int32_t>& triangles,
                                                                std::vector<std::int32_t>& neighbors);

}  // namespace flaunay::mesh
