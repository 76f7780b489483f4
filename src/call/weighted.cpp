// The public calls for weighted points.
#include "flaunay/weighted.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "arithmetic/coordinates.h"
#include "blocks/weighted.hpp"
#include "call/frame.hpp"
#include "call/periodic.hpp"
#include "call/triangulate.hpp"
#include "derived/voronoi/clip_polygon.hpp"
#include "derived/weighted/cells.hpp"
#include "flaunay/verify.hpp"
#include "geometry/arguments.hpp"
#include "geometry/magnitudes.hpp"
#include "predicates/bounds.h"
#include "prove/arguments.hpp"
#include "prove/periodic_proof.hpp"
#include "prove/planar_proof.hpp"

namespace flaunay {
namespace {

using Ids = std::vector<std::int32_t>;

void check_hidden(const Ids& hidden, std::size_t n) {
  call::expect(are_indices(hidden, n) && std::is_sorted(hidden.begin(), hidden.end()),
               "the hidden points are not those of these points");
}

void check(const double* points, const std::vector<std::size_t>& offsets, const WeightedTriangulation& mesh) {
  prove::check_arrays(points, offsets, mesh);
  check_hidden(mesh.hidden, offsets.back());
  call::expect(mesh.neighbors.size() == mesh.triangles.size(), "the triangulation must have its neighbours");
}

}  // namespace

WeightedTriangulation triangulate_weighted(Triangulator& triangulator, const double* points,
                                           const double* weights, std::size_t n, const Options& options) {
  return triangulate_weighted(triangulator, points, weights, std::vector<std::size_t>{0, n}, options);
}

WeightedTriangulation triangulate_weighted(Triangulator& triangulator, const double* points,
                                           const double* weights, const std::vector<std::size_t>& offsets,
                                           const Options& options) {
  call::Implementation& self = TriangulatorAccess::implementation(triangulator);
  return call::take_turn(self, [&] {
    const call::HostPoints given = call::checked_points(points, nullptr, offsets);
    check_array(weights, given.count, "weights");
    WeightedTriangulation mesh;
    const call::HostWeights with{weights, &blocks::kWeightedSolver, mesh.hidden};
    static_cast<Triangulation&>(mesh) = call::triangulate(self, given, with, offsets, options);
    return mesh;
  });
}

void triangulate_weighted(Triangulator& triangulator, const DevicePoints& points, cl_mem weights,
                          DeviceWeightedTriangulation& result, const Parts& parts, const Enqueue& enqueue) {
  call::Implementation& self = TriangulatorAccess::implementation(triangulator);
  call::take_turn(self, enqueue, [&] {
    const call::DeviceWeights with{weights, &blocks::kWeightedSolver, result.hidden, &result.hidden_count};
    result.hidden_count = 0;
    call::triangulate(self, points, with, result, parts, enqueue);
  });
}

Ids hiding_triangles(Triangulator& triangulator, const double* points,
                     const std::vector<std::size_t>& offsets, const WeightedTriangulation& mesh) {
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

ClippedVoronoi power_cells(Triangulator& triangulator, const double* points, const double* weights,
                           std::size_t n, const WeightedTriangulation& mesh, const double* corners,
                           std::size_t corner_count) {
  call::Implementation& self = TriangulatorAccess::implementation(triangulator);
  return call::take_turn(self, [&] {
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    check(points, {0, n}, mesh);
    check_array(weights, n, "weights");
    return weighted::make_cells(self.native().runtime, points, weights, n, mesh, polygon.corners);
  });
}

WeightedPeriodicTriangulation triangulate_periodic(Triangulator& triangulator, const double* points,
                                                   const double* weights, std::size_t n,
                                                   const Period& period) {
  return triangulate_periodic(triangulator, points, weights, std::vector<std::size_t>{0, n}, period);
}

WeightedPeriodicTriangulation triangulate_periodic(Triangulator& triangulator, const double* points,
                                                   const double* weights,
                                                   const std::vector<std::size_t>& offsets,
                                                   const Period& period) {
  WeightedPeriodicTriangulation mesh;
  const call::HostWeights with{weights, &blocks::kWeightedSolver, mesh.hidden};
  call::triangulate_periodic(triangulator, points, offsets, period, &with, mesh);
  return mesh;
}

void triangulate_periodic(Triangulator& triangulator, const DevicePoints& points, cl_mem weights,
                          const Period& period, DeviceWeightedPeriodicTriangulation& result,
                          const Enqueue& enqueue) {
  const call::DeviceWeights with{weights, &blocks::kWeightedSolver, result.hidden, &result.hidden_count};
  result.hidden_count = 0;
  call::triangulate_periodic(triangulator, points, period, &with, result, enqueue);
}

ClippedVoronoi periodic_cells(Triangulator& triangulator, const double* weights,
                              const WeightedPeriodicTriangulation& mesh) {
  check_array(weights, mesh.representatives.size(), "weights");
  return call::periodic_cells(triangulator, weights, mesh);
}

std::string verify(const double* weights, const WeightedPeriodicTriangulation& mesh) {
  call::check(mesh);
  check_array(weights, mesh.representatives.size(), "weights");
  check_hidden(mesh.hidden, mesh.representatives.size());
  return prove::find_problem(mesh, weights, mesh.hidden);
}

std::string verify(const double* points, const double* weights, const std::vector<std::size_t>& offsets,
                   const WeightedTriangulation& mesh) {
  check(points, offsets, mesh);
  check_array(weights, offsets.back(), "weights");
  return prove::find_problem({points, weights, offsets, mesh, mesh.neighbors, mesh.hidden});
}

}  // namespace flaunay
