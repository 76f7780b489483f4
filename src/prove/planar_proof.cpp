// Why the checks together are complete: triangles are counter-clockwise and joined at all edges except the
// edges of a convex polygon, so they cover it once. By the power test, which has no ties, all edges are
// convex when they are lifted; so the triangles are the lower hull of their corners, and no corner is hidden.
// All other points are within triangles, and above them. Without weights, that is the canonical Delaunay
// triangulation: the lower hull of points that all are on the paraboloid.
#include "prove/planar_proof.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesh/corners.hpp"
#include "prove/exact.hpp"
#include "prove/half_edges.hpp"
#include "prove/rows.hpp"

namespace flaunay::prove {
namespace {

using Ids = std::vector<std::int32_t>;

class PlanarProof : RowsProof {
 public:
  explicit PlanarProof(const PlanarClaim& claim)
      : RowsProof({claim.mesh.triangles, claim.neighbors, claim.mesh.representatives, claim.offsets,
                   claim.mesh.triangle_offsets}),
        claim_(claim),
        mesh_(claim.mesh),
        next_(claim.offsets.back(), -1) {}

  void run() {
    for (std::size_t s = 0; s < sets(); ++s) check_set(s);
    check_halfedges_and_areas(claim_.points, mesh_, claim_.neighbors);
  }

 private:
  const double* place(std::int32_t i) const { return claim_.points + 2 * index(i); }
  double weight(std::int32_t i) const { return claim_.weights == nullptr ? 0 : claim_.weights[i]; }
  bool is_hidden(std::int32_t i) const {
    return std::binary_search(claim_.hidden.begin(), claim_.hidden.end(), i);
  }
  bool is_before(std::int32_t a, std::int32_t b) const { return comes_before(place(a), place(b)); }
  bool is_same_place(std::int32_t a, std::int32_t b) const { return !is_before(a, b) && !is_before(b, a); }
  int turn(std::int32_t a, std::int32_t b, std::int32_t c) {
    return predicates_.orient2d(place(a), place(b), place(c));
  }

  void check_set(std::size_t s) {
    enter(s);
    check_representatives([&](std::size_t i) {
      const auto own = static_cast<std::int32_t>(i);
      return std::array<double, 3>{place(own)[0], place(own)[1], weight(own)};
    });
    const Ids hull(mesh_.hull.begin() + static_cast<std::ptrdiff_t>(mesh_.hull_offsets[s]),
                   mesh_.hull.begin() + static_cast<std::ptrdiff_t>(mesh_.hull_offsets[s + 1]));
    check_use(hull);
    if (begin_ == end_) {
      check_line(hull);
      return;
    }
    check_hull(hull);
    for (std::size_t t = begin_; t < end_; ++t) check_triangle(t);
    check_hidden();
  }

  void check_corner(std::int32_t v, const char* where) const {
    require(index(v) >= first_ && index(v) < last_ && represents_itself(index(v)) && !is_hidden(v),
            "{} has point {}, which is of another set, hidden, or represented by another", where, v);
  }

  /// Each point is a vertex, hidden, or represented by another.
  void check_use(const Ids& hull) const {
    std::vector<std::uint8_t> is_used(last_ - first_, 0);
    for (std::size_t c = 3 * begin_; c < 3 * end_; ++c) {
      check_corner(mesh_.triangles[c], "a triangle");
      is_used[index(mesh_.triangles[c]) - first_] = 1;
    }
    for (const std::int32_t v : hull) {
      check_corner(v, "the hull");
      is_used[index(v) - first_] = 1;
    }
    for (std::size_t i = first_; i < last_; ++i) {
      require(is_used[i - first_] != 0 || !represents_itself(i) || is_hidden(static_cast<std::int32_t>(i)),
              "point {} is in no triangle", i);
    }
  }

  /// That the hull is a convex polygon that goes around once, and that triangles end there and nowhere else.
  void check_hull(const Ids& hull) {
    std::size_t turns = 0, open = 0;
    for (std::size_t k = 0; k < hull.size(); ++k) {
      const std::int32_t a = hull[k], b = hull[(k + 1) % hull.size()], c = hull[(k + 2) % hull.size()];
      require(turn(a, b, c) >= 0, "the hull is not convex at point {}", b);
      turns += is_before(a, b) != is_before(b, c);
      require(k == 0 || is_before(hull[0], a), "the hull does not begin with its smallest point, {}", a);
      next_[index(a)] = b;
    }
    require(turns == 2, "the hull of the set from point {} on goes around more than once", first_);
    for (std::size_t c = 3 * begin_; c < 3 * end_; ++c) {
      if (claim_.neighbors[c] >= 0) continue;
      require(next_[index(from(c))] == to(c), "triangle {} has no neighbor at an edge inside", c / 3);
      ++open;
    }
    require(open == hull.size(),
            "the set from point {} on has {} edges without a neighbor, but {} hull vertices", first_, open,
            hull.size());
  }

  void check_triangle(std::size_t t) {
    const std::int32_t* const v = corners(t);
    require(v[0] < v[1] && v[0] < v[2], "triangle {} does not begin with its smallest index", t);
    require(turn(v[0], v[1], v[2]) > 0, "triangle {} is not counter-clockwise", t);
    for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
      if (claim_.neighbors[c] < 0) continue;
      const std::size_t d = across(c);
      require(!is_below(v, mesh_.triangles[d]), "the edge between triangles {} and {} is not {}", t, d / 3,
              claim_.weights == nullptr ? "Delaunay, or not canonical" : "regular");
    }
  }

  bool is_below(const std::int32_t* t, std::int32_t p) {
    return prove::is_below(predicates_, {place(t[0]), place(t[1]), place(t[2]), place(p)},
                           {weight(t[0]), weight(t[1]), weight(t[2]), weight(p)});
  }

