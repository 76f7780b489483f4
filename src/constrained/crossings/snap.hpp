// Snap rounding of edges to the vertices beside them, on the grid of all doubles. docs/constrained.md defines
// the result, and proves that no two chains cross.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "constrained/crossings/pairs.hpp"

namespace flaunay::constrained {

/// Limits of splitting.
struct SplitLimits {
  std::size_t pieces = 1'000'000'000;  ///< of all segments; at most 2^30 - 1
  /// Called once, when the limit is exceeded; returns a higher one. null: the limit is final.
  std::function<std::size_t()> more = nullptr;
};

/// Throws Error(input) if the limit of pieces is exceeded.
void check_pieces(std::size_t pieces, SplitLimits& limits);

/// The vertices between the ends of edges, along each.
struct Chains {
  std::vector<std::size_t> offsets;    ///< edges + 1 values: edge e has vertices [offsets[e], offsets[e + 1])
  std::vector<std::int32_t> vertices;  ///< without the ends of the edge
};

/// Leads each edge through all vertices whose cells it meets, where the cell of a vertex has the places that
/// would be rounded to it; and around vertices that it would otherwise pass on the wrong side, on the
/// shortest way.
///
/// points: all are vertices, and multiples of the unit, as for round_crossing. edges: the lexicographically
/// smaller end first; all places where they cross, rounded, must be vertices.
///
/// Throws Error(input) if chains have more vertices than there may be pieces. Let m be the number of pairs of
/// an edge and a vertex within a unit in the last place of it. O(v log v + m log v) for v vertices, if few
/// boxes of vertices are met beside those, and O(e v) otherwise; a chain that turns around k vertices takes
/// O(k) times as long at worst.
Chains snap(const geometry::Predicates& predicates, const std::vector<geometry::Point>& points,
            const std::vector<Piece>& edges, double unit, SplitLimits& limits);

}  // namespace flaunay::constrained
