#include "tests/constrained/check.hpp"

#include <gtest/gtest.h>

#include <array>
#include <numeric>

#include "tests/support/reference.hpp"

namespace flaunay::testing {
namespace {

template <typename Value>
std::vector<Value> sorted(std::vector<Value> values) {
  std::sort(values.begin(), values.end());
  return values;
}
template <typename Value>
std::vector<Value> distinct(std::vector<Value> values) {
  values = sorted(std::move(values));
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// Edges across from corners without a neighbour.
std::vector<Edge> border_of(const Triangulation& mesh) {
  std::vector<Edge> edges;
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::size_t t = c - c % 3;
    if (mesh.neighbors[c] < 0)
      edges.emplace_back(mesh.triangles[t + (c + 1) % 3], mesh.triangles[t + (c + 2) % 3]);
  }
  return distinct(edges);
}

using Row = std::array<std::int32_t, 3>;
Row row_of(const Triangulation& mesh, std::size_t t) {
  return {mesh.triangles[3 * t], mesh.triangles[3 * t + 1], mesh.triangles[3 * t + 2]};
}

}  // namespace

std::vector<std::vector<Edge>> expected_edges(const Coordinates& points,
                                              const std::vector<std::size_t>& offsets,
                                              const Triangulation& delaunay, const Segments& segments) {
  Plane plane(points);
  const auto before = [&plane](std::int32_t u, std::int32_t v) { return plane.before(u, v); };
  // The points of each set in lexicographic order.
  std::vector<std::int32_t> order(points.size() / 2);
  std::iota(order.begin(), order.end(), 0);
  const auto at = [&order](std::size_t i) { return order.begin() + static_cast<std::ptrdiff_t>(i); };
  for (std::size_t s = 1; s < offsets.size(); ++s) std::sort(at(offsets[s - 1]), at(offsets[s]), before);
  std::vector<std::vector<Edge>> all;
  for (std::size_t s = 0; s < segments.size(); s += 2) {
    const auto [a, b] = std::minmax(segments[s], segments[s + 1], before);
    const auto end = std::upper_bound(offsets.begin(), offsets.end(), static_cast<std::size_t>(a));
    const auto first = std::lower_bound(at(*(end - 1)), at(*end), a, before);
    const auto last = std::upper_bound(first, at(*end), b, before);
    std::vector<Edge> edges;
    std::int32_t previous = -1;
    for (auto v = first; v != last && plane.before(a, b); ++v) {
      if (delaunay.representatives[*v] != *v || plane.orient(a, b, *v) != 0) continue;
      if (previous >= 0) edges.emplace_back(previous, *v);
      previous = *v;
    }
    all.push_back(edges);
  }
  return all;
}

std::int32_t find_no_fan(const Coordinates& points, const Triangulation& mesh,
                         const std::vector<std::uint8_t>& constrained) {
  Plane plane(points);
  const std::vector<std::int32_t>& triangles = mesh.triangles;
  // Triangles of one cell, by union and find.
  std::vector<std::int32_t> cell(triangles.size() / 3), first(cell.size(), -1);
  std::iota(cell.begin(), cell.end(), 0);
  const auto root = [&cell](std::int32_t t) {
    while (cell[t] != t) t = cell[t] = cell[cell[t]];
    return t;
  };
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const auto t = static_cast<std::int32_t>(c / 3);
    const std::int32_t beyond = mesh.neighbors[c];
    if (beyond < t || (!constrained.empty() && constrained[c] != 0)) continue;
    std::int32_t opposite = 3 * beyond;
    while (mesh.neighbors[opposite] != t) ++opposite;
    if (plane.circle(triangles[3 * t], triangles[3 * t + 1], triangles[3 * t + 2], triangles[opposite]) == 0)
      cell[root(t)] = root(beyond);
  }
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    std::int32_t& v = first[root(static_cast<std::int32_t>(c / 3))];
    if (v < 0 || plane.before(triangles[c], v)) v = triangles[c];
  }
  for (std::size_t t = 0; t < cell.size(); ++t) {
    const Row row = row_of(mesh, t);
    if (std::find(row.begin(), row.end(), first[root(static_cast<std::int32_t>(t))]) == row.end())
      return static_cast<std::int32_t>(t);
  }
  return -1;
}

