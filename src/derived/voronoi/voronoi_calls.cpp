// The public calls for Voronoi diagrams, clipped cells, and Lloyd's relaxation, in all spaces.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include "blocks/memory.hpp"
#include "blocks/run.hpp"
#include "call/mesh_of.hpp"
#include "derived/voronoi/clip.hpp"
#include "derived/voronoi/voronoi.hpp"
#include "mesh/rows.hpp"
#include "space/spaces.hpp"
#include "space/triangulate.hpp"

namespace flaunay {
namespace {

constexpr const char* kNeedsWeights =
    "cells of points with weights are power cells, of clipped_voronoi in host memory, which needs the "
    "weights";

template <typename Points, typename Mesh, typename Result>
void compute(call::Frame& call, const Points& points, const Mesh& triangulation, Result& result) {
  call.check_size(points.count);
  points::DeviceMesh mesh = call::mesh_with_sets(call, points, triangulation);
  call::expect(!call::has_weights(triangulation), kNeedsWeights);
  const std::size_t triangles = mesh.triangle_count();
  const voronoi::Buffers buffers{call.out<cl_double>(result.circumcentres, 2 * triangles, "circumcentres"),
                                 call.out<cl_int>(result.cell_offsets, points.count + 1, "cell offsets"),
                                 call.out<cl_int>(result.cells, 3 * triangles, "cells"),
                                 call.out<cl_uchar>(result.unbounded, points.count, "unbounded cells")};
  call.check_distinct();
  mesh.coordinates = call.points(points);
  voronoi::compute(call.runtime, mesh, buffers);
  call.end();
}

void check_has_places(const Triangulation& mesh) {
  call::expect(mesh.space.kind != SpaceKind::plane, "cells in the plane need the coordinates of the points");
}

}  // namespace

Voronoi call::dual_in_plane(Implementation& self, const CellInput& input) {
  Voronoi result;
  Frame call(self.with_doubles(self.for_host_memory()));
  compute(call, input.points, input.mesh, result);
  return result;
}

Voronoi Triangulator::voronoi(const double* coordinates, std::size_t n, const Triangulation& mesh) {
  return call::take_turn(*implementation_, [&] {
    const call::SpaceCalls& calls = call::calls_in(mesh.space.kind, false);
    call::expect(calls.dual != nullptr, "the Voronoi cells of this space come from clipped_voronoi");
    return calls.dual(*implementation_, {{coordinates, nullptr, n}, mesh.space, mesh, {}});
  });
}

Voronoi Triangulator::voronoi(const Triangulation& mesh) {
  check_has_places(mesh);
  return voronoi(nullptr, 0, mesh);
}

void Triangulator::voronoi(const DevicePoints& points, const DeviceTriangulation& triangulation,
                           DeviceVoronoi& result, const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    call::Frame call(*implementation_, call::with_doubles(*implementation_, implementation_->on_device()),
                     enqueue);
    call.check(points, "points");
    call.begin();
    compute(call, points, triangulation, result);
  });
}

// ---- Clipped cells

namespace {

// set_count: takes the number of vertices.
template <typename Points, typename Mesh, typename Result, typename SetCount>
void compute_clipped(call::Frame& call, const Points& points, const Mesh& triangulation,
                     const voronoi::ClipPolygon& polygon, Result& result, const SetCount& set_count) {
  const std::size_t n = points.count;
  call.check_size(n);
  points::DeviceMesh mesh = call::mesh_with_sets(call, points, triangulation);
  call::expect(!call::has_weights(triangulation), kNeedsWeights);
  const voronoi::ClippedBuffers buffers{call.out<cl_int>(result.offsets, n + 1, "cell offsets"),
                                        call.out<cl_double>(result.areas, n, "areas"),
                                        call.out<cl_double>(result.centroids, 2 * n, "centroids")};
  mesh.coordinates = call.points(points);
  host::Buffer<cl_double> vertices;
  std::size_t count = 0;
  voronoi::compute_clipped(call.runtime, mesh, polygon, buffers, [&](std::size_t found) {
    count = found;
    vertices = call.out<cl_double>(result.vertices, 2 * count, "vertices");
    call.check_distinct();
    return vertices;
  });
  count = voronoi::mend_clipped(call.runtime, mesh, polygon, buffers.offsets, vertices, count);
  call.end();
  set_count(count);
}

// The polygon to which cells are clipped; empty in spaces that have none.
voronoi::ClipPolygon polygon_in(const call::SpaceCalls& calls, const double* corners,
                                std::size_t corner_count) {
  if (calls.refusal_of_polygons == nullptr) return voronoi::checked_polygon(corners, corner_count);
  call::expect(corners == nullptr && corner_count == 0, calls.refusal_of_polygons);
  return {};
}

}  // namespace

