// The canonical constrained Delaunay triangulation of the polygon that a segment leaves on one of its sides.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/predicates.hpp"

namespace flaunay::sequential {

/// Positions in a chain, ascending. A triangle (i, j, k) is counter-clockwise as (i, k, j).
using ChainTriangle = std::array<std::int32_t, 3>;

/// Triangulates polygons between a base and a chain.
///
/// A chain is what bounds, on the left, the triangles that a segment from its first vertex to its last one
/// crosses. The polygon is to the left of the base and to the right of the chain. All vertices between the
/// ends see the base and are strictly left of it. A vertex is in the chain several times if edges end inside
/// of the polygon.
class PolygonTriangulator {
 public:
  /// Chains up to this number of vertices are triangulated by gift-wrapping, which is then faster.
  static constexpr std::size_t kGiftWrapped = 24;

  PolygonTriangulator(const geometry::Predicates& predicates, const geometry::Point* points)
      : predicates_(predicates), points_(points) {}

  /// Returns the chain's triangles in preorder of the tree whose root is the triangle at the base: by
  /// ascending first position, then by descending last position. Expected time O(k log k) for k vertices,
  /// whatever their places.
  const std::vector<ChainTriangle>& triangulate(const std::vector<std::int32_t>& chain);

  /// How many chains were triangulated by random insertion, and how many of those had to be triangulated
  /// again by gift-wrapping.
  std::size_t insertions() const { return insertions_; }
  std::size_t repetitions() const { return repetitions_; }

 private:
  // Gift-wrapping (Anglada 1997): the apex of a base is the vertex whose circle with it has no other inside.
  // O(k) per triangle.
  void wrap();
  std::int32_t apex(std::int32_t i, std::int32_t k) const;

  // Random insertion (Shewchuk and Brown 2015), whose result is checked. Returns false if it is wrong.
  bool insert_all();
  void choose_order();
  void insert(std::int32_t position);
  void attach(std::int32_t halfedge, std::int32_t beyond);
  bool is_canonical() const;
  void list_triangles();

  geometry::Point point(std::int32_t position) const { return points_[(*chain_)[position]]; }
  int orient(std::int32_t a, std::int32_t b, std::int32_t c) const {
    return predicates_.orient(point(a), point(b), point(c));
  }
  int circle(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) const {
    return kernel::circle_canonical(point(a), point(b), point(c), point(d), predicates_.bounds.circle);
  }

  // An edge to triangulate beyond, or during insertion one that the new vertex sees.
  struct Open {
    std::int32_t from, to, beyond;
  };

  geometry::Predicates predicates_;
  const geometry::Point* points_;
  const std::vector<std::int32_t>* chain_ = nullptr;
  std::vector<ChainTriangle> result_;
  std::vector<Open> open_;
  std::size_t insertions_ = 0, repetitions_ = 0;

  // Of random insertion: the polygon of the vertices inserted so far, as a list; per vertex the half-edge
  // inside of the edge to the next one; and triangles, whose twins are half-edges or sides of the polygon.
  std::vector<std::int32_t> order_, next_, previous_, inside_, triangles_, twins_, free_;
};

}  // namespace flaunay::sequential
