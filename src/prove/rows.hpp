// Checks that proofs of meshes with neighbours share in all spaces: sets, representatives, rows, and mutual
// neighbours.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "mesh/corners.hpp"
#include "prove/describe.hpp"
#include "prove/exact.hpp"

namespace flaunay::prove {

/// The arrays that meshes of all spaces have. Sizes fit each other, and indices are in their ranges.
struct Rows {
  const std::vector<std::int32_t>&triangles, &neighbors, &representatives;
  const std::vector<std::size_t>&point_offsets, &triangle_offsets;
};

/// Whether the last of four weighted points is below the plane through the others when they are lifted. These
/// turn left. Lifts are lowered by an infinitesimal part of x^2 + y^2, so that a point on the plane of others
/// is hidden; and among points on one circle, the lift of the lexicographically smallest is lowered further.
inline bool is_below(ExactPredicates& predicates, const std::array<const double*, 4>& p,
                     const std::array<double, 4>& weights) {
  const bool are_alike = weights[0] == weights[3] && weights[1] == weights[3] && weights[2] == weights[3];
  const int power = predicates.power(p[0], p[1], p[2], p[3], are_alike ? nullptr : weights.data());
  if (power != 0) return power > 0;
  const int circle = are_alike ? 0 : predicates.incircle(p[0], p[1], p[2], p[3]);
  if (circle != 0) return circle < 0;
  // The edge across which the last one lies, or if it lies inside none.
  for (std::size_t k = 0; k < 3; ++k) {
    const double *const from = p[(k + 1) % 3], *const to = p[(k + 2) % 3];
    if (predicates.orient2d(from, to, p[3]) < 0) return !is_of_fan(from, to, p[k], p[3]);
  }
  return false;
}

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

  /// Sorts points so that walks from one to the next are short.
  static void sort_along_strips(const double* places, std::vector<std::int32_t>& points) {
    const auto at = [&](std::int32_t i) { return places + 2 * index(i); };
    std::sort(points.begin(), points.end(),
              [&](std::int32_t a, std::int32_t b) { return comes_before(at(a), at(b)); });
    const auto strip = static_cast<std::size_t>(std::sqrt(static_cast<double>(points.size()))) + 1;
    for (std::size_t begin = 0; begin < points.size(); begin += strip) {
      const bool is_upward = begin / strip % 2 == 0;
      std::sort(points.begin() + static_cast<std::ptrdiff_t>(begin),
                points.begin() + static_cast<std::ptrdiff_t>(std::min(begin + strip, points.size())),
                [&](std::int32_t a, std::int32_t b) {
                  return is_upward ? at(a)[1] < at(b)[1] : at(b)[1] < at(a)[1];
                });
    }
  }

  const Rows rows_;
  std::size_t first_ = 0, last_ = 0, begin_ = 0, end_ = 0;  // points and triangles of the set
};

}  // namespace flaunay::prove