ClippedVoronoi call::cells_in_plane(Implementation& self, const CellInput& input) {
  ClippedVoronoi result;
  Frame call(self.with_doubles(self.for_host_memory()));
  compute_clipped(call, input.points, input.mesh, input.polygon, result,
                  [&result](std::size_t vertices) { result.vertices.resize(2 * vertices); });
  return result;
}

ClippedVoronoi Triangulator::clipped_voronoi(const double* coordinates, std::size_t n,
                                             const Triangulation& mesh, const double* corners,
                                             std::size_t corner_count) {
  return clipped_voronoi(coordinates, nullptr, n, mesh, corners, corner_count);
}

ClippedVoronoi Triangulator::clipped_voronoi(const double* coordinates, const double* weights, std::size_t n,
                                             const Triangulation& mesh, const double* corners,
                                             std::size_t corner_count) {
  return call::take_turn(*implementation_, [&] {
    const call::SpaceCalls& calls = call::calls_in(mesh.space.kind, weights != nullptr);
    call::expect(calls.cells != nullptr, "the Voronoi cells of this space come from voronoi");
    return calls.cells(*implementation_, {{coordinates, nullptr, n},
                                          mesh.space.with_weights(weights),
                                          mesh,
                                          polygon_in(calls, corners, corner_count)});
  });
}

ClippedVoronoi Triangulator::clipped_voronoi(const Triangulation& mesh, const double* weights) {
  check_has_places(mesh);
  return clipped_voronoi(nullptr, weights, 0, mesh, nullptr, 0);
}

void Triangulator::clipped_voronoi(const DevicePoints& points, const DeviceTriangulation& triangulation,
                                   const double* corners, std::size_t corner_count,
                                   DeviceClippedVoronoi& result, const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    call::Frame call(*implementation_, call::with_doubles(*implementation_, implementation_->on_device()),
                     enqueue);
    call.check(points, "points");
    call.begin();
    compute_clipped(call, points, triangulation, polygon, result,
                    [&result](std::size_t vertices) { result.vertex_count = vertices; });
  });
}

// ---- Relaxation: triangulate, clip cells, move points to centroids, again. Points, triangles and cells stay
// where kernels run.

namespace {

// Moves the points in this buffer. Everything else comes from the engine's arenas; its own, since the
// caller's workspace has room for a triangulation alone.
void relax_points(call::Engine& engine, const host::Buffer<cl_double>& points, std::size_t n,
                  const voronoi::ClipPolygon& polygon, std::size_t iterations) {
  if (n == 0) return;
  host::Runtime& runtime = engine.runtime;
  engine.persistent.reserve(blocks::workspace_bytes(runtime, n, 1).persistent);
  host::Arena::Scope kept(engine.even);
  const voronoi::ClippedBuffers cells{engine.even.allocate<cl_int>(n + 1), engine.even.allocate<cl_double>(n),
                                      engine.even.allocate<cl_double>(2 * n)};
  for (std::size_t i = 0; i < iterations; ++i) {
    host::Arena::Scope mesh_scope(engine.even);
    const points::DeviceMesh mesh = [&] {
      host::Arena::Scope scope(engine.persistent), scratch_scope(runtime.arena());
      return blocks::run(runtime, engine.persistent, {0, n}, points, engine.even);
    }();
    voronoi::compute_clipped(runtime, mesh, polygon, cells, [&](std::size_t vertices) {
      return runtime.arena().allocate<cl_double>(2 * vertices);
    });
    voronoi::move_to_centroids(runtime, n, cells, points);
  }
}

template <typename Points, typename Result>
void relax_in(call::Frame& call, const Points& points, const voronoi::ClipPolygon& polygon,
              std::size_t iterations, Result& result) {
  const std::size_t n = points.count;
  call.check_size(n);
  const auto relaxed = call.out<cl_double>(result, 2 * n, "relaxed points");
  call.check_distinct();
  {
    host::Arena::Scope scope(call.runtime.arena());
    call.runtime.copy(call.points(points), 0, relaxed, 0, 2 * n);
  }
  relax_points(call.engine, relaxed, n, polygon, iterations);
  call.end();
}

}  // namespace

