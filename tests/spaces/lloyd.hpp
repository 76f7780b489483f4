// A step of Lloyd's method by brute force: each cell is cut by the borders with all other points.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "flaunay/sphere.hpp"
#include "tests/spaces/spaces.hpp"

namespace flaunay::testing::spaces {

/// Where points go, and how large their cells are; 0 for points that another one represents.
struct Lloyd {
  Numbers centroids;  ///< x and y per point, or on the sphere x, y and z
  Numbers sizes;
  double energy = 0;  ///< the integral of the squared distances to the nearest points, or of their powers
};

using Vector = std::array<double, 3>;
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The part of a convex polygon where 2 d p is at most the constant.
inline std::vector<Vector> cut(const std::vector<Vector>& polygon, const Vector& d, double constant) {
  std::vector<Vector> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vector p = polygon[k], q = polygon[(k + 1) % polygon.size()];
    const double at_p = constant - 2 * dot(d, p), at_q = constant - 2 * dot(d, q);
    if (at_p >= 0) kept.push_back(p);
    const double share = at_p / (at_p - at_q);
    if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0))
      kept.push_back({p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1]), 0});
  }
  return kept;
}

/// In the plane and on a torus, of points with weights or without. box: of the plane.
inline Lloyd lloyd_of_polygons(const TestSpace& space, const Numbers& points, const Triangulation& mesh,
                               const Numbers& box) {
  const std::size_t n = mesh.representatives.size();
  const bool is_torus = space.space.kind == SpaceKind::torus;
  const Period period = space.space.period;
  const auto place = [&](std::size_t i) {
    const double* const p = is_torus ? &mesh.places[2 * i] : &points[space.width * i];
    return Vector{p[0], p[1], 0};
  };
  const auto weight = [&](std::size_t i) { return space.has_weights ? points[space.width * i + 2] : 0; };
  // A cell is nearer to its point than a period, whatever the weights, as images of each point are all
  // around.
  const int images = is_torus ? 2 : 0;
  Lloyd all{Numbers(2 * n, std::nan("")), Numbers(n, 0.0)};
  for (std::size_t i = 0; i < n; ++i) {
    if (mesh.representatives[i] != static_cast<std::int32_t>(i)) continue;
    const Vector p = place(i);
    std::vector<Vector> polygon = {{-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}};
    for (std::size_t k = 0; k < 4 && !is_torus; ++k)
      polygon[k] = {box[2 * k] - p[0], box[2 * k + 1] - p[1], 0};
    for (std::size_t j = 0; j < n; ++j) {
      if (mesh.representatives[j] != static_cast<std::int32_t>(j)) continue;
      for (int across = -images; across <= images; ++across) {
        for (int up = -images; up <= images; ++up) {
          if (j == i && across == 0 && up == 0) continue;
          Vector d = {place(j)[0] - p[0], place(j)[1] - p[1], 0};
          if (is_torus) d = {d[0] + across * period.x + up * period.shear, d[1] + up * period.y, 0};
          polygon = cut(polygon, d, dot(d, d) + weight(i) - weight(j));
        }
      }
    }
    double area = 0, x = 0, y = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Vector u = polygon[k], v = polygon[(k + 1) % polygon.size()];
      const double part = cross(u, v)[2] / 2;
      area += part;
      x += part * (u[0] + v[0]) / 3;
      y += part * (u[1] + v[1]) / 3;
      all.energy += part * (dot(u, u) + dot(u, v) + dot(v, v)) / 6;
    }
    all.energy -= area * weight(i);
    all.sizes[i] = area;
    all.centroids[2 * i] = p[0] + x / area;
    all.centroids[2 * i + 1] = p[1] + y / area;
  }
  return all;
}

/// On the sphere: half of the sum, over the circles between a point and others, of the angle of the part that
/// is nearest to both, times the circle's normal, is the integral of the places of the cell.
inline Lloyd lloyd_on_sphere(const Triangulation& mesh) {
  const std::size_t n = mesh.representatives.size();
  const Numbers xyz = directions_of(mesh.places);
  const auto at = [&](std::size_t i) { return Vector{xyz[3 * i], xyz[3 * i + 1], xyz[3 * i + 2]}; };
  const auto minus = [](const Vector& a, const Vector& b) {
    return Vector{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  };
  const auto is_first = [&](std::size_t i) {
    return mesh.representatives[i] == static_cast<std::int32_t>(i);
  };
  Lloyd all{Numbers(3 * n, std::nan("")), Numbers(n, 0.0)};
  for (std::size_t i = 0; i < n; ++i) {
    Vector sum{};
    for (std::size_t j = 0; j < n; ++j) {
      if (!is_first(i) || !is_first(j) || i == j) continue;
      Vector normal = minus(at(i), at(j));
      const double length = std::sqrt(dot(normal, normal));
      for (double& x : normal) x /= length;
      // Angles on the circle are those from one place of it; that of any vector as seen from the axis.
      Vector first = cross(normal, std::fabs(normal[0]) < 0.6 ? Vector{1, 0, 0} : Vector{0, 1, 0});
      const double size = std::sqrt(dot(first, first));
      for (double& x : first) x /= size;
      const Vector second = cross(normal, first);
      // Each other point leaves half of the circle, of which [low, high] is the part that is left.
      double low = -std::numbers::pi, high = std::numbers::pi;
      bool is_whole = true;
      for (std::size_t k = 0; k < n; ++k) {
        if (!is_first(k) || k == i || k == j) continue;
        const Vector away = minus(at(i), at(k));
        const double middle = std::atan2(dot(away, second), dot(away, first));
        constexpr double kQuarter = std::numbers::pi / 2;
        if (is_whole) {
          low = middle - kQuarter;
          high = middle + kQuarter;
          is_whole = false;
          continue;
        }
        const double turned = std::remainder(middle - (low + high) / 2, 2 * std::numbers::pi);
        const double centre = (low + high) / 2 + turned;
        low = std::max(low, centre - kQuarter);
        high = std::min(high, centre + kQuarter);
      }
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += std::max(0.0, high - low) / 2 * normal[axis];
    }
    all.energy -= 2 * dot(at(i), sum);
    all.sizes[i] = std::sqrt(dot(sum, sum));
    for (std::size_t axis = 0; axis < 3; ++axis) all.centroids[3 * i + axis] = sum[axis] / all.sizes[i];
  }
  return all;
}

}  // namespace flaunay::testing::spaces
