#include "space/weighted/cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "arithmetic/exact_arithmetic.h"
#include "derived/voronoi/mend.hpp"
#include "derived/voronoi/moments.hpp"
#include "geometry/arguments.hpp"
#include "geometry/for_each.hpp"
#include "geometry/predicates.hpp"
#include "operations/prefetch.h"
#include "predicates/nearness.h"
#include "space/weighted/centre.hpp"

namespace flaunay::weighted {
namespace {

using geometry::Point;
using voronoi::Moments;
using voronoi::moments_of;
using Ids = std::vector<std::int32_t>;

// Visits the neighbours of vertices.
class Stars {
 public:
  Stars(std::size_t n, const Triangulation& mesh) : mesh_(mesh), triangle_at_(n, -1) {
    for (std::size_t c = 0; c < mesh.triangles.size(); ++c) add(mesh.triangles[c], c / 3);
    // In a set without triangles, `hull` has the vertices in their order on a line.
    for (std::size_t k = 0; mesh.triangles.empty() && k < mesh.hull.size(); ++k) add(mesh.hull[k], k);
  }

  /// The vertices, near ones one after the other.
  const Ids& vertices() const { return vertices_; }

  /// A neighbour, and the triangle between it and the next neighbour, counter-clockwise; -1 on the border.
  struct Spoke {
    std::int32_t neighbor, triangle;
  };
  /// The neighbours of a vertex, counter-clockwise.
  void collect(std::int32_t v, std::vector<Spoke>& ring) const {
    ring.clear();
    const std::int32_t first = triangle_at_[static_cast<std::size_t>(v)];
    if (mesh_.triangles.empty()) {
      const auto k = static_cast<std::size_t>(first);
      if (k > 0) ring.push_back({mesh_.hull[k - 1], -1});
      if (k + 1 < mesh_.hull.size()) ring.push_back({mesh_.hull[k + 1], -1});
      return;
    }
    // Counter-clockwise, and on the border from there on clockwise to the other end. The limit is for arrays
    // that are no triangulation's.
    std::int32_t t = first;
    for (std::size_t count = 0; t >= 0 && count < mesh_.triangles.size(); ++count) {
      const int k = corner_of(t, v);
      ring.push_back({corner(t, k + 1), t});
      const std::int32_t next = neighbor(t, k + 1);
      if (next == first) return;
      if (next < 0) ring.push_back({corner(t, k + 2), -1});
      t = next;
    }
    const auto ahead = static_cast<std::ptrdiff_t>(ring.size());
    t = neighbor(first, corner_of(first, v) + 2);
    for (std::size_t count = 0; t >= 0 && count < mesh_.triangles.size(); ++count) {
      const int k = corner_of(t, v);
      ring.push_back({corner(t, k + 1), t});
      t = neighbor(t, k + 2);
    }
    std::reverse(ring.begin() + ahead, ring.end());
    std::rotate(ring.begin(), ring.begin() + ahead, ring.end());
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
  std::int32_t neighbor(std::int32_t t, int k) const {
    return mesh_.neighbors[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(k % 3)];
  }
  int corner_of(std::int32_t t, std::int32_t v) const {
    return corner(t, 0) == v ? 0 : corner(t, 1) == v ? 1 : 2;
  }

  const Triangulation& mesh_;
  Ids triangle_at_, vertices_;
};

// A convex polygon, seen from a cell's point. sides: per side, from a corner to the next one, the object
// beyond it: the place of a neighbour in the ring, or ~k for edge k of the clipping polygon.
struct Polygon {
  std::vector<Point> corners;
  std::vector<int> sides;
};

// Cuts off the part of a polygon right of a line: the places p with constant < 2 d p.
void clip(Polygon& polygon, Point d, double constant, int side, Polygon& spare) {
  const auto inside = [&](Point p) { return constant - 2 * (d.x * p.x + d.y * p.y); };
  const std::size_t size = polygon.corners.size();
  spare.corners.resize(2 * size);
  spare.sides.resize(2 * size);
  std::size_t to = 0;
  const auto add = [&](Point p, int of) {
    spare.corners[to] = p;
    spare.sides[to++] = of;
  };
  Point p = polygon.corners[0];
  double at_p = inside(p);
  for (std::size_t k = 0; k < size; ++k) {
    const Point q = polygon.corners[k + 1 < size ? k + 1 : 0];
    const double at_q = inside(q);
    if (at_p >= 0) add(p, at_p == 0 && at_q < 0 ? side : polygon.sides[k]);
    if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) {
      const double share = at_p / (at_p - at_q);
      add({p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)}, at_p > 0 ? side : polygon.sides[k]);
    }
    p = q;
    at_p = at_q;
  }
  spare.corners.resize(to);
  spare.sides.resize(to);
  std::swap(polygon, spare);
}

// How many triangles ahead their points are fetched.
constexpr std::size_t kTrianglesAhead = 32;

// Where rounded corners are, the same for all cells that have them.
class Places {
 public:
  Places(host::Runtime& runtime, const double* points, const double* weights, const Triangulation& mesh,
         const std::vector<double>& clip)
      : points_(points),
        weights_(weights),
        clip_(clip),
        centres_(mesh.triangles.size() / 3),
        beyond_(centres_.size()) {
    geometry::for_each(runtime, centres_.size(), [&](std::size_t t) {
      for (std::size_t c = 3 * std::min(t + kTrianglesAhead, centres_.size() - 1), k = 0; k < 3; ++k) {
        const auto v = static_cast<std::size_t>(mesh.triangles[c + k]);
        kernel::fetch(&points[2 * v]);
        kernel::fetch(&weights[v]);
      }
      centres_[t] = centre(&mesh.triangles[3 * t]);
      beyond_[t] = find_edge_before(centres_[t]);
    });
  }

