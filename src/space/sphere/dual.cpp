#include "space/sphere/dual.hpp"

#include <algorithm>
#include <numbers>

#include "operations/prefetch.h"
#include "space/sphere/places.hpp"

namespace flaunay::sphere {
namespace {

// How many triangles ahead what belongs to their corners is fetched, which can be anywhere in memory.
constexpr std::size_t kAhead = 16;

Direction normalized(const Direction& v) {
  const double length = std::sqrt(dot(v, v));
  return {v.x / length, v.y / length, v.z / length};
}

double square_of(double x, double y) { return x * x + y * y; }
Point nearest_to_origin(std::initializer_list<Point> points) {
  return std::min(points, [](Point u, Point v) { return square_of(u.x, u.y) < square_of(v.x, v.y); });
}

// On the sphere the circle around C in the plane, with k = |C|^2 - r^2 for its radius r, is that around (2 C,
// 1 - k). Both are multiplied by d here: then it is right also if the triangle is clockwise, and its circle
// the outside of that in the plane, and if the circle is a line. Opposite to a is the longest side, so that
// the vector from a to the centre is accurate in flat triangles, too; k is by the corner nearest to the
// origin.
Direction centre_of(Point a, Point b, Point c) {
  const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
  const double d = 2 * (bx * cy - by * cx), b2 = square_of(bx, by), c2 = square_of(cx, cy);
  const Point p = nearest_to_origin({a, b, c});
  const double x = b2 * cy - c2 * by + d * (a.x - p.x), y = c2 * bx - b2 * cx + d * (a.y - p.y);  // from p
  const double k = d * square_of(p.x, p.y) + 2 * (p.x * x + p.y * y);
  return normalized({2 * (d * p.x + x), 2 * (d * p.y + y), d - k});
}

// The circle through the pole, a and b is a line, and the cap to its left.
Direction centre_with_pole(Point a, Point b) {
  const double x = a.y - b.y, y = b.x - a.x;
  const Point p = nearest_to_origin({a, b});
  return normalized({x, y, -(x * p.x + y * p.y)});
}

Direction centre_of_triangle(const Triangulation& mesh, std::size_t t) {
  Point p[3];
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = place_at(mesh.places, static_cast<std::size_t>(mesh.triangles[3 * t + k]));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (is_pole(p[k])) return centre_with_pole(p[(k + 1) % 3], p[(k + 2) % 3]);
  }
  const auto side = [&](std::size_t k) {
    return square_of(p[(k + 2) % 3].x - p[(k + 1) % 3].x, p[(k + 2) % 3].y - p[(k + 1) % 3].y);
  };
  const double sides[3] = {side(0), side(1), side(2)};
  const auto a = static_cast<std::size_t>(std::max_element(sides, sides + 3) - sides);
  return centre_of(p[a], p[(a + 1) % 3], p[(a + 2) % 3]);
}

// From a to b in space, times a positive number: accurate also if they are near each other.
Direction chord(Point a, Point b) {
  // Starts from the one that is nearer to the origin, beside which nothing cancels.
  if (square_of(a.x, a.y) > square_of(b.x, b.y)) return Direction{0, 0, 0} - chord(b, a);
  if (is_pole(b)) return {-a.x, -a.y, -1};
  const double x = b.x - a.x, y = b.y - a.y, scale = 1 + a.x * a.x + a.y * a.y;
  const double square = x * (a.x + b.x) + y * (a.y + b.y);  // |b|^2 - |a|^2
  return {x * scale - a.x * square, y * scale - a.y * square, -square};
}

// A sum of signed areas of triangles of unit vectors. Half of a triangle's area is the angle of a complex
// number (Eriksson, 1990), and a sum of angles that of a product, so that most cells need one arctangent.
class AreaSum {
 public:
  void add(const Direction& a, const Direction& b, const Direction& c) {
    // A quarter, so that no product is beyond 1.
    const double y = dot(a, cross(b - a, c - a)) / 4, x = (1 + dot(a, b) + dot(b, c) + dot(c, a)) / 4;
    if (x < kLeast) {
      angle_ += std::atan2(y, x);
      return;
    }
    const double before = x_;
    x_ = x_ * x - y_ * y;
    y_ = before * y + y_ * x;
    // Both angles were less than a right one, so that their sum is less than half a turn.
    if (x_ < kLeast) take_angle();
  }
  double total() {
    take_angle();
    return 2 * angle_;
  }

 private:
  static constexpr double kLeast = 1.0 / 16;

  void take_angle() {
    angle_ += std::atan2(y_, x_);
    x_ = 1;
    y_ = 0;
  }

  double angle_ = 0, x_ = 1, y_ = 0;
};

// Fetches what the corners of a triangle that is soon needed have in an array: `width` elements each.
template <typename T>
FETCHING void fetch_corners(const Triangulation& mesh, std::size_t t, const T* array, std::size_t width = 1) {
  const std::size_t first = std::min(3 * t, mesh.triangles.size() - 3);
  for (std::size_t c = first; c < first + 3; ++c)
    kernel::fetch(array + width * static_cast<std::size_t>(mesh.triangles[c]));
}

class Dual {
 public:
  Dual(const Triangulation& mesh, Voronoi& result) : mesh_(mesh), result_(result) {}