  /// Hidden points lie in a triangle or on its border, and not below it.
  void check_hidden() {
    const auto begin =
        std::lower_bound(claim_.hidden.begin(), claim_.hidden.end(), static_cast<std::int64_t>(first_));
    const auto end = std::lower_bound(begin, claim_.hidden.end(), static_cast<std::int64_t>(last_));
    Ids hidden(begin, end);
    sort_along_strips(claim_.points, hidden);
    std::size_t t = begin_;
    for (const std::int32_t p : hidden) {
      t = walk(t, p);
      const std::int32_t* const v = corners(t);
      const std::int32_t* const same =
          std::find_if(v, v + 3, [&](std::int32_t corner) { return is_same_place(corner, p); });
      require(same != v + 3 ? weight(*same) > weight(p) : !is_below(v, p),
              "point {} is listed as hidden, but lies below triangle {}", p, t);
    }
  }

  /// The triangle that has a point inside or on its border. Walks over edges that it lies beyond, which comes
  /// to an end in regular triangulations (Edelsbrunner, "An acyclicity theorem for cell complexes in d
  /// dimensions", 1990).
  std::size_t walk(std::size_t t, std::int32_t p) {
    for (std::size_t c = 3 * t; c < 3 * t + 3;) {
      if (turn(from(c), to(c), p) >= 0) {
        ++c;
        continue;
      }
      require(claim_.neighbors[c] >= 0, "point {} is listed as hidden, but lies outside of the hull", p);
      t = index(claim_.neighbors[c]);
      c = 3 * t;
    }
    return t;
  }

  /// A set without triangles: its vertices in their order, the lower hull above their line.
  void check_line(const Ids& hull) {
    const auto power = [&](std::int32_t a, std::int32_t b, std::int32_t c) {
      const double weights[] = {weight(a), weight(b), weight(c)};
      return predicates_.power_on_line(place(a), place(b), place(c), weights);
    };
    for (std::size_t k = 1; k < hull.size(); ++k) {
      require(is_before(hull[k - 1], hull[k]), "the hull is not in order at point {}", hull[k]);
      require(k == 1 || power(hull[k - 2], hull[k - 1], hull[k]) > 0, "point {} is hidden", hull[k - 1]);
    }
    for (std::size_t i = first_; i < last_; ++i) {
      const auto p = static_cast<std::int32_t>(i);
      require(!hull.empty() && turn(hull.front(), hull.back(), p) == 0,
              "there are no triangles, but point {} is not on the line of the others", i);
      if (!is_hidden(p)) continue;
      const auto beyond = std::lower_bound(hull.begin(), hull.end(), p,
                                           [&](std::int32_t a, std::int32_t b) { return is_before(a, b); });
      require(beyond != hull.end(), "point {} is listed as hidden, but beyond the hull", i);
      require(is_same_place(*beyond, p) ? weight(*beyond) > weight(p)
                                        : beyond != hull.begin() && power(*(beyond - 1), p, *beyond) <= 0,
              "point {} is listed as hidden, but is not", i);
    }
  }

  const PlanarClaim& claim_;
  const Triangulation& mesh_;
  ExactPredicates predicates_;
  std::vector<std::int32_t> next_;  // of points on the hull
};

}  // namespace

std::string find_problem(const PlanarClaim& claim) {
  return problem_in([&] { PlanarProof(claim).run(); });
}

void check_halfedges_and_areas(const double* points, const Triangulation& mesh, const Ids& neighbors) {
  // Half-edge 3 t + k goes from corner k to the next one, so it is opposite to the one after.
  for (std::size_t h = 0; h < mesh.halfedges.size(); ++h) {
    const std::int32_t twin = mesh.halfedges[h], beyond = neighbors[mesh::next_corner(mesh::next_corner(h))];
    const auto back = static_cast<std::size_t>(std::max(twin, 0));
    const bool is_right = beyond < 0 ? twin == -1
                                     : twin >= 0 && twin / 3 == beyond &&
                                           mesh.triangles[back] == mesh.triangles[mesh::next_corner(h)] &&
                                           mesh.triangles[mesh::next_corner(back)] == mesh.triangles[h];
    require(is_right, "halfedge {} has {} as the one that goes back, which is not it", h, twin);
  }
  ExactPredicates predicates;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.areas.size(); ++t) {
    const double area = mesh.areas[t];
    const std::int32_t* const v = &mesh.triangles[3 * t];
    // Whether the exact area is at most, or at least, a neighbour of the rounded one.
    const auto compare = [&](double bound) {
      return std::isinf(bound)
                 ? -1
                 : predicates.compare_area(points + 2 * v[0], points + 2 * v[1], points + 2 * v[2], bound);
    };
    require(area >= 0 && compare(std::nextafter(area, kInfinity)) <= 0 &&
                (area == 0 || compare(std::nextafter(area, 0)) >= 0),
            "triangle {} does not have the area {}", t, area);
  }
}

std::vector<std::int32_t> neighbors_of(const Ids& triangles, std::size_t n) {
  const auto count = static_cast<std::int64_t>(triangles.size());
  std::vector<std::int64_t> begins(n + 1), twins(triangles.size());
  std::vector<std::uint64_t> keys(triangles.size());
  HalfEdges<std::int32_t, std::int64_t>{triangles.data()}.match(count, n, begins.data(), keys.data(),
                                                                twins.data());
  Ids neighbors(twins.size());
  std::transform(twins.begin(), twins.end(), neighbors.begin(),
                 [](std::int64_t twin) { return twin < 0 ? -1 : static_cast<std::int32_t>(twin / 3); });
  return neighbors;
}

}  // namespace flaunay::prove
