// The public calls for Voronoi diagrams.
#include "derived/voronoi/voronoi.hpp"

#include <utility>

#include "call/device_mesh.hpp"
#include "call/errors.hpp"
#include "call/handles.hpp"
#include "call/on_host.hpp"

namespace flaunay {

using host::Arena;

namespace {

Voronoi compute_on(call::Engine& engine, const double* coordinates, std::size_t n,
                   const Triangulation& triangulation) {
  engine.check_size(n);
  const call::OwnCall own(engine);
  host::Runtime& runtime = own.runtime;
  Voronoi result;
  const host::Runtime::Settled settled(runtime);
  const points::DeviceMesh mesh = call::mesh_of(runtime, coordinates, n, triangulation);
  runtime.resize(result.circumcentres, 2 * mesh.triangle_count());
  runtime.resize(result.cell_offsets, n + 1);
  runtime.resize(result.cells, 3 * mesh.triangle_count());
  runtime.resize(result.unbounded, n);
  const voronoi::Buffers buffers{runtime.output(result.circumcentres), runtime.output(result.cell_offsets),
                                 runtime.output(result.cells), runtime.output(result.unbounded)};
  voronoi::compute(runtime, mesh, buffers);
  runtime.fetch_later(buffers.circumcentres, result.circumcentres);
  runtime.fetch_later(buffers.cell_offsets, result.cell_offsets);
  runtime.fetch_later(buffers.cells, result.cells);
  runtime.fetch_later(buffers.unbounded, result.unbounded);
  runtime.finish();
  return result;
}

void write(host::Runtime& runtime, Voronoi&& made, const voronoi::Buffers& to) {
  call::write_result(runtime, to.circumcentres, std::move(made.circumcentres));
  call::write_result(runtime, to.cell_offsets, std::move(made.cell_offsets));
  call::write_result(runtime, to.cells, std::move(made.cells));
  call::write_result(runtime, to.unbounded, std::move(made.unbounded));
}

}  // namespace

Voronoi Triangulator::voronoi(const double* coordinates, std::size_t n, const Triangulation& triangulation) {
  return call::take_turn(*implementation_, [&] {
    return compute_on(implementation_->with_doubles(implementation_->for_host_memory()), coordinates, n,
                      triangulation);
  });
}

void Triangulator::voronoi(const DevicePoints& points, const DeviceTriangulation& triangulation,
                           DeviceVoronoi& result, const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    const call::WithDoubles call = call::with_doubles(*implementation_, enqueue);
    call.device.use_own_memory();
    host::Runtime& runtime = call.device.runtime;
    std::size_t& made = call.device.buffer_allocations;
    call::check_enqueue(runtime, call.enqueue);
    call::check_points(runtime, points, "points");
    call::QueuedCall queued(runtime, call.enqueue);
    Arena::Scope scope(runtime.arena());
    points::DeviceMesh mesh = call::mesh_without_points(runtime, points, triangulation);
    const std::size_t triangles = mesh.triangle_count();
    voronoi::Buffers buffers;
    buffers.circumcentres =
        call::result_buffer<cl_double>(runtime, result.circumcentres, 2 * triangles, "circumcentres", made);
    buffers.cell_offsets =
        call::result_buffer<cl_int>(runtime, result.cell_offsets, points.count + 1, "cell offsets", made);
    buffers.cells = call::result_buffer<cl_int>(runtime, result.cells, 3 * triangles, "cells", made);
    buffers.unbounded =
        call::result_buffer<cl_uchar>(runtime, result.unbounded, points.count, "unbounded cells", made);
    call::check_distinct({mesh.triangles.memory(), mesh.neighbors.memory(), mesh.hull.memory(),
                          mesh.representatives.memory(), points.memory, buffers.circumcentres.memory(),
                          buffers.cell_offsets.memory(), buffers.cells.memory(), buffers.unbounded.memory()});
    if (call.host != nullptr) {
      const call::MeshOnHost read = call::read_mesh(runtime, points, mesh);
      write(runtime, compute_on(*call.host, read.coordinates.data(), points.count, read.triangulation),
            buffers);
    } else {
      mesh.coordinates = call::wide_points(runtime, runtime.arena(), points);
      voronoi::compute(runtime, mesh, buffers);
    }
    queued.end();
  });
}

}  // namespace flaunay