  Point centre(std::int32_t triangle) const { return centres_[static_cast<std::size_t>(triangle)]; }
  // An edge of the polygon that a centre lies beyond; -1 for none.
  int edge_before(std::int32_t triangle) const { return beyond_[static_cast<std::size_t>(triangle)]; }
  Point clip_corner(int k) const {
    const std::size_t at = 2 * static_cast<std::size_t>(k) % clip_.size();
    return {clip_[at], clip_[at + 1]};
  }
  // Where the border between the cells of two points crosses an edge of the polygon, or the corner next to
  // that.
  Point crossing(std::int32_t i, std::int32_t j, int edge) const {
    const Point v = clip_corner(edge), w = clip_corner(edge + 1);
    const double at_v = difference(i, j, v), at_w = difference(i, j, w);
    if (at_v == 0 || at_w == 0 || (at_v > 0) == (at_w > 0)) return std::fabs(at_v) <= std::fabs(at_w) ? v : w;
    const double share = std::fabs(at_v) / (std::fabs(at_v) + std::fabs(at_w));
    const auto between = [&](double a, double b) {
      return share < 0.5 ? a + share * (b - a) : b + (1 - share) * (a - b);
    };
    const Point at = {between(v.x, w.x), between(v.y, w.y)};
    return {std::clamp(at.x, std::min(v.x, w.x), std::max(v.x, w.x)),
            std::clamp(at.y, std::min(v.y, w.y), std::max(v.y, w.y))};
  }

 private:
  Point point(std::int32_t i) const {
    return {points_[2 * static_cast<std::size_t>(i)], points_[2 * static_cast<std::size_t>(i) + 1]};
  }
  double weight(std::int32_t i) const { return weights_[static_cast<std::size_t>(i)]; }

  int find_edge_before(Point centre) const {
    for (int k = 0; k < static_cast<int>(clip_.size() / 2); ++k) {
      if (kernel::orient_sign(clip_corner(k), clip_corner(k + 1), centre, ORIENT_BOUND) < 0) return k;
    }
    return -1;
  }

