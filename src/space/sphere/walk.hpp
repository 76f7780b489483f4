// Walks over a triangulation on the sphere.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "space/sphere/predicates.hpp"

namespace flaunay::sphere {

/// A triangle, and on which sides of its arcs a query lies: 1 inside, 0 on the arc opposite to the corner.
struct Found {
  std::int32_t triangle = -1;
  std::array<int, 3> sides{};

  /// The corner at which the query lies; -1 if it lies at none.
  int corner() const {
    const int on = (sides[0] == 0) + (sides[1] == 0) + (sides[2] == 0);
    return on < 2 ? -1 : sides[0] != 0 ? 0 : sides[1] != 0 ? 1 : 2;
  }
};

/// A triangulation of sets of points, on which any number of threads can walk at once. Refers to its arrays.
class Walker {
 public:
  /// O(t). The mesh is one on the sphere, as a call made it.
  explicit Walker(const Triangulation& mesh);

  Point place(std::int32_t v) const { return place_at(mesh_.places, static_cast<std::size_t>(v)); }
  std::int32_t corner(std::int32_t t, int k) const {
    return mesh_.triangles[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(k % 3)];
  }

  /// From vertex v to that of its set which is nearest, and of several the first one: each step goes to a
  /// better neighbour. The nearest points are the corners of one face of the hull in space, in which all are
  /// neighbours of the first, so that no step is missing.
  std::int32_t nearest(Point query, std::int32_t v) const;
  /// The nearest points in their order, equal ones by their indices; fewer than `count` only if there are no
  /// more. The first one is the vertex v. Each of the others is a neighbour of one that is nearer: a circle
  /// through it, within the circle of what is nearer, has no point inside but for some that are nearer than
  /// itself.
  std::vector<std::int32_t> nearest_points(Point query, std::int32_t v, std::size_t count) const;
  /// From the vertex nearest to the query, where one near it is vertex v, across arcs that the query lies
  /// beyond. In space, its ray's distance to the triangles' planes grows from step to step, and so the walk
  /// ends. No triangle, if none has the query.
  Found find(Point query, std::int32_t v) const;
  /// The weights of the triangle's corners where the query's direction meets it.
  std::array<double, 3> weights(const Found& found, Point query) const;
  std::int32_t beyond(std::int32_t t, int k) const {
    return mesh_.neighbors[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(k % 3)];
  }
  int corner_of(std::int32_t t, std::int32_t v) const;
  /// Whether a triangle turns left, as seen from the sphere's centre.
  bool is_seen(std::int32_t t) const { return is_seen_[static_cast<std::size_t>(t)] != 0; }
  /// A triangle of a vertex, one that is seen if there is one; -1 if it has none.
  std::int32_t triangle_at(std::int32_t v) const { return triangle_at_[static_cast<std::size_t>(v)]; }

 private:
  Found found(std::int32_t t, Point query) const;
  Found smallest(Found here, Point query) const;

  // The other vertex of a set of two points; -1 of one. A set without triangles has not more.
  std::int32_t other_of(std::int32_t v) const;

  const Triangulation& mesh_;
  /// Whether each triangle turns left, as seen from the sphere's centre: all do unless the points lie
  /// within a hemisphere.
  std::vector<std::uint8_t> is_seen_;
  /// The next point that the same point represents, for each point, or -1.
  std::vector<std::int32_t> next_equal_;
  /// A triangle of each vertex, one that is seen if there is one; -1 if it has none.
  std::vector<std::int32_t> triangle_at_;
};

}  // namespace flaunay::sphere