std::vector<double> Triangulator::relax(const double* coordinates, std::size_t n, const double* corners,
                                        std::size_t corner_count, std::size_t iterations) {
  return call::take_turn(*implementation_, [&] {
    check_points(coordinates, n);
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    std::vector<double> relaxed;
    call::Frame call(implementation_->with_doubles(implementation_->for_host_memory()));
    relax_in(call, call::HostPoints{coordinates, nullptr, n}, polygon, iterations, relaxed);
    return relaxed;
  });
}

namespace {

// The numbers of points in an order that their places and weights alone decide; equal ones in their own.
std::vector<std::int32_t> order_of(const std::vector<double>& places, const double* weights) {
  std::vector<std::int32_t> order(places.size() / 2);
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::int32_t i) {
    const auto at = static_cast<std::size_t>(i);
    // The bits, which are in an order even if a number is NaN. There is no -0.
    const auto bits = [](double x) { return kernel::as_ulong(x + 0.0); };
    return std::tuple{bits(places[2 * at]), bits(places[2 * at + 1]),
                      weights == nullptr ? 0 : bits(weights[at])};
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::int32_t a, std::int32_t b) { return key(a) < key(b); });
  return order;
}

}  // namespace

std::vector<double> Triangulator::relax(const double* points, std::size_t n, const Space& space,
                                        std::size_t iterations, const double* corners,
                                        std::size_t corner_count) {
  if (space.kind == SpaceKind::plane && space.weights == nullptr)
    return relax(points, n, corners, corner_count, iterations);
  return call::take_turn(*implementation_, [&] {
    call::Implementation& self = *implementation_;
    const call::SpaceCalls& calls = call::calls_in(space.kind, space.weights != nullptr);
    check_points(points, n);
    const voronoi::ClipPolygon polygon = polygon_in(calls, corners, corner_count);
    if (calls.check_cells != nullptr) calls.check_cells(space);
    const std::size_t width = calls.width(space);
    std::vector<double> relaxed(points, points + width * n), sorted(width * n),
        weights(space.weights == nullptr ? 0 : n);
    const Space in_order = space.with_weights(space.weights == nullptr ? nullptr : weights.data());
    const auto triangulated = [&](const std::vector<double>& coordinates, const Space& given) {
      return calls.triangulate(self, {coordinates.data(), nullptr, n}, {0, n}, given, {});
    };
    for (std::size_t k = 0;; ++k) {
      std::vector<double> places =
          calls.places == nullptr ? relaxed
                                  : calls.places(self.native().runtime, relaxed.data(), n, space, "point");
      if (k == iterations) return calls.returns_places ? std::move(places) : std::move(relaxed);
      // In another order, rows of triangles and sums along them would be in another one, too.
      const std::vector<std::int32_t> order = order_of(places, space.weights);
      for (std::size_t i = 0; i < n; ++i) {
        const auto from = static_cast<std::size_t>(order[i]);
        std::copy_n(&relaxed[width * from], width, &sorted[width * i]);
        if (space.weights != nullptr) weights[i] = space.weights[from];
      }
      const Triangulation mesh = [&] {
        try {
          return triangulated(sorted, in_order);
        } catch (const Error&) {
          triangulated(relaxed, space);  // whose error has the points' own numbers
          throw;
        }
      }();
      const call::CellInput input{{sorted.data(), nullptr, n}, in_order, mesh, polygon};
      const std::vector<double> centroids =
          calls.centroids != nullptr ? calls.centroids(self, input) : calls.cells(self, input).centroids;
      // The centroids of points without a cell are NaN.
      std::transform(centroids.begin(), centroids.end(), sorted.begin(), sorted.begin(),
                     [](double moved, double before) { return std::isnan(moved) ? before : moved; });
      mesh::permute(order, width, sorted);
      std::swap(relaxed, sorted);
    }
  });
}

void Triangulator::relax(const DevicePoints& points, const double* corners, std::size_t corner_count,
                         std::size_t iterations, DeviceBuffer& result, const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    const call::Place place = call::with_doubles(*implementation_, implementation_->on_device());
    call::Frame call(*implementation_, place, enqueue);
    call.check(points, "points");
    place.device->check_size(points.count);
    call.begin();
    call::expect(call.offsets(points).size() <= 2, "points of several sets cannot be relaxed in one call");
    relax_in(call, points, polygon, iterations, result);
  });
}

}  // namespace flaunay
