// Whether a result is the canonical constrained Delaunay triangulation, by its definition in
// docs/constrained.md. Shares no code with src/constrained.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "app/verify/exact.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/research.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/reference.hpp"

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
  bool before(std::int32_t a, std::int32_t b) const { return place(a) < place(b); }
  bool equal(std::int32_t a, std::int32_t b) const { return place(a) == place(b); }
  /// Whether v is on the segment, its ends included.
  bool on_segment(std::int32_t a, std::int32_t b, std::int32_t v) {
    return !before(v, std::min(place(a), place(b)) == place(a) ? a : b) &&
           !before(std::max(place(a), place(b)) == place(a) ? a : b, v) && orient(a, b, v) == 0;
  }
  /// Whether two segments have exactly one common point, inside of both.
  bool cross(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    return orient(a, b, c) * orient(a, b, d) < 0 && orient(c, d, a) * orient(c, d, b) < 0;
  }

 private:
  std::pair<double, double> place(std::int32_t i) const { return {at(i)[0], at(i)[1]}; }

  const Coordinates& points_;
  ExactPredicates exact_;
};

/// The edges that each segment consists of, from its lexicographically smaller end: between distinct points
/// on it.
inline std::vector<std::vector<Edge>> expected_edges(const Coordinates& points,
                                                     const std::vector<std::size_t>& offsets,
                                                     const Triangulation& delaunay,
                                                     const Segments& segments) {
  Plane plane(points);
  std::vector<std::vector<Edge>> all;
  for (std::size_t s = 0; s < segments.size(); s += 2) {
    const std::int32_t a = segments[s], b = segments[s + 1];
    const auto end = std::upper_bound(offsets.begin(), offsets.end(), static_cast<std::size_t>(a));
    std::vector<std::int32_t> on;
    for (auto v = static_cast<std::int32_t>(*(end - 1)); v < static_cast<std::int32_t>(*end); ++v) {
      if (delaunay.representatives[v] == v && !plane.equal(a, b) && plane.on_segment(a, b, v))
        on.push_back(v);
    }
    std::sort(on.begin(), on.end(), [&plane](std::int32_t u, std::int32_t v) { return plane.before(u, v); });
    std::vector<Edge> edges;
    for (std::size_t k = 1; k < on.size(); ++k) edges.emplace_back(on[k - 1], on[k]);
    all.push_back(edges);
  }
  return all;
}

/// That segments map to the edges that they consist of, and each edge is listed once, in the right order.
inline void expect_edges(const std::vector<std::vector<Edge>>& expected,
                         const ConstrainedTriangulation& result) {
  ASSERT_EQ(result.piece_edges.size(), 2 * expected.size());
  std::set<Edge> all, listed;
  for (std::size_t s = 0; s < expected.size(); ++s) {
    std::vector<Edge> edges;
    for (std::int32_t e = result.piece_edges[2 * s]; e < result.piece_edges[2 * s + 1]; ++e) {
      edges.emplace_back(result.constraint_edges.at(2 * e), result.constraint_edges.at(2 * e + 1));
    }
    EXPECT_EQ(edges, expected[s]) << "of segment " << s;
    all.insert(edges.begin(), edges.end());
  }
  for (std::size_t e = 0; e < result.constraint_edges.size(); e += 2) {
    EXPECT_TRUE(listed.emplace(result.constraint_edges[e], result.constraint_edges[e + 1]).second);
  }
  EXPECT_EQ(all, listed);
  // Chains of edges that follow each other on segments, in the order of their first edges.
  std::vector<bool> follows(result.constraint_edges.size() / 2, false);
  for (std::size_t s = 0; s < expected.size(); ++s) {
    for (std::int32_t e = result.piece_edges[2 * s] + 1; e < result.piece_edges[2 * s + 1]; ++e)
      follows[static_cast<std::size_t>(e)] = true;
  }
  Edge last{-1, -1};
  for (std::size_t e = 0; e < follows.size(); ++e) {
    if (follows[e]) continue;
    const Edge edge{result.constraint_edges[2 * e], result.constraint_edges[2 * e + 1]};
    EXPECT_LT(last, edge);
    last = edge;
  }
}

