// Checks that proofs of meshes with neighbours share in all spaces: sets, representatives, rows, and mutual
// neighbours.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "mesh/corners.hpp"
#include "prove/describe.hpp"

namespace flaunay::prove {

/// The arrays that meshes of all spaces have. Sizes fit each other, and indices are in their ranges.
struct Rows {
  const std::vector<std::int32_t>&triangles, &neighbors, &representatives;
  const std::vector<std::size_t>&point_offsets, &triangle_offsets;
};

/// The checks of one set after the other.
class RowsProof {
 public:
  explicit RowsProof(const Rows& rows) : rows_(rows) {}

 protected:
  static std::size_t index(std::int64_t i) { return static_cast<std::size_t>(i); }
  std::size_t sets() const { return rows_.point_offsets.size() - 1; }
  const std::int32_t* corners(std::size_t t) const { return &rows_.triangles[3 * t]; }
  bool represents_itself(std::size_t i) const { return index(rows_.representatives[i]) == i; }

  void enter(std::size_t s) {
    first_ = rows_.point_offsets[s];
    last_ = rows_.point_offsets[s + 1];
    begin_ = rows_.triangle_offsets[s];
    end_ = rows_.triangle_offsets[s + 1];
  }

  /// The first of all points with the same key must represent them. O(n log n) for n points of the set.
  template <typename Key>
  void check_representatives(const Key& key) const {
    std::vector<std::size_t> order(last_ - first_);
    std::iota(order.begin(), order.end(), first_);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::pair(key(a), a) < std::pair(key(b), b); });
    std::size_t smallest = first_;
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k == 0 || key(order[k - 1]) != key(order[k])) smallest = order[k];
      require(index(rows_.representatives[order[k]]) == smallest, "point {} has a wrong representative",
              order[k]);
    }
  }

  /// A corner or hull vertex must be a point of the set that represents itself.
  void check_vertex(std::int32_t v, std::size_t t) const {
    require(index(v) >= first_ && index(v) < last_ && represents_itself(index(v)),
            "triangle {} has a corner {} of another set, or that another point represents", t, v);
  }

  /// The corner across the edge opposite to corner c, which has a neighbour. is_same(d): whether the edge
  /// opposite to corner d of the neighbour is the same one, in the other direction.
  template <typename IsSame>
  std::size_t across(std::size_t c, const IsSame& is_same) const {
    const std::size_t t = c / 3, other = index(rows_.neighbors[c]);
    require(other >= begin_ && other < end_, "triangle {} has a neighbor of another set", t);
    for (std::size_t d = 3 * other; d < 3 * other + 3; ++d) {
      if (index(rows_.neighbors[d]) == t && is_same(d)) return d;
    }
    violate("triangles {} and {} are not neighbors of each other", t, other);
  }
  /// If corners that are the same point are the same vertex.
  std::size_t across(std::size_t c) const {
    return across(c, [&](std::size_t d) { return from(d) == to(c) && to(d) == from(c); });
  }
  /// Where the edge opposite to corner c begins and ends.
  std::int32_t from(std::size_t c) const { return rows_.triangles[after(c)]; }
  std::int32_t to(std::size_t c) const { return rows_.triangles[after(after(c))]; }
  static std::size_t after(std::size_t c) { return mesh::next_corner(c); }

  const Rows rows_;
  std::size_t first_ = 0, last_ = 0, begin_ = 0, end_ = 0;  // points and triangles of the set
};

}  // namespace flaunay::prove
