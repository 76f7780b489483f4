// The public calls for Voronoi diagrams.
#include "derived/voronoi/voronoi.hpp"

#include "call/mesh_of.hpp"

namespace flaunay {
namespace {

template <typename Points, typename Mesh, typename Result>
void compute(call::Frame& call, const Points& points, const Mesh& triangulation, Result& result) {
  call.check_size(points.count);
  points::DeviceMesh mesh = call::mesh_with_sets(call, points, triangulation);
  const std::size_t triangles = mesh.triangle_count();
  const voronoi::Buffers buffers{call.out<cl_double>(result.circumcentres, 2 * triangles, "circumcentres"),
                                 call.out<cl_int>(result.cell_offsets, points.count + 1, "cell offsets"),
                                 call.out<cl_int>(result.cells, 3 * triangles, "cells"),
                                 call.out<cl_uchar>(result.unbounded, points.count, "unbounded cells")};
  call.check_distinct();
  mesh.coordinates = call.points(points);
  voronoi::compute(call.runtime, mesh, buffers);
  call.end();
}

}  // namespace

Voronoi Triangulator::voronoi(const double* coordinates, std::size_t n, const Triangulation& triangulation) {
  return call::take_turn(*implementation_, [&] {
    Voronoi result;
    call::Frame call(implementation_->with_doubles(implementation_->for_host_memory()));
    compute(call, call::HostPoints{coordinates, nullptr, n}, triangulation, result);
    return result;
  });
}

void Triangulator::voronoi(const DevicePoints& points, const DeviceTriangulation& triangulation,
                           DeviceVoronoi& result, const Enqueue& enqueue) {
  call::take_turn(*implementation_, enqueue, [&] {
    call::Frame call(*implementation_, call::with_doubles(*implementation_, implementation_->on_device()),
                     enqueue);
    call.check(points, "points");
    call.begin();
    compute(call, points, triangulation, result);
  });
}

}  // namespace flaunay
