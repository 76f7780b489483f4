// The constraint edges, linked to the straight chains that segments run along.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/predicates.hpp"

namespace flaunay::sequential {

/// Edges in the order in which they became constraints, each directed from its lexicographically smaller
/// vertex to the other one. Edges of one segment that follow each other are linked, so every segment runs
/// along a part of one chain.
class Constraints {
 public:
  explicit Constraints(const geometry::Point* points) : points_(points) {}

  std::size_t size() const { return edges_.size(); }
  std::int32_t from(std::int32_t edge) const { return edges_[edge].from; }
  std::int32_t to(std::int32_t edge) const { return edges_[edge].to; }
  std::int32_t owner(std::int32_t edge) const { return edges_[edge].owner; }

  /// Adds the edge between two vertices, and returns its number. owner: the segment that it is made for.
  std::int32_t add(std::int32_t a, std::int32_t b, std::int32_t owner);
  /// Links two edges, the second of which begins where the first ends; no-op if either is -1.
  void link(std::int32_t first, std::int32_t second);
  /// The first and the last edge of an edge's chain. O(log n), amortised.
  std::int32_t first_of_chain(std::int32_t edge);
  std::int32_t last_of_chain(std::int32_t edge);

  /// Numbers the edges along their chains, and the chains by their first and second vertex. No more links
  /// after that.
  void sort();
  /// The ends of all edges, two per edge, in this order.
  std::vector<std::int32_t> sorted_edges() const;
  /// After sort: the number of the edge that begins at a vertex of a chain, or where the chain ends, the
  /// number after its last edge. edge: any of the chain. O(log n).
  std::int32_t number_from(std::int32_t edge, std::int32_t vertex) const;

 private:
  struct Edge {
    std::int32_t from, to, owner;
    std::int32_t previous = -1, next = -1;     // in the chain
    std::int32_t backward = -1, forward = -1;  // shortcuts
  };

  bool comes_before(std::int32_t u, std::int32_t v) const {
    return kernel::comes_before(points_[u], points_[v]);
  }
  std::int32_t end_of_chain(std::int32_t edge, std::int32_t Edge::*shortcut);

  const geometry::Point* points_;
  std::vector<Edge> edges_;
  std::vector<std::int32_t> order_, number_;  // by number the edge, and the other way round
  std::vector<std::int32_t> chain_of_;        // by number
  std::vector<std::int32_t> chain_offsets_;  // the numbers at which chains begin, and the end of the last one
};

}  // namespace flaunay::sequential
