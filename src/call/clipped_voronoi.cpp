// The public calls for clipped Voronoi cells.
#include "call/device_mesh.hpp"
#include "call/errors.hpp"
#include "call/handles.hpp"
#include "voronoi/clip.hpp"

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

}  // namespace

ClippedVoronoi Triangulator::clipped_voronoi(const double* coordinates, std::size_t n,
                                             const Triangulation& triangulation, const double* corners,
                                             std::size_t corner_count) {
  return call::take_turn(*implementation_, [&] {
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    call::Engine& engine = implementation_->for_host_memory();
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
  });
}

void Triangulator::clipped_voronoi(const DevicePoints& points, const DeviceTriangulation& triangulation,
                                   const double* corners, std::size_t corner_count,
                                   DeviceClippedVoronoi& result, const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    call::Engine& engine = implementation_->on_device();
    engine.use_own_memory();
    host::Runtime& runtime = engine.runtime;
    std::size_t& made = engine.buffer_allocations;
    call::check_enqueue(runtime, enqueue);
    call::check_points(runtime, points, "points");
    call::QueuedCall queued(runtime, enqueue);
    Arena::Scope scope(runtime.arena());
    const points::DeviceMesh mesh = call::mesh_of(runtime, points, triangulation);
    const std::size_t n = points.count;
    voronoi::ClippedBuffers buffers;
    buffers.offsets = call::result_buffer<cl_int>(runtime, result.offsets, n + 1, "cell offsets", made);
    buffers.areas = call::result_buffer<cl_double>(runtime, result.areas, n, "areas", made);
    buffers.centroids = call::result_buffer<cl_double>(runtime, result.centroids, 2 * n, "centroids", made);
    voronoi::compute_clipped(runtime, mesh, polygon, buffers, [&](std::size_t vertices) {
      result.vertex_count = vertices;
      const auto buffer =
          call::result_buffer<cl_double>(runtime, result.vertices, 2 * vertices, "vertices", made);
      call::check_distinct({mesh.triangles.memory(), mesh.neighbors.memory(), mesh.hull.memory(),
                            mesh.representatives.memory(), points.memory, buffers.offsets.memory(),
                            buffers.areas.memory(), buffers.centroids.memory(), buffer.memory()});
      return buffer;
    });
    queued.end();
  });
}

}  // namespace flaunay
