// Corners of triangles: corner 3 t + k is the one at position k of triangle t. The edge opposite to it leads
// from the next corner to the one after, counter-clockwise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace flaunay::mesh {

/// The corner after c in its triangle, counter-clockwise.
template <typename Corner>
constexpr Corner next_corner(Corner c) {
  return c % 3 == 2 ? c - 2 : c + 1;
}

/// Where the edge opposite to corner c begins and ends.
template <typename Corner>
std::pair<std::int32_t, std::int32_t> edge_opposite(const std::vector<std::int32_t>& triangles, Corner c) {
  const auto next = static_cast<std::size_t>(next_corner(c));
  return {triangles[next], triangles[next_corner(next)]};
}

}  // namespace flaunay::mesh
