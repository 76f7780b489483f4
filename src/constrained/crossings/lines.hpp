// Pieces as ranges of edges that they share where they overlap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "constrained/crossings/pairs.hpp"

namespace flaunay::constrained {

/// The edges of pieces: no edge has a vertex inside, and no two have more than one common point.
struct LineEdges {
  std::vector<Piece> edges;
  /// 2 per piece: it has the edges [first, second).
  std::vector<std::int32_t> ranges;
};

/// Joins overlapping pieces to lines, which begin and end at ends of pieces. line_of: the line of each piece.
std::vector<Piece> join_pieces(const geometry::Predicates& predicates, const geometry::Point* points,
                               const std::vector<Piece>& pieces, std::vector<std::int32_t>& line_of);

/// Cuts pieces at the vertices on them. vertices: all vertices, without duplicates, in lexicographic order;
/// they include the ends of pieces. Overlapping pieces of a line share their edges, so memory is linear in
/// pieces and result, even if all pieces overlap.
LineEdges cut_at_vertices(const geometry::Predicates& predicates, const geometry::Point* points,
                          const std::vector<Piece>& pieces, const std::vector<std::int32_t>& vertices);

/// Per edge the first piece that has it, or -1. ranges: as in LineEdges.
std::vector<std::int32_t> first_pieces(std::size_t edges, const std::vector<std::int32_t>& ranges);

}  // namespace flaunay::constrained