void expect_edges(const std::vector<std::vector<Edge>>& expected, const ConstrainedTriangulation& result) {
  ASSERT_EQ(result.piece_edges.size(), 2 * expected.size());
  std::vector<Edge> all, listed;
  for (std::size_t e = 0; e < result.constraint_edges.size(); e += 2)
    listed.emplace_back(result.constraint_edges[e], result.constraint_edges[e + 1]);
  // Chains of edges that follow each other on segments, in the order of their first edges.
  std::vector<bool> follows(listed.size(), false);
  for (std::size_t s = 0; s < expected.size(); ++s) {
    std::vector<Edge> edges;
    for (std::int32_t e = result.piece_edges[2 * s]; e < result.piece_edges[2 * s + 1]; ++e) {
      edges.push_back(listed.at(static_cast<std::size_t>(e)));
      if (e > result.piece_edges[2 * s]) follows[static_cast<std::size_t>(e)] = true;
    }
    EXPECT_EQ(edges, expected[s]) << "of segment " << s;
    all.insert(all.end(), edges.begin(), edges.end());
  }
  EXPECT_EQ(distinct(all), sorted(listed)) << "each once";
  Edge last{-1, -1};
  for (std::size_t e = 0; e < follows.size(); ++e) {
    if (follows[e]) continue;
    EXPECT_LT(last, listed[e]);
    last = listed[e];
  }
}

void expect_canonical(const Coordinates& points, const Triangulation& delaunay,
                      const ConstrainedTriangulation& result) {
  Plane plane(points);
  const std::vector<std::int32_t>& triangles = result.triangles;
  ASSERT_EQ(triangles.size(), delaunay.triangles.size());
  ASSERT_EQ(result.neighbors, reference_neighbors(triangles));
  ASSERT_EQ(border_of(result), border_of(delaunay));
  const std::vector<std::int32_t> vertices = distinct(triangles);
  EXPECT_EQ(vertices, distinct(delaunay.triangles));

  std::vector<Edge> constraints;
  for (std::size_t e = 0; e < result.constraint_edges.size(); e += 2)
    constraints.push_back(unordered(result.constraint_edges[e], result.constraint_edges[e + 1]));
  constraints = distinct(constraints);
  std::vector<bool> is_missing;
  // A set without triangles has no other edges to be among.
  for (const Edge& edge : constraints)
    is_missing.push_back(std::binary_search(vertices.begin(), vertices.end(), edge.first));
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const std::size_t t = c - c % 3;
    const std::int32_t a = triangles[t], b = triangles[t + 1], d = triangles[t + 2];
    if (c == t) {
      ASSERT_GT(plane.orient(a, b, d), 0) << "triangle " << c / 3;
      ASSERT_TRUE(a < b && a < d) << "triangle " << c / 3;
    }
    const Edge edge = unordered(triangles[t + (c + 1) % 3], triangles[t + (c + 2) % 3]);
    const auto at = std::lower_bound(constraints.begin(), constraints.end(), edge);
    const bool is_constraint = at != constraints.end() && *at == edge;
    ASSERT_EQ(result.constrained[c] != 0, is_constraint) << edge.first << "-" << edge.second;
    if (is_constraint) is_missing[static_cast<std::size_t>(at - constraints.begin())] = false;
    const std::int32_t beyond = result.neighbors[c];
    if (beyond < 0 || is_constraint) continue;
    std::int32_t opposite = 3 * beyond;
    while (triangles[opposite] == edge.first || triangles[opposite] == edge.second) ++opposite;
    ASSERT_LE(plane.circle(a, b, d, triangles[opposite]), 0) << "edge " << edge.first << "-" << edge.second;
  }
  EXPECT_EQ(std::count(is_missing.begin(), is_missing.end(), true), 0) << "constraints are no edges";
  EXPECT_EQ(find_no_fan(points, result, result.constrained), -1);
  // Each row has the triangle above or below the middle vertex, along x, of the Delaunay triangle there.
  const auto at = [&](std::int32_t v) { return std::pair(points[2 * v], points[2 * v + 1]); };
  const auto precedes = [&](std::int32_t v, std::int32_t w) { return at(v) < at(w); };
  const auto place = [&](Row row) {
    while (precedes(row[0], row[1]) != precedes(row[1], row[2])) std::rotate(&row[0], &row[1], row.end());
    return std::pair(row[1], precedes(row[1], row[2]));
  };
  for (std::size_t t = 0; t < triangles.size() / 3; ++t) {
    EXPECT_EQ(place(row_of(result, t)), place(row_of(delaunay, t))) << "row " << t;
  }
}

Edge expected_crossing(const std::vector<std::size_t>& offsets, const std::vector<std::vector<Edge>>& edges,
                       Plane& plane) {
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
