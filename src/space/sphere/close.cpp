#include "space/sphere/close.hpp"

#include <algorithm>
#include <array>

#include "geometry/halfedges.hpp"
#include "space/sphere/places.hpp"

namespace flaunay::sphere {
namespace {

using geometry::next_halfedge;
using geometry::previous_halfedge;
using Ids = std::vector<std::int32_t>;
using Corners = std::array<std::int32_t, 3>;

// The farthest-point Delaunay triangulation of a strictly convex polygon: no vertex lies outside of a
// triangle's circle. Vertices come in a random order and swap edges until that holds (Chew, 1986); expected
// O(n). Of cocircular vertices, edges go from the first one.
class FarthestTriangulation {
 public:
  /// polygon: counter-clockwise.
  explicit FarthestTriangulation(std::vector<Point> polygon) : polygon_(std::move(polygon)) {
    const std::size_t n = polygon_.size();
    Ids order(n), next(n), previous(n);
    for (std::size_t i = 0; i < n; ++i) {
      order[i] = static_cast<std::int32_t>(i);
      next[i] = static_cast<std::int32_t>((i + 1) % n);
      previous[i] = static_cast<std::int32_t>((i + n - 1) % n);
    }
    std::uint64_t state = 0;
    for (std::size_t i = n; i > 1; --i) {
      // Knuth's generator; the result does not depend on it.
      state = state * 6364136223846793005u + 1442695040888963407u;
      std::swap(order[i - 1], order[(state >> 33) % i]);
    }
    const auto at = [](Ids& list, std::int32_t i) -> std::int32_t& {
      return list[static_cast<std::size_t>(i)];
    };
    for (std::size_t i = n; i > 3; --i) {
      const std::int32_t v = order[i - 1];
      at(next, at(previous, v)) = at(next, v);
      at(previous, at(next, v)) = at(previous, v);
    }
    const std::int32_t a = order[0], b = at(next, a), c = at(next, b);
    add({a, b, c});
    outside_ = Ids(n, -1);
    at(outside_, a) = 0;
    at(outside_, b) = 1;
    at(outside_, c) = 2;
    for (std::size_t i = 3; i < n; ++i) insert(order[i], at(previous, order[i]), at(next, order[i]));
  }

  /// Three positions in the polygon per triangle, counter-clockwise.
  const std::vector<Corners>& triangles() const { return triangles_; }

 private:
  std::int32_t& from(std::int32_t e) {
    return triangles_[static_cast<std::size_t>(e / 3)][static_cast<std::size_t>(e % 3)];
  }
  std::int32_t& twin(std::int32_t e) { return twins_[static_cast<std::size_t>(e)]; }
  Point place(std::int32_t v) const { return polygon_[static_cast<std::size_t>(v)]; }
  // Edges of the polygon are kept by the vertex that they begin at.
  void join(std::int32_t e, std::int32_t other) {
    twin(e) = other;
    if (other >= 0) {
      twin(other) = e;
    } else {
      outside_[static_cast<std::size_t>(from(e))] = e;
    }
  }
  std::int32_t add(const Corners& corners) {
    triangles_.push_back(corners);
    twins_.resize(3 * triangles_.size(), -1);
    return static_cast<std::int32_t>(twins_.size()) - 3;
  }

  // Vertex v between two others.
  void insert(std::int32_t v, std::int32_t before, std::int32_t after) {
    const std::int32_t inside = outside_[static_cast<std::size_t>(before)];
    const std::int32_t e = add({v, after, before});
    join(e, -1);
    join(e + 2, -1);
    join(e + 1, inside);
    std::vector<std::int32_t> open = {e + 1};
    while (!open.empty()) {
      const std::int32_t edge = open.back();
      open.pop_back();
      if (twin(edge) < 0 || !has_to_go(edge)) continue;
      open.push_back(next_halfedge(twin(edge)));
      swap(edge);
      open.push_back(edge);
    }
  }

  // Whether the other diagonal is the right one.
  bool has_to_go(std::int32_t edge) {
    const std::int32_t other = twin(edge);
    const Point a = place(from(edge)), b = place(from(other)), c = place(from(previous_halfedge(edge))),
                d = place(from(previous_halfedge(other)));
    const int sign = kernel::circle_sign(a, b, c, d, CIRCLE_BOUND);
    if (sign != 0) return sign < 0;
    const auto is_first = [&](Point p) {
      return !kernel::comes_before(a, p) && !kernel::comes_before(b, p) && !kernel::comes_before(c, p) &&
             !kernel::comes_before(d, p);
    };
    return is_first(c) || is_first(d);
  }

  // Of the triangles a b c and b a d, whose common edge a b is, makes c d b and d c a: half-edge `edge` goes
  // from d to b then, and is opposite to c.
  void swap(std::int32_t edge) {
    const std::int32_t other = twin(edge), to_c = next_halfedge(edge), to_a = next_halfedge(to_c),
                       to_d = next_halfedge(other), to_b = next_halfedge(to_d);
    const std::int32_t beyond_a = twin(to_a), beyond_b = twin(to_b);
    from(edge) = from(to_b);
    from(other) = from(to_a);
    join(edge, beyond_b);
    join(other, beyond_a);
    join(to_a, to_b);
  }

