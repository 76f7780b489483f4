// The triangles around points, of which cells on a torus and on the sphere are made.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "geometry/for_each.hpp"
#include "mesh/corners.hpp"
#include "operations/prefetch.h"

namespace flaunay::voronoi {

/// How many triangles ahead what belongs to their corners is fetched, which can be anywhere in memory.
constexpr std::size_t kTrianglesAhead = 16;

/// Calls work(t) for each triangle, and before that fetch(v) for the corners of a later one.
template <typename Fetch, typename Work>
void for_each_triangle(host::Runtime& runtime, const Triangulation& mesh, const Fetch& fetch,
                       const Work& work) {
  const std::size_t count = mesh.triangles.size() / 3;
  geometry::for_each(runtime, count, [&](std::size_t t) {
    const std::size_t soon = 3 * std::min(t + kTrianglesAhead, count - 1);
    for (std::size_t c = soon; c < soon + 3; ++c) fetch(static_cast<std::size_t>(mesh.triangles[c]));
    work(t);
  });
}

/// The stars of n points of a surface without border: their corners, 3 t + k, counter-clockwise from the
/// smallest. The mesh must outlive them.
class Stars {
 public:
  Stars(const Triangulation& mesh, std::size_t n)
      : count_(mesh.triangles.size()),
        corners_(mesh.triangles.data()),
        neighbors_(mesh.neighbors.data()),
        steps_(mesh.corner_offsets.data()),
        firsts_(n, -1),
        offsets_(n + 1) {
    for (std::size_t c = count_; c-- > 0;) {
      const auto v = static_cast<std::size_t>(corners_[c]);
      ++offsets_[v + 1];
      firsts_[v] = static_cast<std::int32_t>(c);
    }
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  }

  /// n + 1 values: point i has corners offsets[i] up to offsets[i + 1], if those of all points are in a row.
  const std::vector<std::int32_t>& offsets() const { return offsets_; }
  /// The number of corners of point v.
  std::int32_t size(std::int32_t v) const {
    return offsets_[static_cast<std::size_t>(v) + 1] - offsets_[static_cast<std::size_t>(v)];
  }
  std::int32_t point(std::int32_t c) const { return corners_[c]; }
  /// On a torus, the same point's corner in the next triangle, counter-clockwise; -1 if there is none. A
  /// point can have several corners of a triangle, but an edge has other offsets than any other.
  std::int32_t next(std::int32_t c) const {
    const std::int32_t before = mesh::next_corner(mesh::next_corner(c)), p = point(c), q = point(before);
    const std::int32_t t = neighbors_[mesh::next_corner(c)];
    for (std::int32_t at = 3 * t; t >= 0 && at < 3 * t + 3; ++at) {
      const std::int32_t to = mesh::next_corner(at);
      if (point(at) == p && point(to) == q && step(at, to, 0) == step(c, before, 0) &&
          step(at, to, 1) == step(c, before, 1))
        return at;
    }
    return -1;
  }
  /// On a torus, the number of vectors of the lattice from one corner of a triangle to another one.
  std::int32_t step(std::int32_t from, std::int32_t to, std::size_t axis) const {
    return steps_[2 * static_cast<std::size_t>(to) + axis] -
           steps_[2 * static_cast<std::size_t>(from) + axis];
  }

  /// Calls work(v, c) for each point with corners, of which c is the first one, and fetch(v) some time
  /// before. In the order of corners, those of a star are near each other in memory.
  template <typename Fetch, typename Work>
  void for_each(host::Runtime& runtime, const Fetch& fetch, const Work& work) const {
    geometry::for_each(runtime, count_, [&](std::size_t c) {
      const auto soon = static_cast<std::size_t>(corners_[std::min(c + 3 * kTrianglesAhead, count_ - 1)]);
      kernel::fetch(&firsts_[soon]);
      fetch(soon);
      const std::int32_t v = corners_[c], first = firsts_[static_cast<std::size_t>(v)];
      if (static_cast<std::size_t>(first) == c) work(v, first);
    });
  }

 private:
  const std::size_t count_;
  const std::int32_t *const corners_, *const neighbors_;
  const std::int8_t* const steps_;
  std::vector<std::int32_t> firsts_, offsets_;
};

}  // namespace flaunay::voronoi
