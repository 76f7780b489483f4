#include "derived/voronoi/voronoi.hpp"

#include "host/launch/vector_operations.hpp"
#include "launchers/voronoi/voronoi.cl.hpp"

namespace flaunay::voronoi {
using namespace points;

void write_circumcentres(host::Runtime& runtime, const DeviceMesh& mesh,
                         const Buffer<cl_double>& circumcentres) {
  runtime.map_in_small_groups(mesh.triangle_count(), kernels::circumcentres{.points = mesh.points(),
                                                                            .input = mesh.coordinates,
                                                                            .triangles = mesh.triangles,
                                                                            .centres = circumcentres});
}

Walks measure_cells(host::Runtime& runtime, const DeviceMesh& mesh, const Buffer<cl_uint>& sizes) {
  const std::size_t n = mesh.points(), triangles = mesh.triangle_count();
  const Walks walks{runtime.arena().allocate<cl_int>(3 * triangles),
                    runtime.arena().allocate<cl_uchar>(triangles)};
  runtime.map(triangles, kernels::link_corners{.neighbors = mesh.neighbors, .ahead = walks.ahead});
  runtime.fill(sizes, n + 1, cl_uint{0});
  runtime.chunks(triangles, runtime.sizes().chunk(triangles),
                 kernels::measure_cells{.points = n,
                                        .triangles = mesh.triangles,
                                        .neighbors = mesh.neighbors,
                                        .ahead = walks.ahead,
                                        .sizes = sizes,
                                        .firsts = walks.firsts});
  return walks;
}

namespace {

void write_cells(host::Runtime& runtime, const DeviceMesh& mesh, const Buffers& result) {
  const std::size_t n = mesh.points(), triangles = mesh.triangle_count();
  // The prefix sums of the sizes are the offsets, which replace the sizes in place.
  const auto offsets = result.cell_offsets.as<cl_uint>();
  const Walks walks = measure_cells(runtime, mesh, offsets);
  host::exclusive_scan(runtime, offsets, n, offsets);
  runtime.chunks(triangles, runtime.sizes().chunk(triangles),
                 kernels::write_cells{.triangles = mesh.triangles,
                                      .ahead = walks.ahead,
                                      .firsts = walks.firsts,
                                      .offsets = offsets,
                                      .cells = result.cells});
}

}  // namespace

void compute(host::Runtime& runtime, const DeviceMesh& mesh, const Buffers& result) {
  Arena::Scope scope(runtime.arena());
  write_circumcentres(runtime, mesh, result.circumcentres);
  write_cells(runtime, mesh, result);
  runtime.fill(result.unbounded, mesh.points(), cl_uchar{0});
  runtime.map(mesh.hull_offsets.back(),
              kernels::mark_hull{.points = mesh.points(), .hull = mesh.hull, .unbounded = result.unbounded});
}

}  // namespace flaunay::voronoi
