// Which straight pieces cross each other, and which points lie on them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include "constrained/crossings/crossing.hpp"
#include "geometry/predicates.hpp"

namespace flaunay::constrained {

/// A straight piece between two vertices, the lexicographically smaller one first.
struct Piece {
  std::int32_t from, to;
};

inline geometry::Point centre(const geometry::Point* points, Piece piece) {
  const geometry::Point a = points[piece.from], b = points[piece.to];
  return {0.5 * a.x + 0.5 * b.x, 0.5 * a.y + 0.5 * b.y};
}

using Pairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

/// Takes a pair. Returns whether to go on.
using FoundPair = std::function<bool(std::int32_t first, std::int32_t second)>;

/// Calls `found` with all pairs of pieces that cross: have exactly one common point, which is inside of both.
/// The smaller number is first. Pairs come in any order, and some of them several times. No vertex may be
/// inside of a piece. O((n + k) log n) for k pairs, with the exceptions in pairs.cpp, and O(n) memory.
void find_crossings(const geometry::Predicates& predicates, const geometry::Point* points,
                    const std::vector<Piece>& pieces, const FoundPair& found);

/// All pairs of a piece and a vertex inside of it, in ascending order of the piece, and along it. Different
/// pieces must not have more than one common point. vertices: in lexicographic order.
Pairs inner_vertices(const geometry::Predicates& predicates, const geometry::Point* points,
                     const std::vector<Piece>& pieces, const std::vector<std::int32_t>& vertices);

}  // namespace flaunay::constrained
