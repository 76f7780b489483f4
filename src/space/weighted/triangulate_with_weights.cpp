// Triangulations of points with weights.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "arithmetic/coordinates.h"
#include "blocks/weighted.hpp"
#include "call/frame.hpp"
#include "flaunay/weighted.hpp"
#include "geometry/arguments.hpp"
#include "geometry/magnitudes.hpp"
#include "predicates/bounds.h"
#include "prove/arguments.hpp"
#include "prove/planar_proof.hpp"
#include "space/spaces.hpp"
#include "space/triangulate.hpp"
#include "space/weighted/cells.hpp"

namespace flaunay {
namespace {

using Ids = std::vector<std::int32_t>;

void check_hidden(const Ids& hidden, std::size_t n) {
  call::expect(are_indices(hidden, n) && std::is_sorted(hidden.begin(), hidden.end()),
               "the hidden points are not those of these points");
}

}  // namespace

void call::check_with_hidden(const double* points, const std::vector<std::size_t>& offsets,
                             const Triangulation& mesh) {
  prove::check_arrays(points, offsets, mesh);
  check_hidden(mesh.hidden, offsets.back());
  expect(mesh.neighbors.size() == mesh.triangles.size(), "the triangulation must have its neighbours");
}

namespace call {
namespace {

Triangulation triangulate_with_weights(Implementation& self, const HostPoints& points,
                                       const std::vector<std::size_t>& offsets, const Space& space,
                                       const Options& options) {
  const HostPoints given = checked_points(points.wide, nullptr, offsets);
  check_array(space.weights, given.count, "weights");
  Ids hidden;
  Triangulation mesh = triangulate(self, given, HostWeights{space.weights, &blocks::kWeightedSolver, hidden},
                                   offsets, options);
  mesh.hidden = std::move(hidden);
  return mesh;
}

void triangulate_with_weights(Implementation& self, const DevicePoints& points, DeviceTriangulation& result,
                              const Parts& parts, const Enqueue& enqueue) {
  const DeviceWeights with{points.weights, &blocks::kWeightedSolver, result.hidden, &result.hidden_count};
  triangulate(self, points, with, result, parts, enqueue);
}

std::string find_problem_with_weights(const double* points, const std::vector<std::size_t>& offsets,
                                      const Space& space, const Triangulation& mesh) {
  check_with_hidden(points, offsets, mesh);
  check_array(space.weights, offsets.back(), "weights");
  return prove::find_problem({points, space.weights, offsets, mesh, mesh.neighbors, mesh.hidden});
}

}  // namespace

const SpaceCalls kWithWeights{.triangulate = triangulate_with_weights,
                              .triangulate_on_device = triangulate_with_weights,
                              .find_problem = find_problem_with_weights,
                              .cells = weighted::make_cells};

}  // namespace call

Ids hiding_triangles(Triangulator& triangulator, const double* points,
                     const std::vector<std::size_t>& offsets, const Triangulation& mesh) {
  call::check_with_hidden(points, offsets, mesh);
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

}  // namespace flaunay
