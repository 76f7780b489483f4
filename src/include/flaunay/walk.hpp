// Handles to walk around the vertices and through the triangles of a mesh. Header only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay {

/// A corner of a triangle of a mesh with neighbours, which must outlive it. All steps are O(1).
class Corner {
 public:
  /// position: 0, 1 or 2.
  Corner(const Triangulation& mesh, std::int32_t triangle, int position)
      : mesh_(&mesh), triangle_(triangle), position_(position) {}

  /// The triangle.
  std::int32_t triangle() const { return triangle_; }
  /// Where it is in its row: 0, 1 or 2.
  int position() const { return position_; }
  /// The point.
  std::int32_t vertex() const { return mesh_->triangles[index()]; }
  /// The next corner of the triangle, counter-clockwise.
  Corner next() const { return {*mesh_, triangle_, (position_ + 1) % 3}; }
  /// The corner of the triangle before this one.
  Corner previous() const { return {*mesh_, triangle_, (position_ + 2) % 3}; }
  /// The corner opposite to this one beyond the edge between the other two; nothing at the border.
  std::optional<Corner> across() const {
    const std::int32_t beyond = mesh_->neighbors[index()];
    if (beyond < 0) return std::nullopt;
    // Two triangles have at most one edge in common.
    for (int k = 0; k < 2; ++k) {
      if (mesh_->neighbors[3 * static_cast<std::size_t>(beyond) + static_cast<std::size_t>(k)] == triangle_)
        return Corner(*mesh_, beyond, k);
    }
    return Corner(*mesh_, beyond, 2);
  }
  /// The same point's corner in the next triangle around it, counter-clockwise; nothing at the border.
  std::optional<Corner> counter_clockwise() const {
    const std::optional<Corner> beyond = next().across();
    if (!beyond) return std::nullopt;
    return beyond->next();
  }
  /// As counter_clockwise, the other way round.
  std::optional<Corner> clockwise() const {
    const std::optional<Corner> beyond = previous().across();
    if (!beyond) return std::nullopt;
    return beyond->previous();
  }
  /// Whether both are the same corner of the same mesh.
  bool operator==(const Corner& other) const {
    return mesh_ == other.mesh_ && triangle_ == other.triangle_ && position_ == other.position_;
  }
  /// Whether they are not.
  bool operator!=(const Corner& other) const { return !(*this == other); }

 private:
  std::size_t index() const {
    return 3 * static_cast<std::size_t>(triangle_) + static_cast<std::size_t>(position_);
  }

  const Triangulation* mesh_;
  std::int32_t triangle_;
  int position_;
};

/// A corner of each point of a mesh.
class Corners {
 public:
  /// The mesh must outlive it. Throws Error(usage) for a mesh without neighbours. O(n).
  explicit Corners(const Triangulation& mesh) : mesh_(&mesh), first_(mesh.representatives.size(), -1) {
    if (mesh.neighbors.size() != mesh.triangles.size())
      throw Error(ErrorKind::usage, "walks need a triangulation with neighbours");
    for (std::size_t c = mesh.triangles.size(); c-- > 0;)
      first_[static_cast<std::size_t>(mesh.triangles[c])] = static_cast<std::int32_t>(c);
  }

  /// A corner of a point; nothing if it is in no triangle. O(1).
  std::optional<Corner> at(std::int32_t vertex) const {
    const std::int32_t c = first_[static_cast<std::size_t>(vertex)];
    if (c < 0) return std::nullopt;
    return Corner(*mesh_, c / 3, c % 3);
  }
  /// Calls visit(corner) for all corners of a point that are connected around it with the first one,
  /// counter-clockwise; from the border on if there is one. O(k) for k triangles.
  template <typename Visit>
  void around(std::int32_t vertex, const Visit& visit) const {
    const std::optional<Corner> start = at(vertex);
    if (!start) return;
    Corner first = *start;
    while (const std::optional<Corner> before = first.clockwise()) {
      first = *before;
      if (first == *start) break;
    }
    std::optional<Corner> corner = first;
    do {
      visit(*corner);
      corner = corner->counter_clockwise();
    } while (corner && *corner != first);
  }
  /// The points that a point has an edge to, counter-clockwise. O(k).
  std::vector<std::int32_t> adjacent(std::int32_t vertex) const {
    std::vector<std::int32_t> points;
    around(vertex, [&](const Corner& corner) {
      if (points.empty() || points.back() != corner.next().vertex()) points.push_back(corner.next().vertex());
      if (corner.previous().vertex() != points.front()) points.push_back(corner.previous().vertex());
    });
    return points;
  }

 private:
  const Triangulation* mesh_;
  std::vector<std::int32_t> first_;
};

}  // namespace flaunay