  std::vector<Point> polygon_;
  std::vector<Corners> triangles_;
  Ids twins_, outside_;
};

// Triangles of the set on the sphere that the plane does not have, each from its smallest corner on, sorted.
class Beyond {
 public:
  explicit Beyond(const PlanarSet& set) : set_(set) {}

  std::vector<Corners> beyond_hull() {
    if (set_.pole >= 0) {
      for (std::size_t i = 0; i < size(); ++i) add(set_.pole, hull(i + 1), hull(i));
    } else {
      add_farthest();
    }
    return sorted();
  }

  // One side of a set whose points all lie on a circle through the pole, or else the other side.
  std::vector<Corners> side(bool other) {
    Ids polygon = set_.hull;
    if (set_.pole >= 0) polygon.insert(polygon.begin(), set_.pole);
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
      add(polygon[0], polygon[other ? i + 1 : i], polygon[other ? i : i + 1]);
    }
    return sorted();
  }

 private:
  std::size_t size() const { return set_.hull.size(); }
  std::int32_t hull(std::size_t i) const { return set_.hull[i % size()]; }
  Point place(std::size_t i) const { return set_.places[i % size()]; }
  void add(std::int32_t a, std::int32_t b, std::int32_t c) { triangles_.push_back({a, b, c}); }
  std::vector<Corners> sorted() {
    for (Corners& corners : triangles_) {
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    }
    std::sort(triangles_.begin(), triangles_.end());
    return std::move(triangles_);
  }

  // As seen from outside of the sphere, the hull's triangles are clockwise in the plane.
  void add_farthest() {
    std::vector<std::size_t> corners = {0};
    for (std::size_t i = 1; i < size(); ++i) {
      if (kernel::orient_sign(place(corners.back()), place(i), place(i + 1), ORIENT_BOUND) != 0)
        corners.push_back(i);
    }
    std::vector<Point> polygon;
    for (const std::size_t i : corners) polygon.push_back(place(i));
    const FarthestTriangulation farthest(std::move(polygon));
    for (const auto& [a, b, c] : farthest.triangles()) {
      add(hull(corners[static_cast<std::size_t>(a)]), hull(corners[static_cast<std::size_t>(c)]),
          hull(corners[static_cast<std::size_t>(b)]));
    }
    corners.push_back(size());
    for (std::size_t k = 0; k + 1 < corners.size(); ++k) add_straight(corners[k], corners[k + 1]);
  }

  // Points on one edge of the hull are on a circle through the pole.
  void add_straight(std::size_t first, std::size_t last) {
    const bool first_is_smaller = kernel::comes_before(place(first), place(last)) != 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      if (first_is_smaller) {
        add(hull(first), hull(i + 1), hull(i));
      } else {
        add(hull(last), hull(i), hull(i - 1));
      }
    }
  }

  const PlanarSet& set_;
  std::vector<Corners> triangles_;
};

// Appends triangles to a cap, and links those at edges that only two have. Leaves the other edges in `open`.
void append(const std::vector<Corners>& triangles, std::vector<OpenEdge>& open, std::int32_t first,
            Cap& cap) {
  for (const Corners& corners : triangles) {
    const auto t = first + static_cast<std::int32_t>(cap.triangles.size());
    for (std::size_t k = 0; k < 3; ++k)
      open.push_back({corners[(k + 1) % 3], corners[(k + 2) % 3], 3 * t + static_cast<std::int32_t>(k)});
    cap.triangles.push_back(corners);
  }
  const auto ends = [](const OpenEdge& e) { return std::minmax(e.from, e.to); };
  std::sort(open.begin(), open.end(),
            [&](const OpenEdge& a, const OpenEdge& b) { return ends(a) < ends(b); });
  std::vector<OpenEdge> rest;
  cap.links.reserve(cap.links.size() + open.size());
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (i + 1 == open.size() || ends(open[i]) != ends(open[i + 1])) {
      rest.push_back(open[i]);
      continue;
    }
    cap.links.push_back({open[i].at, open[i + 1].at / 3});
    cap.links.push_back({open[i + 1].at, open[i].at / 3});
    ++i;
  }
  open = std::move(rest);
}

}  // namespace

Cap close(const PlanarSet& set, std::vector<OpenEdge> open, std::size_t triangles) {
  Cap cap;
  const auto first = static_cast<std::int32_t>(triangles);
  if (triangles > 0) {
    append(Beyond(set).beyond_hull(), open, first, cap);
    return cap;
  }
  // First among themselves, since both sides have the same diagonals.
  append(Beyond(set).side(false), open, first, cap);
  append(Beyond(set).side(true), open, first, cap);
  return cap;
}

}  // namespace flaunay::sphere
