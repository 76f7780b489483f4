#include "derived/sphere/dual.hpp"

#include <algorithm>
#include <numbers>

#include "derived/sphere/places.hpp"

namespace flaunay::sphere {
namespace {

Direction normalized(const Direction& v) {
  const double length = std::sqrt(dot(v, v));
  return {v.x / length, v.y / length, v.z / length};
}

// On the sphere the circle around C in the plane, with k = |C|^2 - r^2 for its radius r, is that around (2 C,
// 1 - k). Both are multiplied by d here: then it is right also if the triangle is clockwise, and its circle
// the outside of that in the plane, and if the circle is a line.
Direction centre_of(Point a, Point b, Point c) {
  const double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
  const double d = 2 * (bx * cy - by * cx), b2 = bx * bx + by * by, c2 = cx * cx + cy * cy;
  const double from_a_x = b2 * cy - c2 * by, from_a_y = c2 * bx - b2 * cx;
  const double k = d * (a.x * a.x + a.y * a.y) + 2 * (a.x * from_a_x + a.y * from_a_y);
  return normalized({2 * (d * a.x + from_a_x), 2 * (d * a.y + from_a_y), d - k});
}

// The circle through the pole, a and b is a line, and the cap to its left.
Direction centre_with_pole(Point a, Point b) {
  const double x = a.y - b.y, y = b.x - a.x;
  return normalized({x, y, -(x * a.x + y * a.y)});
}

Direction centre_of_triangle(const SphericalTriangulation& mesh, std::size_t t) {
  Point p[3];
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = place_at(mesh.places, static_cast<std::size_t>(mesh.triangles[3 * t + k]));
  }
  for (std::size_t k = 0; k < 3; ++k) {
    if (is_pole(p[k])) return centre_with_pole(p[(k + 1) % 3], p[(k + 2) % 3]);
  }
  return centre_of(p[0], p[1], p[2]);
}

// The signed area of a triangle of unit vectors (Eriksson, 1990).
double area_of(const Direction& a, const Direction& b, const Direction& c) {
  return 2 * std::atan2(dot(a, cross(b - a, c - a)), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

// What the border with another point adds to the area of a point's cell: the triangle of the point and the
// border's ends. The border is an arc of at most half a great circle; if it is long, it is halved a quarter
// of a turn from where it begins.
double area_along(const Direction& point, const Direction& other, const Direction& begin,
                  const Direction& end) {
  constexpr double kLong = -0.5;
  if (dot(begin, end) > kLong) return area_of(point, begin, end);
  const Direction middle = normalized(cross(begin, other - point));
  return area_of(point, begin, middle) + area_of(point, middle, end);
}

class Dual {
 public:
  Dual(const SphericalTriangulation& mesh, SphericalVoronoi& result) : mesh_(mesh), result_(result) {}

  Direction centre(std::int32_t t) const {
    const double* const c = &result_.centres[3 * static_cast<std::size_t>(t)];
    return {c[0], c[1], c[2]};
  }
  Direction direction(std::int32_t v) const {
    return direction_of(place_at(mesh_.places, static_cast<std::size_t>(v)));
  }
  std::int32_t corner(std::int32_t t, int k) const {
    return mesh_.triangles[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>(k % 3)];
  }
  int corner_of(std::int32_t t, std::int32_t v) const {
    int k = 0;
    while (corner(t, k) != v) ++k;
    return k;
  }

  // Writes the triangles around a point, from its smallest, and the area of its cell.
  void write_cell(std::int32_t v) {
    std::int32_t* const cell =
        &result_.cells[static_cast<std::size_t>(result_.cell_offsets[static_cast<std::size_t>(v)])];
    const std::size_t size = static_cast<std::size_t>(result_.cell_offsets[static_cast<std::size_t>(v) + 1]) -
                             static_cast<std::size_t>(cell - result_.cells.data());
    const Direction point = direction(v);
    std::int32_t t = cell[0];
    double area = 0;
    for (std::size_t i = 0; i < size; ++i) {
      cell[i] = t;
      const int k = corner_of(t, v);
      // The next triangle has the edge to the corner before this one.
      const Direction other = direction(corner(t, k + 2));
      const std::int32_t next =
          mesh_.neighbors[3 * static_cast<std::size_t>(t) + static_cast<std::size_t>((k + 1) % 3)];
      area += area_along(point, other, centre(t), centre(next));
      t = next;
    }
    result_.areas[static_cast<std::size_t>(v)] = area;
  }

 private:
  const SphericalTriangulation& mesh_;
  SphericalVoronoi& result_;
};

}  // namespace

SphericalVoronoi make_dual(host::Runtime& runtime, const SphericalTriangulation& mesh) {
  const std::size_t n = mesh.places.size() / 2, triangles = mesh.triangles.size() / 3;
  SphericalVoronoi result;
  result.centres.resize(3 * triangles);
  for_each(runtime, triangles, [&](std::size_t t) {
    const Direction c = centre_of_triangle(mesh, t);
    std::copy_n(std::begin({c.x, c.y, c.z}), 3, &result.centres[3 * t]);
  });
  result.cell_offsets.assign(n + 1, 0);
  for (const std::int32_t v : mesh.triangles) ++result.cell_offsets[static_cast<std::size_t>(v) + 1];
  for (std::size_t i = 0; i < n; ++i) result.cell_offsets[i + 1] += result.cell_offsets[i];
  result.cells.resize(mesh.triangles.size());
  // The first triangle of each point begins its cell.
  for (std::size_t c = mesh.triangles.size(); c-- > 0;) {
    const auto v = static_cast<std::size_t>(mesh.triangles[c]);
    result.cells[static_cast<std::size_t>(result.cell_offsets[v])] = static_cast<std::int32_t>(c / 3);
  }
  result.areas.assign(n, 0);
  Dual dual(mesh, result);
  for_each(runtime, n, [&](std::size_t v) {
    if (result.cell_offsets[v] < result.cell_offsets[v + 1]) dual.write_cell(static_cast<std::int32_t>(v));
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
