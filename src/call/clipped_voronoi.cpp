// The public calls for clipped Voronoi cells.
#include "call/mesh_of.hpp"
#include "derived/voronoi/clip.hpp"

namespace flaunay {
namespace {

// set_count: takes the number of vertices.
template <typename Points, typename Mesh, typename Result, typename SetCount>
void compute(call::Frame& call, const Points& points, const Mesh& triangulation,
             const voronoi::ClipPolygon& polygon, Result& result, const SetCount& set_count) {
  const std::size_t n = points.count;
  call.check_size(n);
  points::DeviceMesh mesh = call::mesh_with_sets(call, points, triangulation);
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

}  // namespace

ClippedVoronoi Triangulator::clipped_voronoi(const double* coordinates, std::size_t n,
                                             const Triangulation& triangulation, const double* corners,
                                             std::size_t corner_count) {
  return call::take_turn(*implementation_, [&] {
    const voronoi::ClipPolygon polygon = voronoi::checked_polygon(corners, corner_count);
    ClippedVoronoi result;
    call::Frame call(implementation_->with_doubles(implementation_->for_host_memory()));
    compute(call, call::HostPoints{coordinates, nullptr, n}, triangulation, polygon, result,
            [&result](std::size_t vertices) { result.vertices.resize(2 * vertices); });
    return result;
  });
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
    compute(call, points, triangulation, polygon, result,
            [&result](std::size_t vertices) { result.vertex_count = vertices; });
  });
}

}  // namespace flaunay
