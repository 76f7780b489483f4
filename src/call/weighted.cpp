// Triangulations of points with weights, and their power cells.
#include "flaunay/weighted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "arithmetic/coordinates.h"
#include "blocks/weighted.hpp"
#include "call/frame.hpp"
#include "call/spaces.hpp"
#include "call/triangulate.hpp"
#include "derived/voronoi/clip_polygon.hpp"
#include "derived/weighted/cells.hpp"
#include "geometry/arguments.hpp"
#include "geometry/magnitudes.hpp"
#include "predicates/bounds.h"
#include "prove/arguments.hpp"
#include "prove/planar_proof.hpp"

namespace flaunay {
namespace {

using Ids = std::vector<std::int32_t>;

// Lifts are made of squares of coordinates and of weights.
constexpr int kLargestExponent = 2 * kernel::LARGEST_EXPONENT, kLowestExponent = 2 * kernel::LOWEST_EXPONENT;

// Whether a scaled weight has bits that no square of a coordinate has.
bool is_too_fine(double scaled) {
  constexpr int kBits = 53;
  return std::fabs(scaled) < std::ldexp(1.0, kLowestExponent + kBits) &&
         geometry::lowest_bit(scaled) < kLowestExponent;
}

// Scales a weight as the squares of its point's coordinates are, which is exact.
double scaled_weight(double weight, std::size_t point, const kernel::scaling& scale) {
  const double scaled = kernel::scaled(kernel::scaled(weight, scale), scale);
  const bool is_large = !(std::fabs(scaled) < std::ldexp(1.0, kLargestExponent + 1));
  if (!is_large && (weight == 0 || (scaled != 0 && !is_too_fine(scaled)))) return scaled;
  if (!std::isfinite(weight)) {
    throw Error(ErrorKind::input, fmt::format("point {} has a weight that is not finite: {}", point, weight));
  }
  throw Error(
      ErrorKind::input,
      fmt::format("point {} has a weight, {}, that is too {} beside the squares of the coordinates for "
                  "exact arithmetic: scale the weights",
                  point, weight, is_large ? "large" : "fine"));
}

// Makes of representatives what Triangulation says of them, and lists all hidden points.
void settle(const double* points, const double* weights, const std::vector<std::size_t>& offsets,
            Triangulation& mesh) {
  const auto key = [&](std::int32_t i) { return std::tuple(points[2 * i], points[2 * i + 1], weights[i]); };
  const std::ptrdiff_t others = std::ssize(mesh.hidden);
  Ids lighter;  // those in the places of heavier ones, side by side if they are equal
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    lighter.clear();
    for (std::size_t i = offsets[s]; i < offsets[s + 1]; ++i) {
      if (mesh.representatives[i] < 0) lighter.push_back(static_cast<std::int32_t>(i));
    }
    std::sort(lighter.begin(), lighter.end(),
              [&](std::int32_t a, std::int32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
    for (std::size_t k = 0; k < lighter.size(); ++k) {
      const bool is_new = k == 0 || key(lighter[k - 1]) != key(lighter[k]);
      if (is_new) mesh.hidden.push_back(lighter[k]);
      mesh.representatives[static_cast<std::size_t>(lighter[k])] = mesh.hidden.back();
    }
  }
  std::sort(mesh.hidden.begin() + others, mesh.hidden.end());
  std::inplace_merge(mesh.hidden.begin(), mesh.hidden.begin() + others, mesh.hidden.end());
  mesh.statistics.duplicates = 0;
  for (std::size_t i = 0; i < mesh.representatives.size(); ++i) {
    mesh.statistics.duplicates += mesh.representatives[i] != static_cast<std::int32_t>(i);
  }
}

void check(const double* points, const std::vector<std::size_t>& offsets, const Triangulation& mesh) {
  prove::check_arrays(points, offsets, mesh);
  call::expect(
      are_indices(mesh.hidden, offsets.back()) && std::is_sorted(mesh.hidden.begin(), mesh.hidden.end()),
      "the hidden points are not those of these points");
  call::expect(mesh.neighbors.size() == mesh.triangles.size(), "the triangulation must have its neighbours");
}

}  // namespace

Triangulation call::triangulate_with_weights(Implementation& self, const HostPoints& points,
                                             const double* weights, const std::vector<std::size_t>& offsets,
                                             const Options& options) {
  const HostPoints given = checked_points(points.wide, nullptr, offsets);
  check_array(weights, given.count, "weights");
  self.native().check_size(given.count);
  const geometry::SetScalings scalings = geometry::set_scalings(
      points.wide, offsets,
      [&](std::size_t first, std::size_t last) { return geometry::inspect(points.wide, first, last); });
  Ids hidden;
  ScaledWeights scaled{std::vector<double>(given.count), 0, &blocks::kWeightedSolver, hidden};
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    const kernel::scaling scale = kernel::scale_of(scalings.shift(s));
    for (std::size_t i = offsets[s]; i < offsets[s + 1]; ++i) {
      scaled.values[i] = scaled_weight(weights[i], i, scale);
      least = std::min(least, scaled.values[i]);
      most = std::max(most, scaled.values[i]);
    }
  }
  if (given.count > 0) scaled.range = most - least;
  Triangulation mesh = triangulate_weighted(self.native(), given, scaled, offsets, options);
  mesh.hidden = std::move(hidden);
  settle(points.wide, weights, offsets, mesh);
  return mesh;
}

Ids hiding_triangles(Triangulator& triangulator, const double* points,
                     const std::vector<std::size_t>& offsets, const Triangulation& mesh) {
  check(points, offsets, mesh);
  if (mesh.hidden.empty() || mesh.triangles.empty()) return Ids(mesh.hidden.size(), -1);
  const weighted::Visible visible = weighted::visible_points(points, offsets, mesh);
  Locator locator(triangulator, visible.coordinates.data(), visible.offsets, visible.mesh);
  std::vector<double> queries;
  queries.reserve(2 * mesh.hidden.size());
  for (const std::int32_t i : mesh.hidden) queries.insert(queries.end(), {points[2 * i], points[2 * i + 1]});
  std::vector<std::size_t> of_sets;
  for (const std::size_t offset : offsets) {
    of_sets.push_back(static_cast<std::size_t>(
        std::lower_bound(mesh.hidden.begin(), mesh.hidden.end(), static_cast<std::int64_t>(offset)) -
        mesh.hidden.begin()));
  }
  return locator.locate(queries.data(), of_sets);
}

ClippedVoronoi Triangulator::clipped_voronoi(const double* coordinates, const double* weights, std::size_t n,
                                             const Triangulation& mesh, const double* corners,
                                             std::size_t corner_count) {
  return call::take_turn(*implementation_, [&] {
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    check(coordinates, {0, n}, mesh);
    check_array(weights, n, "weights");
    return weighted::make_cells(implementation_->native().runtime, coordinates, weights, n, mesh,
                                polygon.corners);
  });
}

std::string call::problem_with_weights(const double* points, const double* weights,
                                       const std::vector<std::size_t>& offsets, const Triangulation& mesh) {
  check(points, offsets, mesh);
  check_array(weights, offsets.back(), "weights");
  return prove::find_problem({points, weights, offsets, mesh, mesh.neighbors, mesh.hidden});
}

}  // namespace flaunay
