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
// Otherwise right triangles cover the polygon once, too. Straight ones that are joined lie on one line, and
// have the same orientation on their circle; so they have a border. All that is joined to them lies on one
// side of the line, left ones with their edges in one direction and right ones with theirs in the other. A
// border sums up to nothing, so edges of right ones are where edges of left ones are: on the polygon. So
// right ones, too, meet inside along whole edges. Lifted to the paraboloid, these are concave: that is the
// farthest-point triangulation, which has no corners but the polygon's. Straight ones are left to fill what
// is between an edge of these and the points on it, as canonical ties say.
//
// Either way there are 2 c - 4 triangles for c corners, which have different places. So no point is missing,
// nor does one represent itself although another point has its place.
//
// If no triangle turns left, all edges must be flat. So triangles that are joined lie on one circle through
// the pole, where orientation on that takes the place of turns: left ones are those of one side of the
// circle's polygon, and the others are the same in reverse.
#include "derived/sphere/verify.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "derived/sphere/predicates.hpp"
#include "geometry/problem.hpp"

namespace flaunay::sphere {
namespace {

using geometry::require;
using geometry::operator==;

// How a triangle lies in the plane. Straight ones, and those with the pole, follow the canonical order up to
// rotation, or go against it.
enum Kind : std::int8_t { kLeft = 1, kRight = -1, kAlong = 2, kAgainst = -2 };

Kind kind_of(Point a, Point b, Point c) {
  if (!is_pole(a) && !is_pole(b) && !is_pole(c)) {
    const int turn = kernel::orient_sign(a, b, c, ORIENT_BOUND);
    if (turn != 0) return turn > 0 ? kLeft : kRight;
  }
  return comes_first(a, b) + comes_first(b, c) + comes_first(c, a) == 2 ? kAlong : kAgainst;
}

// 1 if d lies outside of the plane in space through a, b, c, which are counter-clockwise as seen from there;
// -1 if inside, 0 if the four lie on one circle.
int outside(Point a, Point b, Point c, Point d) {
  Point p[] = {a, b, c, d};
  if (p[2] == p[3]) return 0;
  for (int k = 0; k < 3; ++k) {
    if (!is_pole(p[k])) continue;
    std::swap(p[k], p[3]);
    std::swap(p[(k + 1) % 3], p[(k + 2) % 3]);
  }
  return is_pole(p[3]) ? -kernel::orient_sign(p[0], p[1], p[2], ORIENT_BOUND)
                       : kernel::circle_sign(p[0], p[1], p[2], p[3], CIRCLE_BOUND);
}

class Checker {
 public:
  Checker(host::Runtime& runtime, const SphericalTriangulation& mesh)
      : runtime_(runtime),
        mesh_(mesh),
        kinds_(mesh.triangles.size() / 3),
        next_(mesh.representatives.size(), -1) {}

  void check_set(std::size_t s) {
    first_ = mesh_.point_offsets[s];
    last_ = mesh_.point_offsets[s + 1];
    begin_ = mesh_.triangle_offsets[s];
    end_ = mesh_.triangle_offsets[s + 1];
    const std::size_t points = check_representatives(), expected = points > 2 ? 2 * points - 4 : 0;
    require(end_ - begin_ == expected, "set {} has {} triangles, not {}", s, end_ - begin_, expected);
    if (expected == 0) return;
    for_each(runtime_, expected, [&](std::size_t i) { kinds_[begin_ + i] = checked_kind(begin_ + i); });
    const auto of_set = kinds_.begin() + static_cast<std::ptrdiff_t>(begin_);
    const auto end = of_set + static_cast<std::ptrdiff_t>(expected);
    is_flat_ = std::find(of_set, end, kLeft) == end;
    for_each(runtime_, expected, [&](std::size_t i) { check_edges(begin_ + i); });
    check_border();
  }

 private:
  static std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }
  Point place(std::size_t i) const { return place_at(mesh_.places, i); }
  Point place(std::int32_t v) const { return place(index(v)); }
  const std::int32_t* corners(std::size_t t) const { return &mesh_.triangles[3 * t]; }
  bool represents_itself(std::size_t i) const { return index(mesh_.representatives[i]) == i; }