  Direction centre(std::int32_t t) const {
    const double* const c = &result_.circumcentres[3 * static_cast<std::size_t>(t)];
    return {c[0], c[1], c[2]};
  }
  Point place(std::int32_t v) const { return place_at(mesh_.places, static_cast<std::size_t>(v)); }

  // Writes the triangles around a point, from its smallest, t, and the area of its cell.
  void write_cell(std::int32_t v, std::int32_t t) {
    const auto cell = static_cast<std::size_t>(v);
    const Direction point = direction_of(place(v));
    Direction begin = centre(t);
    AreaSum area;
    for (std::int32_t i = result_.cell_offsets[cell]; i < result_.cell_offsets[cell + 1]; ++i) {
      result_.cells[static_cast<std::size_t>(i)] = t;
      const std::int32_t* const corners = &mesh_.triangles[3 * static_cast<std::size_t>(t)];
      // The next triangle has the edge to the corner before this one, and is opposite to that after it.
      const std::size_t after = corners[0] == v ? 1 : corners[1] == v ? 2 : 0;
      t = mesh_.neighbors[3 * static_cast<std::size_t>(t) + after];
      const Direction end = centre(t);
      if (dot(begin, end) > kLong) {
        area.add(point, begin, end);
      } else {
        const Direction middle = middle_of(v, corners[(after + 1) % 3], begin, end);
        area.add(point, begin, middle);
        area.add(point, middle, end);
      }
      begin = end;
    }
    result_.areas[cell] = area.total();
  }

 private:
  // A quarter of a turn from one end of the border between two points. It is the same for both, so that areas
  // add up also where points are too near each other to tell where the border goes.
  Direction middle_of(std::int32_t v, std::int32_t other, const Direction& begin,
                      const Direction& end) const {
    if (v > other) return middle_of(other, v, end, begin);
    return normalized(cross(begin, chord(place(v), place(other))));
  }

  // A border is an arc of at most half a great circle. If the cosine of its angle is less, it is halved.
  static constexpr double kLong = -0.5;

  const Triangulation& mesh_;
  Voronoi& result_;
};

}  // namespace

Voronoi make_dual(host::Runtime& runtime, const Triangulation& mesh) {
  const std::size_t n = mesh.places.size() / 2, triangles = mesh.triangles.size() / 3;
  Voronoi result;
  result.circumcentres.resize(3 * triangles);
  for_each(runtime, triangles, [&](std::size_t t) {
    fetch_corners(mesh, t + kAhead, mesh.places.data(), 2);
    const Direction c = centre_of_triangle(mesh, t);
    std::copy_n(std::begin({c.x, c.y, c.z}), 3, &result.circumcentres[3 * t]);
  });
  result.cell_offsets.assign(n + 1, 0);
  std::vector<std::int32_t> smallest(n);
  for (std::size_t c = mesh.triangles.size(); c-- > 0;) {
    const auto v = static_cast<std::size_t>(mesh.triangles[c]);
    ++result.cell_offsets[v + 1];
    smallest[v] = static_cast<std::int32_t>(c / 3);
  }
  for (std::size_t i = 0; i < n; ++i) result.cell_offsets[i + 1] += result.cell_offsets[i];
  result.cells.resize(mesh.triangles.size());
  result.areas.assign(n, 0);
  Dual dual(mesh, result);
  // In the order of triangles, those of a cell are near each other in memory.
  for_each(runtime, triangles, [&](std::size_t t) {
    fetch_corners(mesh, t + kAhead, smallest.data());
    fetch_corners(mesh, t + kAhead, mesh.places.data(), 2);
    fetch_corners(mesh, t + kAhead, result.cell_offsets.data());
    fetch_corners(mesh, t + kAhead, result.areas.data());
    for (std::size_t c = 3 * t; c < 3 * t + 3; ++c) {
      const std::int32_t v = mesh.triangles[c], first = smallest[static_cast<std::size_t>(v)];
      if (static_cast<std::size_t>(first) == t) dual.write_cell(v, first);
    }
  });
  // Sets of one or two points have no triangles.
  for (std::size_t s = 0; s + 1 < mesh.point_offsets.size(); ++s) {
    if (mesh.triangle_offsets[s] < mesh.triangle_offsets[s + 1]) continue;
    std::vector<std::size_t> different;
    for (std::size_t i = mesh.point_offsets[s]; i < mesh.point_offsets[s + 1]; ++i) {
      if (mesh.representatives[i] == static_cast<std::int32_t>(i)) different.push_back(i);
    }
    for (const std::size_t i : different) {
      result.areas[i] = 4 * std::numbers::pi / static_cast<double>(different.size());
    }
  }
  return result;
}

}  // namespace flaunay::sphere
