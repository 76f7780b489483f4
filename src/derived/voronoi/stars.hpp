// The triangles around points, of which cells in host memory are made, in all spaces.
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

/// The stars of n points: their corners, 3 t + k, counter-clockwise. The mesh must outlive them. The first
/// one is the smallest, or on the hull that at the edge which leaves the point. In a set without triangles,
/// corners are places in the hull, which has the points in their order on a line.
class Stars {
 public:
  Stars(const Triangulation& mesh, std::size_t n)
      : count_(mesh.triangles.empty() ? mesh.hull.size() : mesh.triangles.size()),
        corners_(mesh.triangles.empty() ? mesh.hull.data() : mesh.triangles.data()),
        neighbors_(mesh.neighbors.data()),
        steps_(mesh.corner_offsets.empty() ? nullptr : mesh.corner_offsets.data()),
        firsts_(n, -1),
        offsets_(n + 1) {
    for (std::size_t c = count_; c-- > 0;) {
      const auto v = static_cast<std::size_t>(corners_[c]);
      ++offsets_[v + 1];
      firsts_[v] = static_cast<std::int32_t>(c);
    }
    std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
    for (std::size_t c = 0; !mesh.hull.empty() && c < mesh.triangles.size(); ++c) {
      if (neighbors_[mesh::corner_before(c)] < 0)
        firsts_[static_cast<std::size_t>(corners_[c])] = static_cast<std::int32_t>(c);
    }
  }

  /// n + 1 values: point i has corners offsets[i] up to offsets[i + 1], if those of all points are in a row.
  const std::vector<std::int32_t>& offsets() const { return offsets_; }
  /// The number of corners of point v.
  std::int32_t size(std::int32_t v) const {
    return offsets_[static_cast<std::size_t>(v) + 1] - offsets_[static_cast<std::size_t>(v)];
  }
  std::int32_t point(std::int32_t c) const { return corners_[c]; }
  /// The same point's corner in the next triangle, counter-clockwise; -1 beyond the hull. On a torus a point
  /// can have several corners of a triangle, but an edge has other offsets than any other; -1 if it has not.
  std::int32_t next(std::int32_t c) const {
    const std::int32_t t = neighbors_[mesh::next_corner(c)], p = point(c);
    if (t < 0) return -1;
    const std::int32_t* const corners = corners_ + 3 * static_cast<std::ptrdiff_t>(t);
    if (steps_ == nullptr) return 3 * t + (corners[0] == p ? 0 : corners[1] == p ? 1 : 2);
    const std::int32_t before = mesh::corner_before(c), q = point(before);
    for (std::int32_t at = 3 * t; at < 3 * t + 3; ++at) {
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

  /// The number of runs in which for_each takes points.
  std::size_t runs() const { return geometry::runs_of(count_); }
  /// Calls work(run, v, c) for each point with corners, of which c is the first one, and fetch(v) some time
  /// before. In the order of corners, those of a star are near each other in memory.
  template <typename Fetch, typename Work>
  void for_each(host::Runtime& runtime, const Fetch& fetch, const Work& work) const {
    geometry::for_each_run(&runtime, count_, [&](std::size_t run, std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) {
        const auto soon = static_cast<std::size_t>(corners_[std::min(c + 3 * kTrianglesAhead, count_ - 1)]);
        kernel::fetch(&firsts_[soon]);
        fetch(soon);
        const std::int32_t v = corners_[c], first = firsts_[static_cast<std::size_t>(v)];
        if (static_cast<std::size_t>(first) == c) work(run, v, first);
      }
    });
  }

 private:
  const std::size_t count_;
  const std::int32_t *const corners_, *const neighbors_;
  const std::int8_t* const steps_;
  std::vector<std::int32_t> firsts_, offsets_;
};

}  // namespace flaunay::voronoi
