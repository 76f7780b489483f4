// Snap rounding of edges to the vertices beside them, on the grid of all doubles. docs/constrained.md defines
// the result, and proves that no two chains cross.
#pragma once

#include <cstdint>
#include <vector>

#include "constrained/pairs.hpp"

namespace flaunay::constrained {

/// The vertices between the ends of edges, along each.
struct Chains {
  std::vector<std::size_t> offsets;    ///< edges + 1 values: edge e has vertices [offsets[e], offsets[e + 1])
  std::vector<std::int32_t> vertices;  ///< without the ends of the edge
};

/// Leads each edge through all vertices whose cells it meets, where the cell of a vertex is what would be
/// rounded to it; and around vertices that it would otherwise pass on the wrong side, on the shortest way.
///
/// points: all are vertices, and multiples of the unit, as for round_crossing. edges: the lexicographically
/// smaller end first; all places where they cross, rounded, must be vertices.
///
/// O((e + m) log e) for v vertices near edges in m pairs, if few boxes of vertices are met; O(e v) otherwise.
Chains snap(const Predicates& predicates, const std::vector<Point>& points, const std::vector<Piece>& edges,
            double unit);

}  // namespace flaunay::constrained
