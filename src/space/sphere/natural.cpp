#include "space/sphere/natural.hpp"

#include <algorithm>
#include <utility>

#include "geometry/arguments.hpp"
#include "space/sphere/measures.hpp"

// The triangles whose caps contain the query form a region around it, whose border has the neighbours
// (Sibson, 1980; on the sphere Brown, 1994). All vectors are seen from the query, whose direction is the
// third axis. Differences of points are accurate there, however near these are, and so are the corners of
// cells: a corner is the cross product of two of them.

namespace flaunay::sphere {
namespace {

// An edge of a triangle, opposite to its corner k. The triangle is to its left.
struct Side {
  std::int32_t triangle;
  int k;
};
bool operator==(const Side& a, const Side& b) { return a.triangle == b.triangle && a.k == b.k; }

// The region of a query, which a triangle belongs to.
class Region {
 public:
  Region(const Walker& walker, std::int32_t t, Point query) : walker_(walker), query_(query), first_(t) {}

  bool has(std::int32_t t) const {
    return in_cap(walker_.place(walker_.corner(t, 0)), walker_.place(walker_.corner(t, 1)),
                  walker_.place(walker_.corner(t, 2)), query_) > 0;
  }
  // From a side of a triangle of the region, around its first end, to the border. Calls visit(triangle) for
  // each triangle that is entered.
  template <typename Visit>
  Side to_border(Side side, const Visit& visit) const {
    const std::int32_t begin = side.triangle;
    for (;;) {
      const std::int32_t other = walker_.beyond(side.triangle, side.k);
      if (other != first_ && !has(other)) return side;
      // Else the query would hide a point.
      expect(other != begin, "the arrays are not those of a triangulation on the sphere");
      side = {other, (walker_.corner_of(other, walker_.corner(side.triangle, side.k + 1)) + 2) % 3};
      visit(other);
    }
  }
  Side first() const {
    return to_border({first_, 0}, [](std::int32_t) {});
  }

 private:
  const Walker& walker_;
  Point query_;
  std::int32_t first_;
};

// A convex polygon, counter-clockwise.
class Polygon {
 public:
  explicit Polygon(const Direction& first) : corners_{first} {}
  // inwards: across the side that leads there. Sides of half a circle have a corner in their middle, too.
  void go_to(const Direction& corner, const Direction& inwards) {
    if (dot(corners_.back(), corner) < -0.5) corners_.push_back(normalized(cross(inwards, corners_.back())));
    corners_.push_back(corner);
  }
  double area() const {
    AreaSum sum;
    for (std::size_t i = 2; i + 1 < corners_.size(); ++i) sum.add(corners_[1], corners_[i], corners_[i + 1]);
    return sum.total();
  }

 private:
  std::vector<Direction> corners_;
};

// All points are on the circle of an arc with the query, and their cells from pole to pole of it, so that
// areas and edges over distances agree.
std::vector<Weighed> along_arc(const Walker& walker, const Side& arc, Point query) {
  std::int32_t a = walker.corner(arc.triangle, arc.k + 1), b = walker.corner(arc.triangle, arc.k + 2);
  if (comes_first(walker.place(b), walker.place(a))) std::swap(a, b);
  const double to_a = angle_of_chord(whole_chord(query, walker.place(a))),
               to_b = angle_of_chord(whole_chord(query, walker.place(b)));
  return {{a, to_b / (to_a + to_b)}, {b, to_a / (to_a + to_b)}};
}

}  // namespace

std::vector<Weighed> natural_neighbors(const Walker& walker, const Found& found, Point query,
                                       Interpolation method) {
  if (found.corner() >= 0) return {{walker.corner(found.triangle, found.corner()), 1}};
  std::int32_t inner = found.triangle;
  if (!Region(walker, inner, query).has(inner)) {
    // On an arc of a circle that halves the sphere.
    int k = 0;
    while (found.sides[static_cast<std::size_t>(k)] != 0) ++k;
    inner = walker.beyond(inner, k);
    if (!Region(walker, inner, query).has(inner)) return along_arc(walker, {found.triangle, k}, query);
  }
  const Region region(walker, inner, query);
  const Frame frame(direction_of(query));
  // From the query to a point, of length l, is -l^2 / 2 downwards.
  const auto from_query = [&](std::int32_t v) {
    const Direction to = whole_chord(query, walker.place(v));
    return frame.seen(to, -dot(to, to) / 2);
  };
  const auto between = [&](std::int32_t u, std::int32_t v) {
    const Point a = walker.place(u), b = walker.place(v);
    const Direction to = whole_chord(a, b);
    return frame.seen(to, -dot(to, whole_chord(query, a) + whole_chord(query, b)) / 2);
  };
  const auto centre_of = [&](std::int32_t t) {
    int k = 0;
    for (int j = 1; j < 3; ++j) {
      if (comes_first(walker.place(walker.corner(t, j)), walker.place(walker.corner(t, k)))) k = j;
    }
    const std::int32_t a = walker.corner(t, k);
    return normalized(cross(between(a, walker.corner(t, k + 1)), between(a, walker.corner(t, k + 2))));
  };
  std::vector<Weighed> result;
  const Side first = region.first();
  Side side = first;
  std::int32_t v = walker.corner(first.triangle, first.k + 2);
  Direction before = from_query(walker.corner(first.triangle, first.k + 1)), point = from_query(v),
            corner = normalized(cross(before, between(walker.corner(first.triangle, first.k + 1), v)));
  std::vector<std::int32_t> around;
  do {
    // The neighbour at the end of the side, from the side to the next one.
    around = {side.triangle};
    side = region.to_border({side.triangle, (side.k + 1) % 3}, [&](std::int32_t t) { around.push_back(t); });
    const std::int32_t next_point = walker.corner(side.triangle, side.k + 2);
    const Direction next = from_query(next_point),
                    next_corner = normalized(cross(point, between(v, next_point)));
    if (method == Interpolation::sibson) {
      // The part that the query takes of the neighbour's cell: between both corners, and corners of that.
      Polygon taken(corner);
      taken.go_to(next_corner, Direction{0, 0, 0} - point);
      Direction other = next;
      for (std::size_t i = around.size(); i-- > 0;) {
        taken.go_to(centre_of(around[i]), point - other);
        other = i > 0 ? from_query(walker.corner(around[i], walker.corner_of(around[i], v) + 2)) : before;
      }
      taken.go_to(corner, point - other);
      result.push_back({v, std::fmax(taken.area(), 0)});
    } else {
      result.push_back({v, angle_between(corner, next_corner) / angle_of_chord(point)});
    }
    before = point;
    point = next;
    corner = next_corner;
    v = next_point;
  } while (!(side == first));
  std::rotate(result.begin(),
              std::min_element(result.begin(), result.end(),
                               [&](const Weighed& a, const Weighed& b) {
                                 return comes_first(walker.place(a.point), walker.place(b.point));
                               }),
              result.end());
  double whole = 0;
  for (const Weighed& one : result) whole += one.weight;
  for (Weighed& one : result) one.weight /= whole;
  return result;
}

}  // namespace flaunay::sphere
