#include "voronoi/voronoi.hpp"

#include <limits>

#include "host/vector_operations.hpp"
#include "launchers/voronoi/voronoi.cl.hpp"
#include "points/inspect.hpp"

namespace flaunay::voronoi {
namespace {

void write_circumcentres(host::Runtime& runtime, const DeviceMesh& mesh,
                         const Buffer<cl_double>& circumcentres) {
  const std::size_t n = mesh.points();
  const auto accounts = inspect_later(runtime, mesh.coordinates, n);
  runtime.map_in_small_groups(mesh.triangle_count(), kernels::circumcentres{.points = n,
                                                                            .input = mesh.coordinates,
                                                                            .accounts = accounts,
                                                                            .triangles = mesh.triangles,
                                                                            .centres = circumcentres});
}

void write_cells(host::Runtime& runtime, const DeviceMesh& mesh, const Buffers& result) {
  const std::size_t n = mesh.points();
  const auto points = static_cast<cl_int>(n);
  const auto firsts = runtime.arena().allocate<cl_int>(n);
  // The prefix sums of the counts are the offsets, which replace the counts in place.
  const auto offsets = result.cell_offsets.as<cl_uint>();
  runtime.fill(offsets, n + 1, cl_uint{0});
  runtime.fill(firsts, n, std::numeric_limits<cl_int>::max());
  runtime.map(3 * mesh.triangle_count(), kernels::count_corners{.points = points,
                                                                .triangles = mesh.triangles,
                                                                .neighbors = mesh.neighbors,
                                                                .counts = offsets,
                                                                .firsts = firsts});
  host::exclusive_scan(runtime, offsets, n, offsets);
  runtime.map(n, kernels::walk_cells{.triangle_count = mesh.triangle_count(),
                                     .triangles = mesh.triangles,
                                     .neighbors = mesh.neighbors,
                                     .firsts = firsts,
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