  /// Returns how many points represent themselves, and notes whether one is at the pole. That the places of
  /// these are different is seen here if there are two, and else by the triangles.
  std::size_t check_representatives() {
    std::size_t count = 0;
    has_pole_ = false;
    for (std::size_t i = first_; i < last_; ++i) {
      const std::size_t r = index(mesh_.representatives[i]);
      const bool is_right = r >= first_ && r <= i && represents_itself(r) && place(r) == place(i) &&
                            (r != i || i == first_ || !(place(i) == place(first_)));
      require(is_right, "point {} has a wrong representative", i);
      if (r != i) continue;
      ++count;
      has_pole_ |= is_pole(place(i));
    }
    return count;
  }

  Kind checked_kind(std::size_t t) const {
    const std::int32_t* const v = corners(t);
    Point p[3];
    for (std::size_t k = 0; k < 3; ++k) {
      require(index(v[k]) >= first_ && index(v[k]) < last_ && represents_itself(index(v[k])),
              "triangle {} has a corner {} of another set, or that another point represents", t, v[k]);
      p[k] = place(v[k]);
    }
    require(v[0] < v[1] && v[0] < v[2], "triangle {} does not begin with its smallest index", t);
    require(!(p[0] == p[1] || p[1] == p[2] || p[2] == p[0]), "triangle {} has two equal corners", t);
    return kind_of(p[0], p[1], p[2]);
  }

  void check_edges(std::size_t t) const {
    const std::int32_t* const v = corners(t);
    const Kind kind = kinds_[t];
    const bool has_pole = std::any_of(v, v + 3, [&](std::int32_t i) { return is_pole(place(i)); });
    const bool fits = is_flat_ ? std::abs(kind) == kAlong : kind == kLeft || has_pole || !has_pole_;
    require(fits, "triangle {} does not fit those around the south pole", t);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t other = index(mesh_.neighbors[3 * t + k]);
      require(other >= begin_ && other < end_, "triangle {} has a neighbor of another set", t);
      const std::int32_t *const w = corners(other), from = v[(k + 1) % 3], to = v[(k + 2) % 3];
      std::size_t m = 0;
      while (m < 3 && !(w[(m + 1) % 3] == to && w[(m + 2) % 3] == from)) ++m;
      require(m < 3 && index(mesh_.neighbors[3 * other + m]) == t,
              "triangles {} and {} are not neighbors of each other", t, other);
      if (t < other) check_edge(t, other, {place(from), place(to), place(v[k]), place(w[m])});
    }
  }

  /// quad: the ends of the edge, and the corners opposite to it.
  void check_edge(std::size_t t, std::size_t other, const std::array<Point, 4>& quad) const {
    const auto& [a, b, c, d] = quad;
    const int side = outside(a, b, c, d);
    require(side == 0 || (side < 0 && !is_flat_), "the edge between the triangles {} and {} is not convex", t,
            other);
    if (side != 0) return;
    if (kinds_[t] == kinds_[other]) {
      const Point first = comes_first(a, b) ? a : b;
      require(comes_first(first, c) && comes_first(first, d),
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
      start = corners(c / 3)[(c + 1) % 3];
      std::int32_t& next = next_[index(start)];
      require(next < 0, "the triangles around the south pole meet twice at point {}", start);
      next = corners(c / 3)[(c + 2) % 3];
      ++edges;
    }
    require(start >= 0, "no triangles are around the south pole");
    std::int32_t v = start;
    do {
      const std::int32_t to = next_[index(v)];
      const Point a = place(v), b = place(to), c = place(next_[index(to)]);
      const Kind turn = kind_of(a, b, c);
      require(is_flat_ ? turn == kAlong : turn != kRight, "the hull in the plane is not convex at point {}",
              to);
      turns += comes_first(a, b) != comes_first(b, c);
      ++steps;
      v = to;
    } while (v != start);
    require(steps == edges && turns == 2, "the triangles around the south pole go around more than once");
  }

  host::Runtime& runtime_;
  const SphericalTriangulation& mesh_;
  std::vector<Kind> kinds_;
  std::vector<std::int32_t> next_;  // along the border
  std::size_t first_ = 0, last_ = 0, begin_ = 0, end_ = 0;
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

std::string find_problem(host::Runtime& runtime, const std::vector<double>& places,
                         const SphericalTriangulation& mesh) {
  return geometry::problem_in([&] {
    check_places(places, mesh.places);
    Checker checker(runtime, mesh);
    for (std::size_t s = 0; s + 1 < mesh.point_offsets.size(); ++s) checker.check_set(s);
  });
}

}  // namespace flaunay::sphere