  // The power of a place with respect to i without that to j, exact until it is rounded.
  double difference(std::int32_t i, std::int32_t j, Point at) const {
    using kernel::two_sum;
    const Point a = point(i), b = point(j);
    kernel::expansion sum;
    kernel::nearness_expansion(two_sum(a.x, -b.x), two_sum(a.y, -b.y), two_sum(a.x, -at.x),
                               two_sum(a.y, -at.y), two_sum(b.x, -at.x), two_sum(b.y, -at.y), &sum);
    const kernel::double2 weights = two_sum(weight(j), -weight(i));
    kernel::expansion_add(&sum, weights.y);
    kernel::expansion_add(&sum, weights.x);
    kernel::expansion_compress(&sum);
    return kernel::expansion_value(&sum);
  }

  // As seen from the first corner, whatever the order of the points.
  Point centre(const std::int32_t* corners) const {
    std::array<std::int32_t, 3> of = {corners[0], corners[1], corners[2]};
    while (kernel::comes_before(point(of[1]), point(of[0])) ||
           kernel::comes_before(point(of[2]), point(of[0])))
      std::rotate(of.begin(), of.begin() + 1, of.end());
    return power_centre(point(of[0]), point(of[1]), point(of[2]),
                        {weight(of[0]), weight(of[1]), weight(of[2])});
  }

  const double *points_, *weights_;
  const std::vector<double>& clip_;
  std::vector<Point> centres_;
  std::vector<int> beyond_;
};

// The places of a cell's corners, as x and y.
void append_places(const Places& places, std::int32_t vertex, const std::vector<Stars::Spoke>& ring,
                   std::vector<int>& sides, std::vector<double>& to) {
  const auto add = [&](Point p) { to.insert(to.end(), {p.x, p.y}); };
  const auto spoke = [&](int side) { return ring[static_cast<std::size_t>(side)]; };
  // Rounding may have changed the order of sides that are too short to be seen: those count that go around
  // once.
  const auto least = std::min_element(sides.begin(), sides.end(), [](int a, int b) {
    return static_cast<unsigned>(a) < static_cast<unsigned>(b);
  });
  std::rotate(sides.begin(), least, sides.end());
  int last = -1;
  sides.erase(std::remove_if(sides.begin(), sides.end(),
                             [&](int side) {
                               if (side < 0) return false;
                               const bool is_behind = side < last;
                               last = std::max(last, side);
                               return is_behind;
                             }),
              sides.end());
  int before = sides.back();
  for (const int behind : sides) {
    if (before >= 0 && behind >= 0) {
      // Sides between them may have been too short to be seen.
      for (auto k = static_cast<std::size_t>(before); k != static_cast<std::size_t>(behind);
           k = k + 1 < ring.size() ? k + 1 : 0) {
        const std::int32_t triangle = ring[k].triangle;
        if (triangle < 0) continue;
        if (const int edge = places.edge_before(triangle); edge >= 0) {
          // The borders with two neighbours are so near to each other that they seem to meet inside.
          add(places.crossing(vertex, ring[k].neighbor, edge));
          add(places.crossing(vertex, spoke(static_cast<int>((k + 1) % ring.size())).neighbor, edge));
        } else {
          add(places.centre(triangle));
        }
      }
    } else if (before >= 0) {
      add(places.crossing(vertex, spoke(before).neighbor, ~behind));
    } else if (behind >= 0) {
      add(places.crossing(vertex, spoke(behind).neighbor, ~before));
    } else {
      add(places.clip_corner(~behind));
    }
    before = behind;
  }
}

}  // namespace

