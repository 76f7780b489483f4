// Whether a result is the canonical constrained Delaunay triangulation, by its definition in
// docs/constrained.md. Shares no code with src/constrained.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "flaunay/constrained.hpp"
#include "flaunay/research.hpp"
#include "prove/exact.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::testing {

using Segments = std::vector<std::int32_t>;
using Edge = std::pair<std::int32_t, std::int32_t>;

inline Edge unordered(std::int32_t a, std::int32_t b) { return {std::min(a, b), std::max(a, b)}; }

inline Triangulation delaunay_of(const Coordinates& points, const std::vector<std::size_t>& offsets) {
  research::Options options;
  options.mode = research::Mode::dwyer;
  return research::triangulate_on_host(points.data(), offsets, options);
}

/// A point set and its exact predicates.
class Plane {
 public:
  explicit Plane(const Coordinates& points) : points_(points) {}

  const double* at(std::int32_t i) const { return &points_[2 * static_cast<std::size_t>(i)]; }
  int orient(std::int32_t a, std::int32_t b, std::int32_t c) { return exact_.orient2d(at(a), at(b), at(c)); }
  int circle(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    return exact_.incircle(at(a), at(b), at(c), at(d));
  }
  bool before(std::int32_t a, std::int32_t b) const {
    const double *const p = at(a), *const q = at(b);
    return p[0] < q[0] || (p[0] == q[0] && p[1] < q[1]);
  }
  /// Whether v is on the segment, its ends included.
  bool on_segment(std::int32_t a, std::int32_t b, std::int32_t v) {
    if (before(b, a)) std::swap(a, b);
    return !before(v, a) && !before(b, v) && orient(a, b, v) == 0;
  }
  /// Whether two segments have exactly one common point, inside of both.
  bool cross(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    return orient(a, b, c) * orient(a, b, d) < 0 && orient(c, d, a) * orient(c, d, b) < 0;
  }

 private:
  const Coordinates& points_;
  ExactPredicates exact_;
};

/// The edges that each segment consists of, from its lexicographically smaller end: between distinct points
/// on it.
std::vector<std::vector<Edge>> expected_edges(const Coordinates& points,
                                              const std::vector<std::size_t>& offsets,
                                              const Triangulation& delaunay, const Segments& segments);

/// A triangle that is not part of a fan from the lexicographically smallest vertex of its cell; -1 if there
/// is none. Cells are of triangles with one circle, and end at constrained edges.
std::int32_t find_no_fan(const Coordinates& points, const Triangulation& mesh,
                         const std::vector<std::uint8_t>& constrained = {});

/// That segments map to the edges that they consist of, and each edge is listed once, in the right order.
void expect_edges(const std::vector<std::vector<Edge>>& expected, const ConstrainedTriangulation& result);

/// That the triangles are a triangulation of the same points with the same border as the Delaunay
/// triangulation, that constraints are edges of it, and that all others are locally Delaunay; that cells are
/// fans from their first vertex; and the order of rows.
void expect_canonical(const Coordinates& points, const Triangulation& delaunay,
                      const ConstrainedTriangulation& result);

/// The first segment that crosses an earlier one, and the first of those; {-1, -1} if none cross at a place
/// that is no point.
Edge expected_crossing(const std::vector<std::size_t>& offsets, const std::vector<std::vector<Edge>>& edges,
                       Plane& plane);

}  // namespace flaunay::testing
