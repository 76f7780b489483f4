// The public calls for clipped Voronoi cells.
#include <utility>

#include "call/device_mesh.hpp"
#include "call/errors.hpp"
#include "call/handles.hpp"
#include "call/on_host.hpp"
#include "derived/voronoi/clip.hpp"

namespace flaunay {

using host::Arena;
using host::Buffer;

namespace {

// All sets, since points on one line are told by their set.
points::DeviceMesh mesh_with_sets(host::Runtime& runtime, const double* coordinates, std::size_t n,
                                  const Triangulation& triangulation) {
  points::DeviceMesh mesh = call::mesh_of(runtime, coordinates, n, triangulation);
  call::expect(!triangulation.triangle_offsets.empty() &&
                   triangulation.triangle_offsets.size() == triangulation.hull_offsets.size() &&
                   triangulation.triangle_offsets.back() == mesh.triangle_count() &&
                   triangulation.hull_offsets.back() == triangulation.hull.size(),
               "the triangulation's offsets do not fit its arrays");
  mesh.triangle_offsets = triangulation.triangle_offsets;
  mesh.hull_offsets = triangulation.hull_offsets;
  // Of the points, kernels need the number alone.
  mesh.point_offsets.assign(mesh.hull_offsets.size(), n);
  return mesh;
}

ClippedVoronoi compute_on(call::Engine& engine, const double* coordinates, std::size_t n,
                          const Triangulation& triangulation, const voronoi::ClipPolygon& polygon) {
  engine.check_size(n);
  const call::OwnCall own(engine);
  host::Runtime& runtime = own.runtime;
  ClippedVoronoi result;
  const host::Runtime::Settled settled(runtime);
  const points::DeviceMesh mesh = mesh_with_sets(runtime, coordinates, n, triangulation);
  runtime.resize(result.offsets, n + 1);
  runtime.resize(result.areas, n);
  runtime.resize(result.centroids, 2 * n);
  const voronoi::ClippedBuffers buffers{runtime.output(result.offsets), runtime.output(result.areas),
                                        runtime.output(result.centroids)};
  Buffer<cl_double> vertices;
  voronoi::compute_clipped(runtime, mesh, polygon, buffers, [&](std::size_t count) {
    runtime.resize(result.vertices, 2 * count);
    vertices = runtime.output(result.vertices);
    return vertices;
  });
  runtime.fetch_later(buffers.offsets, result.offsets);
  runtime.fetch_later(buffers.areas, result.areas);
  runtime.fetch_later(buffers.centroids, result.centroids);
  runtime.fetch_later(vertices, result.vertices);
  runtime.finish();
  return result;
}

}  // namespace

ClippedVoronoi Triangulator::clipped_voronoi(const double* coordinates, std::size_t n,
                                             const Triangulation& triangulation, const double* corners,
                                             std::size_t corner_count) {
  return call::take_turn(*implementation_, [&] {
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    return compute_on(implementation_->with_doubles(implementation_->for_host_memory()), coordinates, n,
                      triangulation, polygon);
  });
}

void Triangulator::clipped_voronoi(const DevicePoints& points, const DeviceTriangulation& triangulation,
                                   const double* corners, std::size_t corner_count,
                                   DeviceClippedVoronoi& result, const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    const call::WithDoubles call = call::with_doubles(*implementation_, enqueue);
    call.device.use_own_memory();
    host::Runtime& runtime = call.device.runtime;
    std::size_t& made = call.device.buffer_allocations;
    call::check_enqueue(runtime, call.enqueue);
    call::check_points(runtime, points, "points");
    call::QueuedCall queued(runtime, call.enqueue);
    Arena::Scope scope(runtime.arena());
    points::DeviceMesh mesh = call::mesh_without_points(runtime, points, triangulation);
    const std::size_t n = points.count;
    voronoi::ClippedBuffers buffers;
    buffers.offsets = call::result_buffer<cl_int>(runtime, result.offsets, n + 1, "cell offsets", made);
    buffers.areas = call::result_buffer<cl_double>(runtime, result.areas, n, "areas", made);
    buffers.centroids = call::result_buffer<cl_double>(runtime, result.centroids, 2 * n, "centroids", made);
    const auto make_vertices = [&](std::size_t vertices) {
      result.vertex_count = vertices;
      const auto buffer =
          call::result_buffer<cl_double>(runtime, result.vertices, 2 * vertices, "vertices", made);
      call::check_distinct({mesh.triangles.memory(), mesh.neighbors.memory(), mesh.hull.memory(),
                            mesh.representatives.memory(), points.memory, buffers.offsets.memory(),
                            buffers.areas.memory(), buffers.centroids.memory(), buffer.memory()});
      return buffer;
    };
    if (call.host != nullptr) {
      const call::MeshOnHost read = call::read_mesh(runtime, points, mesh);
      ClippedVoronoi made_there =
          compute_on(*call.host, read.coordinates.data(), n, read.triangulation, polygon);
      const Buffer<cl_double> vertices = make_vertices(made_there.vertices.size() / 2);
      call::write_result(runtime, vertices, std::move(made_there.vertices));
      call::write_result(runtime, buffers.offsets, std::move(made_there.offsets));
      call::write_result(runtime, buffers.areas, std::move(made_there.areas));
      call::write_result(runtime, buffers.centroids, std::move(made_there.centroids));
    } else {
      mesh.coordinates = call::wide_points(runtime, runtime.arena(), points);
      voronoi::compute_clipped(runtime, mesh, polygon, buffers, make_vertices);
    }
    queued.end();
  });
}

}  // namespace flaunay
