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
                               DeviceTriangulation& mesh, DeviceConstraintEdges& edges,
                               const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    call::Engine& engine = implementation_->on_device();
    host::Runtime& runtime = engine.runtime;
    std::size_t& made = engine.buffer_allocations;
    call::check_buffer(runtime, segments.memory, 2 * segments.count * sizeof(cl_int), call::Access::read,
                       "segments");
    Enqueue first = enqueue;
    first.event = nullptr;
    Parts parts;
    parts.neighbors = parts.hull = parts.representatives = true;
    call::triangulate(engine, points, mesh, parts, first);

    Enqueue rest = enqueue;
    rest.wait_for.clear();
    call::QueuedCall queued(runtime, rest);
    Arena::Scope scope(runtime.arena());
    const points::DeviceMesh delaunay = call::mesh_of(runtime, points, mesh);
    mesh.is_constrained = true;
    constrained::ConstrainedBuffers buffers;
    buffers.triangles = delaunay.triangles;
    buffers.neighbors = delaunay.neighbors;
    buffers.constrained = call::result_buffer<cl_uchar>(runtime, edges.constrained, 6 * points.count,
                                                        "constrained edges", made);
    buffers.segment_edges =
        call::result_buffer<cl_int>(runtime, edges.piece_edges, 2 * segments.count, "pieces' edges", made);
    constrained::constrain(
        runtime, delaunay,
        call::given_buffer<cl_int>(runtime, segments.memory, 2 * segments.count, "segments"), segments.count,
        buffers, [&](std::size_t count) {
          edges.edge_count = count;
          const auto buffer = call::result_buffer<cl_int>(runtime, edges.constraint_edges, 2 * count,
                                                          "constraint edges", made);
          call::check_distinct({points.memory, segments.memory, delaunay.triangles.memory(),
                                delaunay.neighbors.memory(), delaunay.hull.memory(),
                                delaunay.representatives.memory(), buffers.constrained.memory(),
                                buffers.segment_edges.memory(), buffer.memory()});
          return buffer;
        });
    queued.end();
  });
}

}  // namespace flaunay
