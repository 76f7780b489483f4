// The public call for triangulations with constraints in device memory.
#include "call/device_call.hpp"
#include "call/device_mesh.hpp"
#include "call/errors.hpp"
#include "call/handles.hpp"
#include "constrained/device.hpp"

namespace flaunay {

using host::Arena;
using host::Buffer;

void Triangulator::constrained(const DevicePoints& points, const DeviceSegments& segments,
                               DeviceConstrainedTriangulation& result, const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    call::Engine& engine = implementation_->on_device();
    host::Runtime& runtime = engine.runtime;
    std::size_t& made = engine.buffer_allocations;
    call::check_buffer(runtime, segments.memory, 2 * segments.count * sizeof(cl_int), call::Access::read,
                       "segments");
    Enqueue first = enqueue;
    first.event = nullptr;
    call::triangulate(
        engine, points, result.mesh,
        {.triangles = true, .neighbors = true, .halfedges = false, .hull = true, .representatives = true},
        first);

    Enqueue rest = enqueue;
    rest.wait_for.clear();
    call::QueuedCall queued(runtime, rest);
    Arena::Scope scope(runtime.arena());
    const points::DeviceMesh mesh = call::mesh_of(runtime, points, result.mesh);
    constrained::ConstrainedBuffers buffers;
    buffers.triangles = mesh.triangles;
    buffers.neighbors = mesh.neighbors;
    buffers.constrained = call::result_buffer<cl_uchar>(runtime, result.constrained, 6 * points.count,
                                                        "constrained edges", made);
    buffers.segment_edges =
        call::result_buffer<cl_int>(runtime, result.piece_edges, 2 * segments.count, "pieces' edges", made);
    constrained::constrain(
        runtime, mesh, call::given_buffer<cl_int>(runtime, segments.memory, 2 * segments.count, "segments"),
        segments.count, buffers, [&](std::size_t edges) {
          result.edge_count = edges;
          const auto buffer = call::result_buffer<cl_int>(runtime, result.constraint_edges, 2 * edges,
                                                          "constraint edges", made);
          call::check_distinct({points.memory, segments.memory, mesh.triangles.memory(),
                                mesh.neighbors.memory(), mesh.hull.memory(), mesh.representatives.memory(),
                                buffers.constrained.memory(), buffers.segment_edges.memory(),
                                buffer.memory()});
          return buffer;
        });
    result.mesh.is_constrained = true;
    queued.end();
  });
}

}  // namespace flaunay
