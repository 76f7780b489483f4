// Why the checks together are complete. Triangles are joined at all edges, each with its reverse. In the
// plane of places a triangle turns left, turns right, is straight (its circle contains the pole), or has the
// pole as a corner.
//
// Left triangles have one polygon as their border, which is convex and winds once. At each place its winding
// number is how many of them cover that: one inside, none outside. So they do not overlap, and meet inside
// along whole edges. These are locally Delaunay, and canonical at ties; so this is the canonical Delaunay
// triangulation of their corners.
//
// If the pole is a point, all others have it as a corner. Where two triangles of one circle meet, they must
// not lie on each other; so the edge opposite to the pole is one of the polygon, and each of these has one.
//
// Otherwise right triangles cover the polygon once, too. Straight triangles that are joined lie on one line,
// and have the same orientation on their circle; so they have a border. All triangles joined to them lie on
// one side of the line, left ones with their edges in one direction and right ones with theirs in the other.
// A border sums up to nothing, so right triangles have edges where left triangles have edges: on the polygon.
// So right triangles, too, meet inside along whole edges. Lifted to the paraboloid, these edges are concave:
// right triangles are the farthest-point triangulation, whose corners are the polygon's. Straight triangles
// fill the gap between an edge of it and the points on that edge, as canonical ties demand.
//
// Either way there are 2 c - 4 triangles for c corners, which have different places. So no point is missing,
// nor does one represent itself although another point has its place.
//
// If no triangle turns left, all edges must be flat. So triangles that are joined lie on one circle through
// the pole, where orientation on that circle takes the place of turns: left triangles cover one side of the
// circle's polygon, and the others the same polygon in reverse.
#include "prove/sphere_proof.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "prove/exact.hpp"
#include "prove/rows.hpp"

namespace flaunay::prove {
namespace {

// x and y in the plane of places; both are infinite at the pole.
using SpherePlace = const double*;

bool is_pole(SpherePlace p) { return std::isinf(p[0]); }
bool is_same(SpherePlace a, SpherePlace b) { return a[0] == b[0] && a[1] == b[1]; }
// The canonical order: the pole first, then by x, then by y.
bool comes_first(SpherePlace a, SpherePlace b) { return !is_pole(b) && (is_pole(a) || comes_before(a, b)); }

// How a triangle lies in the plane. Straight ones, and those with the pole, follow the canonical order up to
// rotation, or go against it.
enum Kind : std::int8_t { kLeft = 1, kRight = -1, kAlong = 2, kAgainst = -2 };

class SphereProof : RowsProof {
 public:
  explicit SphereProof(const Triangulation& mesh)
      : RowsProof({mesh.triangles, mesh.neighbors, mesh.representatives, mesh.point_offsets,
                   mesh.triangle_offsets}),
        mesh_(mesh),
        kinds_(mesh.triangles.size() / 3),
        next_(mesh.representatives.size(), -1) {}

  void run() {
    for (std::size_t s = 0; s < sets(); ++s) check_set(s);
  }

 private:
  SpherePlace place(std::int64_t i) const { return &mesh_.places[2 * index(i)]; }

  void check_set(std::size_t s) {
    enter(s);
    check_representatives([&](std::size_t i) {
      const SpherePlace at = place(static_cast<std::int64_t>(i));
      return std::pair(at[0], at[1]);
    });
    std::size_t points = 0;
    has_pole_ = false;
    for (std::size_t i = first_; i < last_; ++i) {
      if (!represents_itself(i)) continue;
      ++points;
      has_pole_ |= is_pole(place(static_cast<std::int64_t>(i)));
    }
    const std::size_t expected = points > 2 ? 2 * points - 4 : 0;
    require(end_ - begin_ == expected, "set {} has {} triangles, not {}", s, end_ - begin_, expected);
    if (expected == 0) return;
    for (std::size_t t = begin_; t < end_; ++t) kinds_[t] = checked_kind(t);
    const auto of_set = kinds_.begin() + static_cast<std::ptrdiff_t>(begin_);
    const auto end = of_set + static_cast<std::ptrdiff_t>(expected);
    is_flat_ = std::find(of_set, end, kLeft) == end;
    for (std::size_t t = begin_; t < end_; ++t) check_edges(t);
    check_border();
  }

  Kind kind_of(SpherePlace a, SpherePlace b, SpherePlace c) {
    if (!is_pole(a) && !is_pole(b) && !is_pole(c)) {
      const int turn = predicates_.orient2d(a, b, c);
      if (turn != 0) return turn > 0 ? kLeft : kRight;
    }
    return comes_first(a, b) + comes_first(b, c) + comes_first(c, a) == 2 ? kAlong : kAgainst;
  }

