// Which straight pieces cross each other, and which points lie on them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "geometry/predicates.hpp"

namespace flaunay::constrained {

using namespace geometry;

/// A straight piece between two vertices, the lexicographically smaller one first.
struct Piece {
  std::int32_t from, to;
};

using Pairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

/// All pairs of pieces that cross: have exactly one common point, which is inside of both; each pair once,
/// the smaller number first, in ascending order. No vertex may be inside of a piece. Throws Error(input) if
/// there are more pairs than `most`. O((n + k) log n) for k pairs, but for what is said in pairs.cpp.
Pairs crossing_pairs(const Predicates& predicates, const Point* points, const std::vector<Piece>& pieces,
                     std::size_t most);

/// All pairs of a piece and a vertex inside of it, in ascending order of the piece, and along it. Different
/// pieces must not have more than one common point. vertices: in lexicographic order.
Pairs inner_vertices(const Predicates& predicates, const Point* points, const std::vector<Piece>& pieces,
                     const std::vector<std::int32_t>& vertices);

}  // namespace flaunay::constrained
