// The public calls for points on a torus or a cylinder.
#include "call/periodic.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "call/frame.hpp"
#include "derived/periodic/cells.hpp"
#include "derived/periodic/torus.hpp"
#include "flaunay/verify.hpp"
#include "geometry/arguments.hpp"
#include "prove/periodic_proof.hpp"

namespace flaunay {

void call::check(const Period& period) {
  const auto is_length = [](double x) { return (x >= 0x1p-900 && x <= 0x1p900) || x == HUGE_VAL; };
  expect(is_length(period.x) && is_length(period.y) && std::min(period.x, period.y) < HUGE_VAL,
         fmt::format("the period {} x {} is not possible: both must be from 2^-900 to 2^900 (about 1.2e-271 "
                     "to 8.4e270), or "
                     "one of them infinite; scale points and period",
                     period.x, period.y));
  constexpr double kMostUnequal = 1 << 30;
  expect(
      std::max(period.x, period.y) <= kMostUnequal * std::min(period.x, period.y) || std::isinf(period.x) ||
          std::isinf(period.y),
      fmt::format("the period {} x {} is not possible: one is more than 2^30 times as long as the other one",
                  period.x, period.y));
}

void call::check(const PeriodicTriangulation& mesh) {
  check(mesh.period);
  const std::size_t n = mesh.representatives.size(), triangles = mesh.triangles.size() / 3;
  expect(mesh.places.size() == 2 * n && mesh.triangles.size() == 3 * triangles &&
             mesh.offsets.size() == 6 * triangles && mesh.neighbors.size() == 3 * triangles &&
             !mesh.point_offsets.empty() &&
             are_offsets(mesh.point_offsets, mesh.point_offsets.size() - 1, n) &&
             are_offsets(mesh.triangle_offsets, mesh.point_offsets.size() - 1, triangles) &&
             are_indices(mesh.triangles, n) && are_indices(mesh.neighbors, triangles, -1),
         "the arrays are not those of a triangulation on a torus or a cylinder");
}

void call::check_with_places(const PeriodicTriangulation& mesh) {
  check(mesh);
  const kernel::periodic_axes axes = periodic::axes_of({mesh.period.x, mesh.period.y});
  const auto is_place = [](double x, const auto& axis) {
    return std::isfinite(x) && kernel::place_of(x, axis) == x;
  };
  for (std::size_t i = 0; i < mesh.representatives.size(); ++i) {
    const double x = mesh.places[2 * i], y = mesh.places[2 * i + 1];
    if (is_place(x, axes.x) && is_place(y, axes.y)) continue;
    throw Error(
        ErrorKind::usage,
        fmt::format("place {} of the triangulation on a torus or a cylinder is none: ({}, {})", i, x, y));
  }
}

namespace {

using Ids = std::vector<std::int32_t>;
using periodic::Pair;
using periodic::Unrolled;

// Sets that are triangulated together.
struct Round {
  std::vector<std::size_t> sets;
  std::vector<Unrolled> planes;
  std::vector<double> coordinates;  // of all, if there are several
  std::vector<std::size_t> offsets{0};

