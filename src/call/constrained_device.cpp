// The public call for triangulations with constraints in device memory.
#include "call/mesh_of.hpp"
#include "call/triangulate.hpp"
#include "constrained/insertion/insert.hpp"

namespace flaunay {
namespace {

void insert(call::Implementation& self, const call::Place& place, const DevicePoints& points,
            const DeviceSegments& segments, DeviceTriangulation& mesh, DeviceConstraintEdges& edges,
            const Enqueue& enqueue) {
  call::Frame call(self, place, enqueue);
  call.check(points, "points");
  call.begin();
  points::DeviceMesh delaunay = call::mesh_of(call, points, mesh);
  const constrained::ConstrainedBuffers buffers{
      .triangles = delaunay.triangles,
      .neighbors = delaunay.neighbors,
      .constrained = call.out<cl_uchar>(edges.constrained, 6 * points.count, "constrained edges"),
      .segment_edges = call.out<cl_int>(edges.piece_edges, 2 * segments.count, "pieces' edges")};
  const auto ends = call.in<cl_int>(segments.memory, 2 * segments.count, "segments");
  mesh.is_constrained = true;
  call.write_back(delaunay.triangles, mesh.triangles);
  call.write_back(delaunay.neighbors, mesh.neighbors);
  delaunay.coordinates = call.points(points);
  constrained::constrain(call.runtime, delaunay, ends, segments.count, buffers, [&](std::size_t count) {
    edges.edge_count = count;
    const auto buffer = call.out<cl_int>(edges.constraint_edges, 2 * count, "constraint edges");
    call.check_distinct();
    return buffer;
  });
  call.end();
}

}  // namespace

void Triangulator::constrained(const DevicePoints& points, const DeviceSegments& segments,
                               DeviceTriangulation& mesh, DeviceConstraintEdges& edges,
                               const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    call::Implementation& self = *implementation_;
    call::Engine& engine = self.on_device();
    Enqueue first = enqueue;
    first.event = nullptr;
    Parts parts;
    parts.neighbors = parts.hull = parts.representatives = true;
    call::check_buffer(engine.runtime, segments.memory, 2 * segments.count * sizeof(cl_int),
                       call::Access::read, "segments");
    call::triangulate(self, points, mesh, parts, first);

    Enqueue rest = enqueue;
    rest.wait_for.clear();
    const auto insert_on = [&](const call::Place& place) {
      mesh.is_constrained = false;
      insert(self, place, points, segments, mesh, edges, rest);
    };
    call::in_fixed_point_or(
        [&] {
          insert_on({engine, &engine});
        },
        [&](const std::string&) { insert_on(call::with_doubles(self, engine)); });
  });
}

}  // namespace flaunay
