#include <numeric>

#include "call/frame.hpp"
#include "constrained/insertion/insert.hpp"
#include "constrained/stages.hpp"
#include "space/triangulate.hpp"

namespace flaunay::call {
namespace {

// The triangulation of points, whose arrays kernels change.
template <typename Mesh>
points::DeviceMesh mesh_to_change(Frame& call, const std::vector<std::size_t>& offsets, Mesh& mesh) {
  points::DeviceMesh delaunay;
  delaunay.point_offsets = offsets;
  delaunay.triangle_offsets = mesh.triangle_offsets;
  delaunay.hull_offsets = mesh.hull_offsets;
  const std::size_t corners = 3 * delaunay.triangle_count();
  delaunay.triangles = call.change<cl_int>(mesh.triangles, corners, "triangles");
  delaunay.neighbors = call.change<cl_int>(mesh.neighbors, corners, "neighbors");
  delaunay.hull = call.in<cl_int>(mesh.hull, delaunay.hull_offsets.back(), "hull");
  delaunay.representatives = call.in<cl_int>(mesh.representatives, delaunay.points(), "representatives");
  return delaunay;
}

// Makes segments edges of a mesh. edges: gets the arrays of constraint edges.
template <typename Edges>
geometry::Fitted<constrained::DomainMesh> insert(Frame& call, const points::DeviceMesh& delaunay,
                                                 const Buffer<cl_int>& segments, std::size_t count,
                                                 const Buffer<cl_int>& halfedges, Edges& edges) {
  const std::size_t n = delaunay.points(), corners = 3 * delaunay.triangle_count();
  const constrained::ConstrainedBuffers buffers{
      .triangles = delaunay.triangles,
      .neighbors = delaunay.neighbors,
      .halfedges = halfedges,
      .constrained = call.output<cl_uchar>(edges.constrained, 6 * n, "constrained edges").buffer(corners),
      .piece_edges = call.out<cl_int>(edges.piece_edges, 2 * count, "pieces' edges")};
  constrained::DomainMesh mesh{delaunay};
  const auto done =
      constrained::constrain(call.runtime, delaunay, segments, count, buffers, [&](std::size_t found) {
        mesh.edges = found;
        mesh.constraint_edges = call.out<cl_int>(edges.constraint_edges, 2 * found, "constraint edges");
        call.check_distinct();
        return mesh.constraint_edges;
      });
  if (!done) return done.too_wide();
  mesh.segments = count;
  mesh.constrained = buffers.constrained;
  mesh.segment_ends = segments;
  mesh.piece_edges = buffers.piece_edges;
  return mesh;
}

// The mesh is that of the points, and whole.
geometry::Fitted<geometry::Done> insert(Implementation& self, const Place& place, const DevicePoints& points,
                                        const DeviceSegments& segments, DeviceTriangulation& mesh,
                                        const Enqueue& enqueue) {
  Frame call(self, place, enqueue);
  call.check(points, "points");
  call.begin();
  mesh.is_constrained = true;
  points::DeviceMesh delaunay = mesh_to_change(call, mesh.point_offsets, mesh);
  const auto ends = call.in<cl_int>(segments.memory, 2 * segments.count, "segments");
  delaunay.coordinates = call.points(points);
  const auto inserted = insert(call, delaunay, ends, segments.count, {}, mesh);
  if (!inserted) return inserted.too_wide();
  call.end();
  mesh.constraint_count = inserted->edges;
  return geometry::Done();
}

}  // namespace

points::DeviceMesh mesh_to_constrain(Frame& call, const Buffer<cl_double>& coordinates,
                                     const std::vector<std::size_t>& offsets, Triangulation& result) {
  points::DeviceMesh mesh = mesh_to_change(call, offsets, result);
  mesh.coordinates = coordinates;
  return mesh;
}

geometry::Fitted<constrained::DomainMesh> insert_segments(Frame& call, const points::DeviceMesh& mesh,
                                                          const Constraints& constraints, bool halfedges,
                                                          ConstrainedTriangulation& result) {
  const std::size_t count = constraints.segment_count;
  auto inserted = insert(
      call, mesh, call.in(constraints.segments, 2 * count), count,
      halfedges ? call.out<cl_int>(result.halfedges, 3 * mesh.triangle_count()) : Buffer<cl_int>(), result);
  if (!inserted) return inserted.too_wide();
  constrained::DomainMesh made = *std::move(inserted);
  // Each segment is one piece.
  result.piece_offsets.resize(count + 1);
  std::iota(result.piece_offsets.begin(), result.piece_offsets.end(), 0);
  made.piece_offsets = call.in(result.piece_offsets);
  result.added_offsets.assign(mesh.triangle_offsets.size(), 0);
  return made;
}

}  // namespace flaunay::call

namespace flaunay {

void Triangulator::constrained(const DevicePoints& points, const DeviceSegments& segments,
                               DeviceTriangulation& mesh, const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    call::Implementation& self = *implementation_;
    call::Engine& engine = self.on_device();
    Enqueue first = enqueue;
    first.event = nullptr;
    Parts parts;
    parts.neighbors = parts.hull = parts.representatives = true;
    check_count(segments.count, "segments", kMostIndexed / 2);
    call::check_buffer(engine.runtime, segments.memory, 2 * segments.count * sizeof(cl_int),
                       call::Access::read, "segments");
    call::reset(Space::plane(), mesh);
    call::triangulate(self, points, mesh, parts, first);

    Enqueue rest = enqueue;
    rest.wait_for.clear();
    const auto insert_on = [&](const call::Place& place) {
      mesh.is_constrained = false;
      return call::insert(self, place, points, segments, mesh, rest);
    };
    call::in_fixed_point_or(
        [&] {
          return insert_on({engine, &engine});
        },
        [&](const std::string&) { return insert_on(call::with_doubles(self, engine)); });
  });
}

}  // namespace flaunay