  void count_points() {
    for (const Unrolled& plane : planes) offsets.push_back(offsets.back() + plane.points() + plane.images());
  }
  const double* all_coordinates() {
    if (planes.size() == 1) return planes[0].coordinates().data();
    coordinates.reserve(2 * offsets.back());
    for (const Unrolled& plane : planes)
      coordinates.insert(coordinates.end(), plane.coordinates().begin(), plane.coordinates().end());
    return coordinates.data();
  }
};

// The triangles of the k-th set of a round, and the representatives of its points, numbered from 0.
periodic::Triangles triangles_of(Triangulation& planar, const Round& round, std::size_t k) {
  if (round.sets.size() == 1) return {std::move(planar.triangles), std::move(planar.neighbors), {}};
  const auto part = [&](const Ids& all, std::size_t first) {
    Ids some(all.begin() + static_cast<std::ptrdiff_t>(3 * planar.triangle_offsets[k]),
             all.begin() + static_cast<std::ptrdiff_t>(3 * planar.triangle_offsets[k + 1]));
    for (std::int32_t& i : some) {
      if (i >= 0) i -= static_cast<std::int32_t>(first);
    }
    return some;
  };
  return {part(planar.triangles, round.offsets[k]), part(planar.neighbors, planar.triangle_offsets[k]), {}};
}
Ids representatives_of(const Triangulation& planar, const Round& round, std::size_t k) {
  const auto first = planar.representatives.begin() + static_cast<std::ptrdiff_t>(round.offsets[k]);
  Ids some(first, first + static_cast<std::ptrdiff_t>(round.planes[k].points()));
  for (std::int32_t& i : some) i -= static_cast<std::int32_t>(round.offsets[k]);
  return some;
}

void append(Ids& to, Ids&& more, std::size_t first) {
  if (to.empty() && first == 0) {
    to = std::move(more);
    return;
  }
  const auto shift = static_cast<std::int32_t>(first);
  for (std::int32_t& i : more) {
    if (i >= 0) i += shift;
  }
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

PeriodicTriangulation triangulate_periodic(Triangulator& triangulator, const double* points, std::size_t n,
                                           const Period& period) {
  return triangulate_periodic(triangulator, points, std::vector<std::size_t>{0, n}, period);
}

PeriodicTriangulation triangulate_periodic(Triangulator& triangulator, const double* points,
                                           const std::vector<std::size_t>& offsets, const Period& period) {
  check_offsets(offsets);
  call::check(period);
  const std::size_t n = offsets.back(), sets = offsets.size() - 1;
  check_points(points, n);
  call::Implementation& self = TriangulatorAccess::implementation(triangulator);
  // Calls work(k, runtime): several sets side by side, or one on all threads.
  const auto for_each_set = [&](std::size_t count, const auto& work) {
    call::take_turn(self, [&] {
      host::Runtime& runtime = self.native().runtime;
      if (count == 1) {
        work(0, &runtime);
      } else {
        runtime.share(count, [&](std::size_t k) { work(k, nullptr); });
      }
    });
  };
  const Pair<double> lengths = periodic::rounded(period);
  PeriodicTriangulation mesh;
  mesh.period = {lengths[0], lengths[1]};
  mesh.places = call::take_turn(
      self, [&] { return periodic::to_places(self.native().runtime, points, n, lengths, "point"); });
  mesh.point_offsets = offsets;
  std::vector<periodic::Box> boxes(sets);
  std::vector<periodic::Triangles> done(sets);
  std::vector<Ids> representatives(sets);
  std::vector<std::size_t> waiting;
  for (std::size_t s = 0; s < sets; ++s) {
    if (offsets[s] == offsets[s + 1]) continue;
    boxes[s] = periodic::box_of(mesh.places, offsets[s], offsets[s + 1], lengths);
    boxes[s].margin = periodic::first_margin(boxes[s], offsets[s + 1] - offsets[s]);
    waiting.push_back(s);
  }
  // Those of a set alone are not copied.
  const auto places_of = [&](std::size_t s) {
    if (sets == 1) return std::move(mesh.places);
    return std::vector<double>(mesh.places.begin() + static_cast<std::ptrdiff_t>(2 * offsets[s]),
                               mesh.places.begin() + static_cast<std::ptrdiff_t>(2 * offsets[s + 1]));
  };
  while (!waiting.empty()) {
    Round round;
    round.sets = std::move(waiting);
    waiting.clear();
    round.planes.resize(round.sets.size());
    for_each_set(round.sets.size(), [&](std::size_t k, host::Runtime* runtime) {
      const std::size_t s = round.sets[k];
      round.planes[k] = Unrolled(runtime, places_of(s), boxes[s]);
    });
    round.count_points();
    periodic::check_size(round.offsets.back());
    Triangulation planar = triangulator.triangulate(round.all_coordinates(), round.offsets);
    std::vector<char> is_done(round.sets.size());
    for_each_set(round.sets.size(), [&](std::size_t k, host::Runtime* runtime) {
      const std::size_t s = round.sets[k];
      representatives[s] = representatives_of(planar, round, k);
      done[s] = triangles_of(planar, round, k);
      is_done[k] = periodic::fold(runtime, round.planes[k], representatives[s], done[s]);
    });
    if (sets == 1) mesh.places = round.planes[0].take_places();
    for (std::size_t k = 0; k < round.sets.size(); ++k) {
      const std::size_t s = round.sets[k];
      mesh.images += round.planes[k].images();
      if (is_done[k] != 0) continue;
      periodic::widen(boxes[s], s);
      waiting.push_back(s);
    }
    mesh.statistics = std::move(planar.statistics);
  }
  mesh.triangle_offsets = {0};
  for (std::size_t s = 0; s < sets; ++s) {
    append(mesh.representatives, std::move(representatives[s]), offsets[s]);
    append(mesh.triangles, std::move(done[s].corners), offsets[s]);
    append(mesh.neighbors, std::move(done[s].neighbors), mesh.triangle_offsets.back());
    if (mesh.offsets.empty()) {
      mesh.offsets = std::move(done[s].offsets);
    } else {
      mesh.offsets.insert(mesh.offsets.end(), done[s].offsets.begin(), done[s].offsets.end());
    }
    mesh.triangle_offsets.push_back(mesh.triangles.size() / 3);
  }
  return mesh;
}

ClippedVoronoi periodic_cells(Triangulator& triangulator, const PeriodicTriangulation& mesh) {
  call::Implementation& self = TriangulatorAccess::implementation(triangulator);
  return call::take_turn(self, [&] {
    call::check_with_places(mesh);
    call::expect(std::isfinite(mesh.period.x) && std::isfinite(mesh.period.y),
                 "cells on a cylinder have no end");
    return periodic::make_cells(self.native().runtime, mesh);
  });
}

std::string verify(const PeriodicTriangulation& mesh) {
  call::check(mesh);
  return prove::find_problem(mesh);
}

}  // namespace flaunay
