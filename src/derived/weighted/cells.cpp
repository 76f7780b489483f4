#include "derived/weighted/cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "geometry/for_each.hpp"
#include "geometry/predicates.hpp"

namespace flaunay::weighted {
namespace {

using geometry::Point;
using Ids = std::vector<std::int32_t>;

// The neighbours of each point: those of point i are [offsets[i], offsets[i + 1]).
struct Adjacency {
  std::vector<std::size_t> offsets;
  Ids points;
};

// Calls visit(a, b) for each pair of points that an edge joins, in both orders.
template <typename Visit>
void for_each_edge(const WeightedTriangulation& mesh, const Visit& visit) {
  for (std::size_t c = 0; c < mesh.triangles.size(); ++c) {
    const std::size_t t = c - c % 3;
    const std::int32_t v = mesh.triangles[c], next = mesh.triangles[t + (c + 1) % 3];
    visit(v, next);
    // Elsewhere the other triangle has the edge in this order.
    if (mesh.neighbors[t + (c + 2) % 3] < 0) visit(next, v);
  }
  for (std::size_t k = 1; mesh.triangles.empty() && k < mesh.hull.size(); ++k) {
    visit(mesh.hull[k - 1], mesh.hull[k]);
    visit(mesh.hull[k], mesh.hull[k - 1]);
  }
}

Adjacency adjacency_of(std::size_t n, const WeightedTriangulation& mesh) {
  Adjacency found;
  found.offsets.assign(n + 2, 0);
  for_each_edge(mesh,
                [&](std::int32_t v, std::int32_t) { ++found.offsets[static_cast<std::size_t>(v) + 2]; });
  std::partial_sum(found.offsets.begin(), found.offsets.end(), found.offsets.begin());
  found.points.resize(found.offsets.back());
  for_each_edge(mesh, [&](std::int32_t v, std::int32_t to) {
    found.points[found.offsets[static_cast<std::size_t>(v) + 1]++] = to;
  });
  return found;
}

// Cuts from a convex polygon what is right of a line: the places p at which constant < 2 d p.
void clip(std::vector<Point>& polygon, Point d, double constant, std::vector<Point>& spare) {
  const auto inside = [&](Point p) { return constant - 2 * (d.x * p.x + d.y * p.y); };
  spare.clear();
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point p = polygon[k], q = polygon[k + 1 < polygon.size() ? k + 1 : 0];
    const double at_p = inside(p), at_q = inside(q);
    if (at_p >= 0) spare.push_back(p);
    if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) {
      const double share = at_p / (at_p - at_q);
      spare.push_back({p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)});
    }
  }
  polygon.swap(spare);
}

struct Moments {
  double area = 0;
  Point centroid{NAN, NAN};
};

// Of a convex polygon, by triangles from its first corner.
Moments moments_of(const std::vector<Point>& polygon) {
  double twice = 0, x = 0, y = 0;
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Point o = polygon[0], p = polygon[k - 1], q = polygon[k];
    const double part = (p.x - o.x) * (q.y - o.y) - (p.y - o.y) * (q.x - o.x);
    twice += part;
    x += part * ((p.x - o.x) + (q.x - o.x));
    y += part * ((p.y - o.y) + (q.y - o.y));
  }
  if (!(twice > 0)) return {};
  return {twice / 2, {polygon[0].x + x / (3 * twice), polygon[0].y + y / (3 * twice)}};
}

// The cells of a run of points.
struct Run {
  std::vector<double> vertices;
  Ids sizes;
};

}  // namespace

Visible visible_points(const double* points, const std::vector<std::size_t>& offsets,
                       const WeightedTriangulation& mesh) {
  const std::size_t n = offsets.back();
  std::vector<std::uint8_t> is_hidden(n, 0);
  for (const std::int32_t i : mesh.hidden) is_hidden[static_cast<std::size_t>(i)] = 1;
  Visible visible;
  Ids numbers(n, -1);
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    visible.offsets.push_back(visible.coordinates.size() / 2);
    for (std::size_t i = offsets[s]; i < offsets[s + 1]; ++i) {
      if (is_hidden[i] != 0 || mesh.representatives[i] != static_cast<std::int32_t>(i)) continue;
      numbers[i] = static_cast<std::int32_t>(visible.coordinates.size() / 2);
      visible.coordinates.insert(visible.coordinates.end(), {points[2 * i], points[2 * i + 1]});
    }
  }
  visible.offsets.push_back(visible.coordinates.size() / 2);
  visible.mesh = mesh;
  for (Ids* ids : {&visible.mesh.triangles, &visible.mesh.hull}) {
    for (std::int32_t& i : *ids) i = numbers[static_cast<std::size_t>(i)];
  }
  visible.mesh.representatives.resize(visible.offsets.back());
  std::iota(visible.mesh.representatives.begin(), visible.mesh.representatives.end(), 0);
  return visible;
}

ClippedVoronoi make_cells(host::Runtime& runtime, const double* points, const double* weights, std::size_t n,
                          const WeightedTriangulation& mesh, const std::vector<double>& corners) {
  const Adjacency adjacent = adjacency_of(n, mesh);
  std::vector<std::uint8_t> is_vertex(n, 0);
  for (const Ids* ids : {&mesh.triangles, &mesh.hull}) {
    for (const std::int32_t i : *ids) is_vertex[static_cast<std::size_t>(i)] = 1;
  }
  ClippedVoronoi cells;
  cells.areas.resize(n);
  cells.centroids.resize(2 * n);
  std::vector<Run> runs(geometry::runs_of(n));
  geometry::for_each_run(&runtime, n, [&](std::size_t r, std::size_t begin, std::size_t end) {
    std::vector<Point> polygon, spare;
    for (std::size_t i = begin; i < end; ++i) {
      const Point p = {points[2 * i], points[2 * i + 1]};
      // As seen from the point, so that what is far away from the origin has as many digits.
      polygon.clear();
      for (std::size_t k = 0; is_vertex[i] != 0 && k < corners.size(); k += 2) {
        polygon.push_back({corners[k] - p.x, corners[k + 1] - p.y});
      }
      for (std::size_t k = adjacent.offsets[i]; k < adjacent.offsets[i + 1] && !polygon.empty(); ++k) {
        const auto j = static_cast<std::size_t>(adjacent.points[k]);
        const Point d = {points[2 * j] - p.x, points[2 * j + 1] - p.y};
        clip(polygon, d, d.x * d.x + d.y * d.y - (weights[j] - weights[i]), spare);
      }
      const Moments moments = moments_of(polygon);
      cells.areas[i] = moments.area;
      cells.centroids[2 * i] = p.x + moments.centroid.x;
      cells.centroids[2 * i + 1] = p.y + moments.centroid.y;
      if (moments.area == 0) polygon.clear();
      for (const Point& q : polygon) runs[r].vertices.insert(runs[r].vertices.end(), {p.x + q.x, p.y + q.y});
      runs[r].sizes.push_back(static_cast<std::int32_t>(polygon.size()));
    }
  });
  cells.offsets = {0};
  cells.offsets.reserve(n + 1);
  for (const Run& run : runs) {
    cells.vertices.insert(cells.vertices.end(), run.vertices.begin(), run.vertices.end());
    for (const std::int32_t size : run.sizes) cells.offsets.push_back(cells.offsets.back() + size);
  }
  return cells;
}

}  // namespace flaunay::weighted
