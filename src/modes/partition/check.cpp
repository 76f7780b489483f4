// Why the checks are complete: All triangles are counter-clockwise, and no two are on the same side of an
// edge. The edges with one triangle only form a convex polygon, which is passed once. The number of triangles
// that cover a place changes only across such edges, so it is 1 inside of the polygon and 0 outside. Every
// point is a vertex, so the polygon is the hull, and no point lies inside a triangle or an edge. If all edges
// are locally Delaunay, the triangulation is Delaunay (Delaunay 1934).
#include "modes/partition/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "flaunay/flaunay.hpp"
#include "geometry/halfedges.hpp"

namespace flaunay::partition {
using namespace geometry;

namespace {

using Ids = std::vector<std::int32_t>;

class Checker {
 public:
  Checker(const Predicates& predicates, const Point* points, std::size_t n, const std::int32_t* names)
      : predicates_(predicates), points_(points), n_(static_cast<std::int32_t>(n)), names_(names) {}

  Mesh run(Ids triangles) {
    mesh_.triangles = std::move(triangles);
    if (mesh_.triangles.size() % 3 != 0) fail("the number of indices is not a multiple of 3");
    if (mesh_.triangles.size() / 6 >= static_cast<std::size_t>(n_) && n_ > 0) fail("too many triangles");
    if (mesh_.triangles.empty() && collinear()) return std::move(mesh_);
    check_rows();
    check_points();
    if (!find_twins(mesh_.triangles, mesh_.twins)) fail("two triangles are on one side of an edge");
    check_hull();
    check_circles();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] static void fail(const std::string& reason) { throw Error(ErrorKind::input, reason); }

  Point point(std::int32_t h) const { return points_[mesh_.triangles[h]]; }

  bool collinear() const {
    for (std::int32_t i = 2; i < n_; ++i) {
      if (predicates_.orient(points_[0], points_[1], points_[i]) != 0) return false;
    }
    return true;
  }

  // Checks indices and areas, and makes all triangles counter-clockwise.
  void check_rows() {
    const auto halfedges = static_cast<std::int32_t>(mesh_.triangles.size());
    for (std::int32_t h = 0; h < halfedges; h += 3) {
      for (std::int32_t k = h; k < h + 3; ++k) {
        const std::int32_t position = mesh_.triangles[k];
        if (position >= 0 && position < n_) continue;
        fail(fmt::format("triangle {} has position {} of {} points", h / 3, position, n_));
      }
      const int side = predicates_.orient(point(h), point(h + 1), point(h + 2));
      if (side == 0) fail(fmt::format("triangle {} has no area", h / 3));
      if (side < 0) std::swap(mesh_.triangles[h + 1], mesh_.triangles[h + 2]);
    }
  }

  void check_points() const {
    std::vector<char> used(n_, 0);
    for (const std::int32_t position : mesh_.triangles) used[position] = 1;
    const auto unused = std::find(used.begin(), used.end(), 0);
    if (unused != used.end()) {
      fail(fmt::format("point {} is in no triangle", names_[unused - used.begin()]));
    }
  }

  // A polygon is convex and passed once if it nowhere turns right, turns left at its first and last point,
  // and ascends from the first to the last and descends back.
  void check_hull() const {
    Ids next(n_, -1);
    std::int32_t sides = 0;
    const auto halfedges = static_cast<std::int32_t>(mesh_.triangles.size());
    for (std::int32_t h = 0; h < halfedges; ++h) {
      if (mesh_.twins[h] >= 0) continue;
      if (next[mesh_.triangles[h]] >= 0) fail_hull(mesh_.triangles[h]);
      next[mesh_.triangles[h]] = mesh_.triangles[next_halfedge(h)];
      ++sides;
    }
    const std::int32_t last = n_ - 1;
    std::int32_t at = 0;
    bool rising = true;
    do {
      const std::int32_t then = next[at];
      if (then < 0 || next[then] < 0) fail_hull(at);
      if (rising != (then > at)) fail_hull(at);
      const int turn = predicates_.orient(points_[at], points_[then], points_[next[then]]);
      if (turn < 0 || (turn == 0 && (then == 0 || then == last))) fail_hull(then);
      if (then == last) rising = false;
      at = then;
      --sides;
    } while (at != 0);
    if (sides != 0) fail("its edges on one triangle alone are not one polygon");
  }

  [[noreturn]] void fail_hull(std::int32_t position) const {
    fail(fmt::format("its edges on one triangle alone are not a convex polygon at point {}",
                     names_[position]));
  }

  void check_circles() const {
    const auto halfedges = static_cast<std::int32_t>(mesh_.triangles.size());
    for (std::int32_t h = 0; h < halfedges; ++h) {
      const std::int32_t twin = mesh_.twins[h];
      if (twin < h) continue;
      const std::int32_t beyond = previous_halfedge(twin);
      const std::int32_t t = h - h % 3;
      if (predicates_.circle(point(t), point(t + 1), point(t + 2), point(beyond)) <= 0) continue;
      fail(fmt::format("point {} is in the circle of triangle {}", names_[mesh_.triangles[beyond]], t / 3));
    }
  }

  const Predicates& predicates_;
  const Point* const points_;
  const std::int32_t n_;
  const std::int32_t* const names_;
  Mesh mesh_;
};

}  // namespace

Mesh checked_mesh(const Predicates& predicates, const Point* points, std::size_t n, const std::int32_t* names,
                  Ids triangles) {
  return Checker(predicates, points, n, names).run(std::move(triangles));
}

}  // namespace flaunay::partition