  // 1 if d lies outside of the plane in space through a, b, c, which are counter-clockwise as seen from
  // there; -1 if inside, 0 if the four lie on one circle.
  int outside(SpherePlace a, SpherePlace b, SpherePlace c, SpherePlace d) {
    SpherePlace p[] = {a, b, c, d};
    if (is_same(c, d)) return 0;
    for (int k = 0; k < 3; ++k) {
      if (!is_pole(p[k])) continue;
      std::swap(p[k], p[3]);
      std::swap(p[(k + 1) % 3], p[(k + 2) % 3]);
    }
    return is_pole(p[3]) ? -predicates_.orient2d(p[0], p[1], p[2])
                         : predicates_.incircle(p[0], p[1], p[2], p[3]);
  }

  Kind checked_kind(std::size_t t) {
    const std::int32_t* const v = corners(t);
    for (std::size_t k = 0; k < 3; ++k) check_vertex(v[k], t);
    require(v[0] < v[1] && v[0] < v[2], "triangle {} does not begin with its smallest index", t);
    require(v[1] != v[2], "triangle {} has two equal corners", t);
    return kind_of(place(v[0]), place(v[1]), place(v[2]));
  }

  void check_edges(std::size_t t) {
    const std::int32_t* const v = corners(t);
    const bool has_pole = std::any_of(v, v + 3, [&](std::int32_t i) { return is_pole(place(i)); });
    const bool fits = is_flat_ ? std::abs(kinds_[t]) == kAlong : kinds_[t] == kLeft || has_pole || !has_pole_;
    require(fits, "triangle {} does not fit those around the south pole", t);
    for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
      const std::size_t d = across(c);
      if (t < d / 3) check_edge(c, d);
    }
  }

  // c, d: the corners opposite to the edge.
  void check_edge(std::size_t c, std::size_t d) {
    const std::size_t t = c / 3, other = d / 3;
    const SpherePlace a = place(from(c)), b = place(to(c)), p = place(mesh_.triangles[c]),
                      q = place(mesh_.triangles[d]);
    const int side = outside(a, b, p, q);
    require(side == 0 || (side < 0 && !is_flat_), "the edge between the triangles {} and {} is not convex", t,
            other);
    if (side != 0) return;
    if (kinds_[t] == kinds_[other]) {
      const SpherePlace first = comes_first(a, b) ? a : b;
      require(comes_first(first, p) && comes_first(first, q),
              "the edge between the triangles {} and {} is not canonical", t, other);
    } else {
      // If all points lie on one circle, so do both sides of their polygon.
      require(is_flat_ || std::abs(kinds_[t]) == kLeft, "the triangles {} and {} lie on each other", t,
              other);
    }
  }

  /// That triangles of one kind have one convex polygon around them.
  void check_border() {
    const Kind kind = is_flat_ ? kAlong : kLeft;
    std::int32_t start = -1;
    std::size_t edges = 0, steps = 0, turns = 0;
    for (std::size_t c = 3 * begin_; c < 3 * end_; ++c) {
      if (kinds_[c / 3] != kind || kinds_[index(mesh_.neighbors[c])] == kind) continue;
      start = from(c);
      std::int32_t& next = next_[index(start)];
      require(next < 0, "the triangles around the south pole meet twice at point {}", start);
      next = to(c);
      ++edges;
    }
    require(start >= 0, "no triangles are around the south pole");
    std::int32_t v = start;
    do {
      const std::int32_t beyond = next_[index(v)];
      const SpherePlace a = place(v), b = place(beyond), c = place(next_[index(beyond)]);
      const Kind turn = kind_of(a, b, c);
      require(is_flat_ ? turn == kAlong : turn != kRight, "the hull in the plane is not convex at point {}",
              beyond);
      turns += comes_first(a, b) != comes_first(b, c);
      ++steps;
      v = beyond;
    } while (v != start);
    require(steps == edges && turns == 2, "the triangles around the south pole go around more than once");
  }

  const Triangulation& mesh_;
  ExactPredicates predicates_;
  std::vector<Kind> kinds_;
  std::vector<std::int32_t> next_;  // along the border
  bool has_pole_ = false;
  bool is_flat_ = false;  // whether all points have to lie on a circle through the pole
};

void check_places(const std::vector<double>& places, const std::vector<double>& given) {
  require(places.size() == given.size(), "there are {} places, not {}", given.size() / 2, places.size() / 2);
  for (std::size_t i = 0; i < places.size(); i += 2) {
    require(std::memcmp(&places[i], &given[i], 2 * sizeof(double)) == 0, "point {} has a wrong place", i / 2);
  }
}

}  // namespace

std::string find_problem(const std::vector<double>& places, const Triangulation& mesh) {
  return problem_in([&] {
    check_places(places, mesh.places);
    SphereProof(mesh).run();
  });
}

}  // namespace flaunay::prove
