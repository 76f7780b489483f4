#include "mesh/join_sides.hpp"

#include <algorithm>

#include "geometry/sort.hpp"
#include "mesh/corners.hpp"

namespace flaunay::mesh {

std::optional<std::pair<std::int32_t, std::int32_t>> join_sides(const std::vector<std::int32_t>& triangles,
                                                                std::vector<std::int32_t>& neighbors) {
  // The same edges follow each other, whatever their direction.
  std::vector<geometry::Keyed> sides;
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    if (neighbors[c] >= 0) continue;
    const auto [from, to] = edge_opposite(triangles, c);
    const auto [low, high] = std::minmax(from, to);
    sides.push_back({static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high),
                     static_cast<std::int32_t>(c)});
  }
  geometry::sort_by_key(sides);
  std::optional<std::pair<std::int32_t, std::int32_t>> twice;
  for (auto side = sides.begin(); side != sides.end();) {
    std::int32_t corners[2] = {-1, -1};  // by the direction of their edges
    for (const std::uint64_t key = side->key; side != sides.end() && side->key == key; ++side) {
      const auto [from, to] = edge_opposite(triangles, side->index);
      std::int32_t& corner = corners[from < to ? 0 : 1];
      if (corner < 0) {
        corner = side->index;
      } else if (!twice || side->index < twice->second) {
        twice = {corner, side->index};
      }
    }
    for (int k = 0; k < 2; ++k) {
      if (corners[k] >= 0 && corners[1 - k] >= 0) neighbors[corners[k]] = corners[1 - k] / 3;
    }
  }
  return twice;
}

}  // namespace flaunay::mesh
