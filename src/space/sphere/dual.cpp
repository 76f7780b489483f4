// Voronoi cells of points on the sphere.
#include <algorithm>
#include <numbers>

#include "derived/voronoi/stars.hpp"
#include "space/sphere/measures.hpp"
#include "space/sphere/triangulate_on_sphere.hpp"

namespace flaunay::sphere {
namespace {

using voronoi::Stars;

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

// A sum of the integrals of x over triangles of unit vectors with the corner p, which are half of those of
// the arcs' angles times the normals of their planes. With f for an angle over its sine, these are the sums
// of f (a x b). Seen from p, whose part is apart, nothing cancels, however small the triangles are.
class MomentSum {
 public:
  void add(const Direction& p, const Direction& a, const Direction& b) {
    const Direction u = a - p, v = b - p, arc = cross(a, b);
    const double u_height = dot(u, u) / 2, v_height = dot(v, v) / 2, sine = std::sqrt(dot(arc, arc));
    const double excess = excess_of(sine, dot(a, b));
    along_ += (1 + excess) * dot(p, cross(u, v));
    const double from_u = (1 + excess) * v_height - excess, from_v = excess - (1 + excess) * u_height;
    across_ = {across_.x + from_u * u.x + from_v * v.x, across_.y + from_u * u.y + from_v * v.y,
               across_.z + from_u * u.z + from_v * v.z};
  }
  // NaN if the triangles are so small that p and rounding are all there is of them.
  Direction direction(const Direction& p) const {
    constexpr double kLeast = 1e-28;
    const Direction turned = cross(p, across_),
                    all = {along_ * p.x + turned.x, along_ * p.y + turned.y, along_ * p.z + turned.z};
    return dot(all, all) < kLeast * kLeast ? Direction{NAN, NAN, NAN} : normalized(all);
  }

 private:
  // An angle over its sine, less 1.
  static double excess_of(double sine, double cosine) {
    const double square = sine * sine;
    if (cosine > 0 && square < 1e-4) return square * (1.0 / 6 + square * (3.0 / 40 + square * (5.0 / 112)));
    return std::atan2(sine, cosine) / sine - 1;
  }

  double along_ = 0;
  Direction across_{0, 0, 0};
};

// The centres of triangles, and the borders between cells, which are arcs from one to the next.
class Dual {
 public:
  Dual(host::Runtime& runtime, const Triangulation& mesh)
      : mesh_(mesh), stars_(mesh, mesh.places.size() / 2), centres_(mesh.triangles.size()) {
    const auto fetch = [&](std::size_t v) { kernel::fetch(&mesh.places[2 * v]); };
    voronoi::for_each_triangle(runtime, mesh, fetch, [&](std::size_t t) {
      const Direction c = centre_of_triangle(mesh, t);
      std::copy_n(std::begin({c.x, c.y, c.z}), 3, &centres_[3 * t]);
    });
  }

  const Stars& stars() const { return stars_; }
  std::vector<double> take_centres() { return std::move(centres_); }
  Point place(std::int32_t v) const { return place_at(mesh_.places, static_cast<std::size_t>(v)); }

  // Adds the triangles between a point and the arcs around it, and calls visit(t) for the triangles that have
  // it, from its first corner on.
  template <typename Sum, typename Visit>
  void add_cell(std::int32_t v, std::int32_t first, Sum& sum, const Visit& visit) const {
    const Direction point = direction_of(place(v));
    std::int32_t t = first / 3;
    Direction begin = centre(t);
    for (std::int32_t count = stars_.size(v); count > 0; --count) {
      visit(t);
      const std::int32_t* const corners = &mesh_.triangles[3 * static_cast<std::size_t>(t)];
      // The next triangle has the edge to the corner before this one, and is opposite to that after it.
      const std::size_t after = corners[0] == v ? 1 : corners[1] == v ? 2 : 0;
      t = mesh_.neighbors[3 * static_cast<std::size_t>(t) + after];
      const Direction end = centre(t);
      if (dot(begin, end) > kLong) {
        sum.add(point, begin, end);
      } else {
        const Direction middle = middle_of(v, corners[(after + 1) % 3], begin, end);
        sum.add(point, begin, middle);
        sum.add(point, middle, end);
      }
      begin = end;
    }
  }

