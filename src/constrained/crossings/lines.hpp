// Pieces as ranges of edges that they share where they overlap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "constrained/crossings/pairs.hpp"

namespace flaunay::constrained {

/// What pieces consist of: edges have no vertex inside, and no two have more than one common point.
struct LineEdges {
  std::vector<Piece> edges;
  /// 2 per piece: it has the edges [first, second).
  std::vector<std::int32_t> ranges;
};

/// Joins pieces that overlap to lines, whose ends are those of pieces. line_of: the line of each piece.
std::vector<Piece> join_pieces(const geometry::Predicates& predicates, const geometry::Point* points,
                               const std::vector<Piece>& pieces, std::vector<std::int32_t>& line_of);

/// Cuts pieces at the vertices on them. vertices: all there are, in lexicographic order; among them the ends
/// of pieces, none twice. Pieces that overlap on a line share their edges, so that the memory is that of the
/// pieces and of the result, even if all of them overlap.
LineEdges cut_at_vertices(const geometry::Predicates& predicates, const geometry::Point* points,
                          const std::vector<Piece>& pieces, const std::vector<std::int32_t>& vertices);

/// Per edge the first piece that has it, or -1. ranges: as those of LineEdges.
std::vector<std::int32_t> first_pieces(std::size_t edges, const std::vector<std::int32_t>& ranges);

}  // namespace flaunay::constrained