/// That the triangles are a triangulation of the same points with the same border as the Delaunay
/// triangulation, that constraints are edges of it, and that all others are locally Delaunay; that cells are
/// fans from their first vertex; and the order of rows.
inline void expect_canonical(const Coordinates& points, const Triangulation& delaunay,
                             const ConstrainedTriangulation& result) {
  Plane plane(points);
  const std::vector<std::int32_t>& triangles = result.triangles;
  ASSERT_EQ(triangles.size(), delaunay.triangles.size());
  const auto border = [](const std::vector<std::int32_t>& rows, const std::vector<std::int32_t>& neighbors) {
    std::set<Edge> edges;
    for (std::size_t c = 0; c < rows.size(); ++c) {
      const std::size_t t = c - c % 3;
      if (neighbors[c] < 0) edges.emplace(rows[t + (c + 1) % 3], rows[t + (c + 2) % 3]);
    }
    return edges;
  };
  ASSERT_EQ(result.neighbors, reference_neighbors(triangles));
  ASSERT_EQ(border(triangles, result.neighbors), border(delaunay.triangles, delaunay.neighbors));

  std::set<Edge> constraints, missing;
  for (std::size_t e = 0; e < result.constraint_edges.size(); e += 2) {
    constraints.insert(unordered(result.constraint_edges[e], result.constraint_edges[e + 1]));
  }
  // A set without triangles has no other edges to be among.
  const std::set<std::int32_t> vertices(triangles.begin(), triangles.end());
  EXPECT_EQ(vertices, std::set<std::int32_t>(delaunay.triangles.begin(), delaunay.triangles.end()));
  for (const Edge& edge : constraints) {
    if (vertices.count(edge.first) != 0) missing.insert(edge);
  }
  // Triangles of one cell, by union and find.
  std::vector<std::int32_t> cell(triangles.size() / 3), first(cell.size());
  for (std::size_t t = 0; t < cell.size(); ++t) cell[t] = static_cast<std::int32_t>(t);
  const auto root = [&cell](std::int32_t t) {
    while (cell[t] != t) t = cell[t] = cell[cell[t]];
    return t;
  };
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const std::size_t t = c - c % 3;
    const std::int32_t a = triangles[t], b = triangles[t + 1], d = triangles[t + 2];
    if (c == t) {
      ASSERT_GT(plane.orient(a, b, d), 0) << "triangle " << c / 3;
      ASSERT_TRUE(a < b && a < d) << "triangle " << c / 3;
    }
    const Edge edge = unordered(triangles[t + (c + 1) % 3], triangles[t + (c + 2) % 3]);
    ASSERT_EQ(result.constrained[c] != 0, constraints.count(edge) != 0) << edge.first << "-" << edge.second;
    missing.erase(edge);
    const std::int32_t beyond = result.neighbors[c];
    if (beyond < 0 || constraints.count(edge) != 0) continue;
    std::int32_t opposite = 3 * beyond;
    while (triangles[opposite] == edge.first || triangles[opposite] == edge.second) ++opposite;
    const int side = plane.circle(a, b, d, triangles[opposite]);
    ASSERT_LE(side, 0) << "edge " << edge.first << "-" << edge.second;
    if (side == 0) cell[root(static_cast<std::int32_t>(c / 3))] = root(beyond);
  }
  EXPECT_TRUE(missing.empty()) << missing.size() << " constraints are no edges";
  std::fill(first.begin(), first.end(), -1);
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    std::int32_t& v = first[root(static_cast<std::int32_t>(c / 3))];
    if (v < 0 || plane.before(triangles[c], v)) v = triangles[c];
  }
  for (std::size_t t = 0; t < cell.size(); ++t) {
    const auto row = triangles.begin() + static_cast<std::ptrdiff_t>(3 * t);
    EXPECT_NE(std::find(row, row + 3, first[root(static_cast<std::int32_t>(t))]), row + 3)
        << "no fan: triangle " << t;
  }
  // Rows that are not among the Delaunay triangles take the places of those that are not among the result.
  using Row = std::array<std::int32_t, 3>;
  const auto row_of = [](const std::vector<std::int32_t>& rows, std::size_t t) {
    return Row{rows[3 * t], rows[3 * t + 1], rows[3 * t + 2]};
  };
  std::set<Row> rows;
  for (std::size_t t = 0; t < cell.size(); ++t) rows.insert(row_of(triangles, t));
  Row last{-1, -1, -1};
  for (std::size_t t = 0; t < cell.size(); ++t) {
    const Row row = row_of(triangles, t), was = row_of(delaunay.triangles, t);
    if (rows.count(was) != 0) {
      EXPECT_EQ(row, was);
    } else {
      EXPECT_LT(last, row);
      last = row;
    }
  }
}

/// The first segment that crosses an earlier one, and the first of those; {-1, -1} if none cross at a place
/// that is no point.
inline Edge expected_crossing(const std::vector<std::size_t>& offsets,
                              const std::vector<std::vector<Edge>>& edges, Plane& plane) {
  const auto set = [&offsets](const Edge& edge) {
    return std::upper_bound(offsets.begin(), offsets.end(), static_cast<std::size_t>(edge.first));
  };
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (const Edge& p : edges[i]) {
        for (const Edge& q : edges[j]) {
          if (set(p) == set(q) && plane.cross(p.first, p.second, q.first, q.second)) return {j, i};
        }
      }
    }
  }
  return {-1, -1};
}

}  // namespace flaunay::testing
