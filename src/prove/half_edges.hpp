// Half-edges of a list of triangles. Half-edge 3 t + k is the side of triangle t opposite to its corner k:
// from corner k + 1 to corner k + 2.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "mesh/corners.hpp"

namespace flaunay::prove {

/// Corner: an integer that names a vertex. Number: an integer that names a half-edge, or kNone for none.
template <typename Corner, typename Number>
struct HalfEdges {
  static constexpr Number kNone = static_cast<Number>(-1);

  const Corner* corners;

  static Number successor(Number h) { return mesh::next_corner(h); }
  Corner origin(Number h) const { return corners[successor(h)]; }
  Corner target(Number h) const { return corners[successor(successor(h))]; }

  /// Finds the twin of each of `count` half-edges, or kNone on the border. Returns the first half-edge that
  /// repeats one of an earlier triangle, or `count`. begins, keys: room for vertices + 1 and for `count`
  /// values.
  ///
  /// Half-edges are collected by their smaller end (counting sort), and sorted there by the other end,
  /// direction and triangle. These and the triangle identify a half-edge and fit into 31 + 1 + 32 bits.
  Number match(Number count, std::size_t vertices, Number* begins, std::uint64_t* keys, Number* twins) const {
    std::fill_n(begins, vertices + 1, Number{0});
    for (Number h = 0; h < count; ++h) ++begins[std::min(origin(h), target(h))];
    Number sum = 0;
    for (std::size_t v = 0; v <= vertices; ++v) {
      const Number size = begins[v];
      begins[v] = sum;
      sum += size;
    }
    for (Number h = 0; h < count; ++h) {
      const auto from = static_cast<std::uint64_t>(origin(h)), to = static_cast<std::uint64_t>(target(h));
      const std::uint64_t edge = std::max(from, to) << 1 | (from > to ? 1 : 0);
      keys[begins[std::min(from, to)]++] = edge << 32 | static_cast<std::uint64_t>(h / 3);
    }
    std::fill_n(twins, count, kNone);
    Number repeated = count;
    Number begin = 0;
    for (std::size_t v = 0; v < vertices; ++v) {
      const Number end = begins[v];  // placing the keys moved it there
      std::sort(keys + begin, keys + end);
      for (Number i = begin; i + 1 < end; ++i) {
        if (keys[i] >> 32 == keys[i + 1] >> 32) {
          repeated = std::min(repeated, half_edge_of(keys[i + 1], v));
        } else if (keys[i] >> 33 == keys[i + 1] >> 33) {
          const Number upward = half_edge_of(keys[i], v), downward = half_edge_of(keys[i + 1], v);
          twins[upward] = downward;
          twins[downward] = upward;
        }
      }
      begin = end;
    }
    return repeated;
  }

  /// The first half-edge between the ends of this one, in its direction.
  Number first_like(Number half_edge) const {
    Number h = 0;
    while (origin(h) != origin(half_edge) || target(h) != target(half_edge)) ++h;
    return h;
  }

 private:
  /// The half-edge that has this key among those whose smaller end is v.
  Number half_edge_of(std::uint64_t key, std::size_t v) const {
    const auto first = static_cast<Number>(3 * (key & 0xffffffffu));
    const bool downward = (key >> 32 & 1) != 0;
    Number h = first;
    while (h < first + 2 && static_cast<std::size_t>(downward ? target(h) : origin(h)) != v) ++h;
    return h;
  }
};

}  // namespace flaunay::prove
