// The public call for triangulations with constraints in device memory.
#include <utility>

#include "call/device_call.hpp"
#include "call/device_mesh.hpp"
#include "call/errors.hpp"
#include "call/handles.hpp"
#include "call/insert_segments.hpp"
#include "call/on_host.hpp"
#include "constrained/insertion/insert.hpp"
#include "geometry/magnitudes.hpp"

namespace flaunay {

using host::Arena;

namespace {

// Inserts the segments, by what the call says.
void insert(const call::WithDoubles& call, const DevicePoints& points, const DeviceSegments& segments,
            DeviceTriangulation& mesh, DeviceConstraintEdges& edges) {
  host::Runtime& runtime = call.device.runtime;
  std::size_t& made = call.device.buffer_allocations;
  call::QueuedCall queued(runtime, call.enqueue);
  Arena::Scope scope(runtime.arena());
  points::DeviceMesh delaunay = call::mesh_without_points(runtime, points, mesh);
  constrained::ConstrainedBuffers buffers;
  buffers.triangles = delaunay.triangles;
  buffers.neighbors = delaunay.neighbors;
  buffers.constrained =
      call::result_buffer<cl_uchar>(runtime, edges.constrained, 6 * points.count, "constrained edges", made);
  buffers.segment_edges =
      call::result_buffer<cl_int>(runtime, edges.piece_edges, 2 * segments.count, "pieces' edges", made);
  const auto provide_edges = [&](std::size_t count) {
    edges.edge_count = count;
    const auto buffer =
        call::result_buffer<cl_int>(runtime, edges.constraint_edges, 2 * count, "constraint edges", made);
    call::check_distinct({points.memory, segments.memory, delaunay.triangles.memory(),
                          delaunay.neighbors.memory(), delaunay.hull.memory(),
                          delaunay.representatives.memory(), buffers.constrained.memory(),
                          buffers.segment_edges.memory(), buffer.memory()});
    return buffer;
  };
  const auto given = call::given_buffer<cl_int>(runtime, segments.memory, 2 * segments.count, "segments");
  mesh.is_constrained = true;
  if (call.host != nullptr) {
    call::MeshOnHost read = call::read_mesh(runtime, points, delaunay);
    constrained::Result result =
        call::insert_on(*call.host, read.coordinates.data(), delaunay.point_offsets, read.triangulation,
                        points::download(runtime, given, given.size()), Options());
    const auto constraint_edges = provide_edges(result.constraint_edges.size() / 2);
    call::write_result(runtime, buffers.triangles, std::move(result.triangles));
    call::write_result(runtime, buffers.neighbors, std::move(result.neighbors));
    call::write_result(runtime, buffers.constrained, std::move(result.constrained));
    call::write_result(runtime, buffers.segment_edges, std::move(result.segment_edges));
    call::write_result(runtime, constraint_edges, std::move(result.constraint_edges));
  } else {
    delaunay.coordinates = call::wide_points(runtime, runtime.arena(), points);
    constrained::constrain(runtime, delaunay, given, segments.count, buffers, provide_edges);
  }
  queued.end();
}

}  // namespace

void Triangulator::constrained(const DevicePoints& points, const DeviceSegments& segments,
                               DeviceTriangulation& mesh, DeviceConstraintEdges& edges,
                               const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    call::Engine& engine = implementation_->on_device();
    Enqueue first = enqueue;
    first.event = nullptr;
    Parts parts;
    parts.neighbors = parts.hull = parts.representatives = true;
    call::check_buffer(engine.runtime, segments.memory, 2 * segments.count * sizeof(cl_int),
                       call::Access::read, "segments");
    call::triangulate(*implementation_, points, mesh, parts, first);

    Enqueue rest = enqueue;
    rest.wait_for.clear();
    try {
      insert({engine, nullptr, rest}, points, segments, mesh, edges);
    } catch (const geometry::TooWideForFixedPoint&) {
      mesh.is_constrained = false;
      insert(call::with_doubles(*implementation_, rest), points, segments, mesh, edges);
    }
  });
}

}  // namespace flaunay