  // Calls work(i, different) for the points of sets without triangles, whose different points are these.
  template <typename Work>
  void for_each_alone(const Work& work) const {
    for (std::size_t s = 0; s + 1 < mesh_.point_offsets.size(); ++s) {
      if (mesh_.triangle_offsets[s] < mesh_.triangle_offsets[s + 1]) continue;
      std::vector<std::size_t> different;
      for (std::size_t i = mesh_.point_offsets[s]; i < mesh_.point_offsets[s + 1]; ++i) {
        if (mesh_.representatives[i] == static_cast<std::int32_t>(i)) different.push_back(i);
      }
      for (const std::size_t i : different) work(i, different);
    }
  }

 private:
  Direction centre(std::int32_t t) const {
    const double* const c = &centres_[3 * static_cast<std::size_t>(t)];
    return {c[0], c[1], c[2]};
  }
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
  const Stars stars_;
  std::vector<double> centres_;
};

}  // namespace

Voronoi make_dual(call::Implementation& self, const call::CellInput& input) {
  const Triangulation& mesh = input.mesh;
  call::check_on_sphere(mesh);
  host::Runtime& runtime = self.native().runtime;
  Dual dual(runtime, mesh);
  const std::vector<std::int32_t>& offsets = dual.stars().offsets();
  Voronoi result;
  result.cells.resize(mesh.triangles.size());
  result.areas.assign(mesh.places.size() / 2, 0);
  const auto fetch = [&](std::size_t v) {
    kernel::fetch(&mesh.places[2 * v]);
    kernel::fetch(&offsets[v]);
    kernel::fetch(&result.areas[v]);
  };
  dual.stars().for_each(runtime, fetch, [&](std::int32_t v, std::int32_t first) {
    const auto cell = static_cast<std::size_t>(v);
    auto to = static_cast<std::size_t>(offsets[cell]);
    AreaSum area;
    dual.add_cell(v, first, area, [&](std::int32_t t) { result.cells[to++] = t; });
    result.areas[cell] = area.total();
  });
  result.cell_offsets = offsets;
  dual.for_each_alone([&](std::size_t i, const std::vector<std::size_t>& different) {
    result.areas[i] = 4 * std::numbers::pi / static_cast<double>(different.size());
  });
  result.circumcentres = dual.take_centres();
  return result;
}

std::vector<double> centroids(call::Implementation& self, const call::CellInput& input) {
  const Triangulation& mesh = input.mesh;
  const SphereCoordinates coordinates = input.space.coordinates;
  host::Runtime& runtime = self.native().runtime;
  const Dual dual(runtime, mesh);
  const std::size_t width = width_of(coordinates);
  std::vector<double> result(mesh.places.size() / 2 * width, NAN);
  const auto fetch = [&](std::size_t v) { kernel::fetch(&mesh.places[2 * v]); };
  dual.stars().for_each(runtime, fetch, [&](std::int32_t v, std::int32_t first) {
    MomentSum sum;
    dual.add_cell(v, first, sum, [](std::int32_t) {});
    write_direction(sum.direction(direction_of(dual.place(v))), coordinates,
                    &result[width * static_cast<std::size_t>(v)]);
  });
  dual.for_each_alone([&](std::size_t i, const std::vector<std::size_t>& different) {
    if (different.size() != 2) return;
    const std::size_t other = different[0] + different[1] - i;
    write_direction(normalized(chord(place_at(mesh.places, other), place_at(mesh.places, i))), coordinates,
                    &result[width * i]);
  });
  return result;
}

}  // namespace flaunay::sphere
