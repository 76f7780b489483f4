// The public calls for points on a torus.
#include "flaunay/periodic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "call/frame.hpp"
#include "derived/periodic/torus.hpp"

namespace flaunay {
namespace {

using Ids = std::vector<std::int32_t>;
using periodic::Selected;
using periodic::Unrolled;

void check(const Period& period) {
  const auto is_length = [](double x) { return x >= 0x1p-900 && x <= 0x1p900; };
  if (!is_length(period.x) || !is_length(period.y)) {
    throw Error(ErrorKind::usage,
                fmt::format("the period {} x {} is none: both must be positive, and neither tiny nor huge",
                            period.x, period.y));
  }
  constexpr double kMostUnequal = 1 << 30;
  call::expect(std::max(period.x, period.y) <= kMostUnequal * std::min(period.x, period.y),
               "one period is more than 2^30 times as long as the other one");
}

// Of a set in the plane, whose points come before their images; returns the number of different points.
std::size_t read_representatives(const Triangulation& planar, std::size_t plane_first, std::size_t first,
                                 std::size_t last, Ids& representatives) {
  std::size_t different = 0;
  for (std::size_t i = first; i < last; ++i) {
    const auto place =
        static_cast<std::size_t>(planar.representatives[plane_first + (i - first)]) - plane_first;
    representatives[i] = static_cast<std::int32_t>(first + place);
    different += first + place == i;
  }
  return different;
}

// The sets that are not done yet, triangulated together.
struct Round {
  std::vector<std::size_t> sets;
  std::vector<Unrolled> planes;
  std::vector<double> coordinates;  // of all, if there are several
  std::vector<std::size_t> offsets{0};
};

void append(Selected& found, PeriodicTriangulation& mesh) {
  if (mesh.triangles.empty()) {
    mesh.triangles = std::move(found.triangles);
    mesh.offsets = std::move(found.offsets);
    mesh.neighbors = std::move(found.neighbors);
    mesh.triangle_offsets.push_back(mesh.triangles.size() / 3);
    return;
  }
  const auto shift = static_cast<std::int32_t>(mesh.triangles.size() / 3);
  mesh.triangles.insert(mesh.triangles.end(), found.triangles.begin(), found.triangles.end());
  mesh.offsets.insert(mesh.offsets.end(), found.offsets.begin(), found.offsets.end());
  for (const std::int32_t t : found.neighbors) mesh.neighbors.push_back(t + shift);
  mesh.triangle_offsets.push_back(mesh.triangles.size() / 3);
}

}  // namespace

PeriodicTriangulation triangulate_periodic(Triangulator& triangulator, const double* points, std::size_t n,
                                           const Period& period) {
  return triangulate_periodic(triangulator, points, std::vector<std::size_t>{0, n}, period);
}

PeriodicTriangulation triangulate_periodic(Triangulator& triangulator, const double* points,
                                           const std::vector<std::size_t>& offsets, const Period& period) {
  check(period);
  geometry::check_offsets(offsets);
  const std::size_t n = offsets.back(), sets = offsets.size() - 1;
  call::expect(n == 0 || points != nullptr, "points, but no coordinates: the pointer is null");
  PeriodicTriangulation mesh;
  mesh.places.resize(2 * n);
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(points[2 * i]) || !std::isfinite(points[2 * i + 1])) {
      throw Error(ErrorKind::input, fmt::format("point {} is not finite", i));
    }
    mesh.places[2 * i] = periodic::wrapped(points[2 * i], period.x);
    mesh.places[2 * i + 1] = periodic::wrapped(points[2 * i + 1], period.y);
  }
  mesh.point_offsets = offsets;
  mesh.representatives.resize(n);
  const double widest = std::min(period.x, period.y) / 2;
  std::vector<double> margins(sets);
  std::vector<Selected> done(sets);
  Round round;
  for (std::size_t s = 0; s < sets; ++s) {
    margins[s] = periodic::first_margin(offsets[s + 1] - offsets[s], period);
    if (offsets[s] < offsets[s + 1]) round.sets.push_back(s);
  }
  while (!round.sets.empty()) {
    Round next;
    for (const std::size_t s : round.sets) {
      round.planes.push_back(periodic::unroll(mesh.places, offsets[s], offsets[s + 1], period, margins[s]));
      const std::vector<double>& more = round.planes.back().coordinates;
      if (round.sets.size() > 1) round.coordinates.insert(round.coordinates.end(), more.begin(), more.end());
      round.offsets.push_back(round.offsets.back() + more.size() / 2);
      mesh.images += round.planes.back().points.size() - round.planes.back().originals;
    }
    Triangulation planar = triangulator.triangulate(
        round.sets.size() > 1 ? round.coordinates.data() : round.planes[0].coordinates.data(), round.offsets);
    for (std::size_t k = 0; k < round.sets.size(); ++k) {
      const std::size_t s = round.sets[k];
      const std::size_t different =
          read_representatives(planar, round.offsets[k], offsets[s], offsets[s + 1], mesh.representatives);
      done[s] = periodic::select(round.planes[k], planar, k, round.offsets[k], margins[s], different);
      if (done[s].is_complete) continue;
      if (margins[s] >= widest) {
        throw Error(
            ErrorKind::input,
            fmt::format(
                "the {} different points of set {} leave an empty circle of half the period {} or more: "
                "repeat them, in a period that is a multiple of this one",
                different, s, 2 * widest));
      }
      constexpr double kWider = 4;
      margins[s] = std::min(kWider * margins[s], widest);
      next.sets.push_back(s);
    }
    mesh.statistics = std::move(planar.statistics);
    round = std::move(next);
  }
  mesh.triangle_offsets = {0};
  for (Selected& found : done) append(found, mesh);
  return mesh;
}

std::vector<double> periodic_cell_areas(const PeriodicTriangulation& mesh, const Period& period) {
  check(period);
  const std::size_t n = mesh.places.size() / 2;
  call::expect(mesh.offsets.size() == 2 * mesh.triangles.size() && mesh.places.size() == 2 * n &&
                   std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                               [&](std::int32_t v) { return v >= 0 && static_cast<std::size_t>(v) < n; }),
               "the arrays are not those of a triangulation on a torus");
  std::vector<double> areas(n, 0);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 3) {
    // Of each corner the quarters that the heights from the triangle's centre cut off: signed, and summed
    // around a point its cell.
    double x[3], y[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(mesh.triangles[t + k]);
      x[k] = mesh.places[2 * v] + mesh.offsets[2 * (t + k)] * period.x;
      y[k] = mesh.places[2 * v + 1] + mesh.offsets[2 * (t + k) + 1] * period.y;
    }
    const double twice = (x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      const double ax = x[a] - x[k], ay = y[a] - y[k], bx = x[b] - x[k], by = y[b] - y[k];
      const double cotangent = (ax * bx + ay * by) / twice;  // of the angle at k
      const double quarter = cotangent * ((x[a] - x[b]) * (x[a] - x[b]) + (y[a] - y[b]) * (y[a] - y[b])) / 8;
      areas[static_cast<std::size_t>(mesh.triangles[t + a])] += quarter;
      areas[static_cast<std::size_t>(mesh.triangles[t + b])] += quarter;
    }
  }
  return areas;
}

}  // namespace flaunay
