#include "derived/weighted/cells.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "derived/voronoi/moments.hpp"
#include "geometry/for_each.hpp"
#include "geometry/predicates.hpp"

namespace flaunay::weighted {
namespace {

using geometry::Point;
using voronoi::Moments;
using voronoi::moments_of;
using Ids = std::vector<std::int32_t>;

// Visits the neighbours of vertices.
class Stars {
 public:
  Stars(std::size_t n, const WeightedTriangulation& mesh) : mesh_(mesh), triangle_at_(n, -1) {
    for (std::size_t c = 0; c < mesh.triangles.size(); ++c) add(mesh.triangles[c], c / 3);
    // Of a set without triangles, vertices are on a line in this order.
    for (std::size_t k = 0; mesh.triangles.empty() && k < mesh.hull.size(); ++k) add(mesh.hull[k], k);
  }

  /// The vertices, near ones one after the other.
  const Ids& vertices() const { return vertices_; }

  template <typename Visit>
  void for_each_neighbor(std::int32_t v, const Visit& visit) const {
    const std::int32_t first = triangle_at_[static_cast<std::size_t>(v)];
    if (mesh_.triangles.empty()) {
      const auto k = static_cast<std::size_t>(first);
      if (k > 0) visit(mesh_.hull[k - 1]);
      if (k + 1 < mesh_.hull.size()) visit(mesh_.hull[k + 1]);
      return;
    }
    // Counter-clockwise, and on the border from there on clockwise to the other end. The limit is for arrays
    // that are no triangulation's.
    for (const int step : {1, 2}) {
      std::int32_t t = first;
      for (std::size_t count = 0; t >= 0 && count < mesh_.triangles.size(); ++count) {
        const int k = corner_of(t, v);
        visit(corner(t, k + 3 - step));
        t = mesh_.neighbors[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>((k + step) % 3)];
        if (t == first) return;
      }
    }
  }

 private:
  void add(std::int32_t v, std::size_t at) {
    std::int32_t& first = triangle_at_[static_cast<std::size_t>(v)];
    if (first >= 0) return;
    first = static_cast<std::int32_t>(at);
    vertices_.push_back(v);
  }
  std::int32_t corner(std::int32_t t, int k) const {
    return mesh_.triangles[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(k % 3)];
  }
  int corner_of(std::int32_t t, std::int32_t v) const {
    return corner(t, 0) == v ? 0 : corner(t, 1) == v ? 1 : 2;
  }

  const WeightedTriangulation& mesh_;
  Ids triangle_at_, vertices_;
};

// Cuts from a convex polygon what is right of a line: the places p at which constant < 2 d p.
void clip(std::vector<Point>& polygon, Point d, double constant, std::vector<Point>& spare) {
  const auto inside = [&](Point p) { return constant - 2 * (d.x * p.x + d.y * p.y); };
  spare.clear();
  Point p = polygon.back();
  double at_p = inside(p);
  for (const Point q : polygon) {
    const double at_q = inside(q);
    if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) {
      const double share = at_p / (at_p - at_q);
      spare.push_back({p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)});
    }
    if (at_q >= 0) spare.push_back(q);
    p = q;
    at_p = at_q;
  }
  polygon.swap(spare);
}

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
  const Stars stars(n, mesh);
  const Ids& vertices = stars.vertices();
  ClippedVoronoi cells;
  cells.areas.resize(n);
  cells.centroids.assign(2 * n, NAN);
  cells.offsets.assign(n + 1, 0);
  std::vector<std::vector<double>> corners_of_runs(geometry::runs_of(vertices.size()));
  geometry::for_each_run(&runtime, vertices.size(), [&](std::size_t r, std::size_t begin, std::size_t end) {
    std::vector<Point> polygon, spare;
    for (std::size_t v = begin; v < end; ++v) {
      const auto i = static_cast<std::size_t>(vertices[v]);
      const Point p = {points[2 * i], points[2 * i + 1]};
      // As seen from the point, so that what is far away from the origin has as many digits.
      polygon.clear();
      for (std::size_t k = 0; k < corners.size(); k += 2)
        polygon.push_back({corners[k] - p.x, corners[k + 1] - p.y});
      stars.for_each_neighbor(vertices[v], [&](std::int32_t neighbor) {
        const auto j = static_cast<std::size_t>(neighbor);
        const Point d = {points[2 * j] - p.x, points[2 * j + 1] - p.y};
        if (!polygon.empty()) clip(polygon, d, d.x * d.x + d.y * d.y - (weights[j] - weights[i]), spare);
      });
      const Moments moments = moments_of(polygon);
      if (moments.area == 0) continue;
      cells.areas[i] = moments.area;
      cells.centroids[2 * i] = p.x + moments.centroid.x;
      cells.centroids[2 * i + 1] = p.y + moments.centroid.y;
      cells.offsets[i + 1] = static_cast<std::int32_t>(polygon.size());
      for (const Point& q : polygon)
        corners_of_runs[r].insert(corners_of_runs[r].end(), {p.x + q.x, p.y + q.y});
    }
  });
  std::partial_sum(cells.offsets.begin(), cells.offsets.end(), cells.offsets.begin());
  cells.vertices.resize(2 * static_cast<std::size_t>(cells.offsets.back()));
  geometry::for_each_run(&runtime, vertices.size(), [&](std::size_t r, std::size_t begin, std::size_t end) {
    auto from = corners_of_runs[r].cbegin();
    for (std::size_t v = begin; v < end; ++v) {
      const auto i = static_cast<std::size_t>(vertices[v]);
      const std::ptrdiff_t first = 2 * cells.offsets[i], count = 2 * cells.offsets[i + 1] - first;
      std::copy_n(from, count, cells.vertices.begin() + first);
      from += count;
    }
  });
  return cells;
}

}  // namespace flaunay::weighted