Visible visible_points(const double* points, const std::vector<std::size_t>& offsets,
                       const Triangulation& mesh) {
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
      visible.numbers.push_back(static_cast<std::int32_t>(i));
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

ClippedVoronoi make_cells(call::Implementation& self, const call::CellInput& input) {
  const Triangulation& mesh = input.mesh;
  const std::size_t n = input.points.count;
  const double *const points = input.points.wide, *const weights = input.space.weights;
  const std::vector<double>& corners = input.polygon.corners;
  call::check_with_hidden(points, {0, n}, mesh);
  check_array(weights, n, "weights");
  host::Runtime& runtime = self.native().runtime;
  const Stars stars(n, mesh);
  const Places places(runtime, points, weights, mesh, corners);
  const Ids& vertices = stars.vertices();
  ClippedVoronoi cells;
  cells.areas.resize(n);
  cells.centroids.assign(2 * n, NAN);
  voronoi::Cells rounded{std::vector<std::int32_t>(n + 1, 0), {}};
  std::vector<std::vector<double>> corners_of_runs(geometry::runs_of(vertices.size()));
  geometry::for_each_run(&runtime, vertices.size(), [&](std::size_t r, std::size_t begin, std::size_t end) {
    Polygon polygon, spare;
    std::vector<Stars::Spoke> ring;
    for (std::size_t v = begin; v < end; ++v) {
      const auto i = static_cast<std::size_t>(vertices[v]);
      const Point p = {points[2 * i], points[2 * i + 1]};
      // Relative to the point, so that cells far away from the origin have as many digits.
      polygon.corners.clear();
      polygon.sides.clear();
      for (std::size_t k = 0; k < corners.size(); k += 2) {
        polygon.corners.push_back({corners[k] - p.x, corners[k + 1] - p.y});
        polygon.sides.push_back(~static_cast<int>(k / 2));
      }
      stars.collect(vertices[v], ring);
      for (const Stars::Spoke& spoke : ring) {
        kernel::fetch(&points[2 * static_cast<std::size_t>(spoke.neighbor)]);
        kernel::fetch(&weights[spoke.neighbor]);
      }
      for (std::size_t k = 0; k < ring.size() && !polygon.sides.empty(); ++k) {
        const auto j = static_cast<std::size_t>(ring[k].neighbor);
        const Point d = {points[2 * j] - p.x, points[2 * j + 1] - p.y};
        clip(polygon, d, d.x * d.x + d.y * d.y - (weights[j] - weights[i]), static_cast<int>(k), spare);
      }
      const Moments moments = moments_of(polygon.corners);
      if (moments.area == 0) continue;
      cells.areas[i] = moments.area;
      cells.centroids[2 * i] = p.x + moments.centroid.x;
      cells.centroids[2 * i + 1] = p.y + moments.centroid.y;
      const std::size_t size = corners_of_runs[r].size();
      append_places(places, vertices[v], ring, polygon.sides, corners_of_runs[r]);
      rounded.offsets[i + 1] = static_cast<std::int32_t>((corners_of_runs[r].size() - size) / 2);
    }
  });
  std::partial_sum(rounded.offsets.begin(), rounded.offsets.end(), rounded.offsets.begin());
  rounded.vertices.resize(2 * static_cast<std::size_t>(rounded.offsets.back()));
  geometry::for_each_run(&runtime, vertices.size(), [&](std::size_t r, std::size_t begin, std::size_t end) {
    auto from = corners_of_runs[r].cbegin();
    for (std::size_t v = begin; v < end; ++v) {
      const auto i = static_cast<std::size_t>(vertices[v]);
      const std::ptrdiff_t first = 2 * rounded.offsets[i], count = 2 * rounded.offsets[i + 1] - first;
      std::copy_n(from, count, rounded.vertices.begin() + first);
      from += count;
    }
  });
  voronoi::mend(runtime, {0, n}, points, corners, voronoi::kNoPeriod, rounded);
  cells.offsets = std::move(rounded.offsets);
  cells.vertices = std::move(rounded.vertices);
  return cells;
}

}  // namespace flaunay::weighted
