#include <numeric>

#include "call/constrained.hpp"
#include "call/frame.hpp"
#include "call/triangulate.hpp"
#include "constrained/crossings/first_crossing.hpp"
#include "constrained/crossings/lines.hpp"
#include "constrained/insertion/insert.hpp"
#include "statistics/phases.hpp"
#include "tuning/tuning.hpp"

namespace flaunay::call {
namespace {

// So many are inserted in less time than it takes to look for an early error.
constexpr std::size_t kFewSegments = 500;

// Makes segments edges of a mesh, which kernels change. edges: gets the arrays of constraint edges. Returns
// their number.
template <typename Points, typename Segments, typename Mesh, typename Edges>
geometry::Fitted<std::size_t> insert(Frame& call, const Points& points,
                                     const std::vector<std::size_t>& offsets, const Segments& segments,
                                     std::size_t count, const Buffer<cl_int>& halfedges, Mesh& mesh,
                                     Edges& edges) {
  points::DeviceMesh delaunay;
  delaunay.point_offsets = offsets;
  delaunay.triangle_offsets = mesh.triangle_offsets;
  delaunay.hull_offsets = mesh.hull_offsets;
  const std::size_t n = delaunay.points(), corners = 3 * delaunay.triangle_count();
  delaunay.triangles = call.change<cl_int>(mesh.triangles, corners, "triangles");
  delaunay.neighbors = call.change<cl_int>(mesh.neighbors, corners, "neighbors");
  delaunay.hull = call.in<cl_int>(mesh.hull, delaunay.hull_offsets.back(), "hull");
  delaunay.representatives = call.in<cl_int>(mesh.representatives, n, "representatives");
  const constrained::ConstrainedBuffers buffers{
      .triangles = delaunay.triangles,
      .neighbors = delaunay.neighbors,
      .halfedges = halfedges,
      .constrained = call.output<cl_uchar>(edges.constrained, 6 * n, "constrained edges").buffer(corners),
      .piece_edges = call.out<cl_int>(edges.piece_edges, 2 * count, "pieces' edges")};
  const auto ends = call.in<cl_int>(segments, 2 * count, "segments");
  delaunay.coordinates = call.points(points);
  std::size_t edge_count = 0;
  const auto done =
      constrained::constrain(call.runtime, delaunay, ends, count, buffers, [&](std::size_t found) {
        edge_count = found;
        const auto buffer = call.out<cl_int>(edges.constraint_edges, 2 * found, "constraint edges");
        call.check_distinct();
        return buffer;
      });
  if (!done) return done.too_wide();
  call.end();
  return edge_count;
}

// The mesh is that of the points, and whole.
geometry::Fitted<geometry::Done> insert(Implementation& self, const Place& place, const DevicePoints& points,
                                        const DeviceSegments& segments, DeviceTriangulation& mesh,
                                        DeviceConstraintEdges& edges, const Enqueue& enqueue) {
  Frame call(self, place, enqueue);
  call.check(points, "points");
  call.begin();
  mesh.is_constrained = true;
  const auto count =
      insert(call, points, mesh.point_offsets, segments.memory, segments.count, {}, mesh, edges);
  if (!count) return count.too_wide();
  edges.edge_count = *count;
  return geometry::Done();
}

// Each segment is one piece.
void write_pieces(std::size_t segments, ConstrainedTriangulation& result) {
  result.piece_offsets.resize(segments + 1);
  std::iota(result.piece_offsets.begin(), result.piece_offsets.end(), 0);
  result.edge_segments = constrained::first_pieces(result.constraint_edges.size() / 2, result.piece_edges);
  result.added_offsets.assign(result.triangle_offsets.size(), 0);
}

}  // namespace

geometry::Fitted<geometry::Done> insert_segments_on(Engine& engine, const double* coordinates,
                                                    const std::vector<std::size_t>& offsets,
                                                    const Constraints& constraints, const Options& options,
                                                    ConstrainedTriangulation& result) {
  Frame call(engine, options.profile);
  const auto halfedges =
      options.halfedges ? call.out<cl_int>(result.halfedges, result.triangles.size()) : Buffer<cl_int>();
  const auto count = insert(call, HostPoints{coordinates, nullptr, offsets.back()}, offsets,
                            constraints.segments, constraints.segment_count, halfedges, result, result);
  if (!count) return count.too_wide();
  write_pieces(constraints.segment_count, result);
  return geometry::Done();
}

void insert_segments(Implementation& self, const double* coordinates, const std::vector<std::size_t>& offsets,
                     const Constraints& constraints, const Options& options,
                     ConstrainedTriangulation& result) {
  if (constraints.segment_count > kFewSegments) {
    constrained::check_first_segments(coordinates, offsets, constraints.segments, constraints.segment_count);
  }
  if (self.stays_here(offsets.back() + constraints.segment_count, options.profile)) {
    *insert_segments_on(Engine::of_thread(), coordinates, offsets, constraints, options, result);
    return;
  }
  Engine& engine = self.for_host_memory();
  const auto insert = [&](Engine& used) {
    const statistics::Phases phases(options);
    const host::Runtime::BeforeCompiling announce(used.runtime,
                                                  [&] { phases.interrupt("compiling kernels"); });
    const auto done = insert_segments_on(used, coordinates, offsets, constraints, options, result);
    if (!done) return done;
    add_accounts(used, result.statistics);
    return done;
  };
  in_fixed_point_or([&] { return insert(engine); },
                    [&](const std::string& reason) {
                      Engine& other = self.with_doubles(engine);
                      if (result.statistics.host_points == 0) {
                        add_note(engine, other, reason, "segments inserted", result.statistics);
                      }
                      return insert(other);
                    });
}

}  // namespace flaunay::call

namespace flaunay {

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
    check_count(segments.count, "segments", kMostIndexed / 2);
    call::check_buffer(engine.runtime, segments.memory, 2 * segments.count * sizeof(cl_int),
                       call::Access::read, "segments");
    call::triangulate(self, points, mesh, parts, first);

    Enqueue rest = enqueue;
    rest.wait_for.clear();
    const auto insert_on = [&](const call::Place& place) {
      mesh.is_constrained = false;
      return call::insert(self, place, points, segments, mesh, edges, rest);
    };
    call::in_fixed_point_or(
        [&] {
          return insert_on({engine, &engine});
        },
        [&](const std::string&) { return insert_on(call::with_doubles(self, engine)); });
  });
}

}  // namespace flaunay
