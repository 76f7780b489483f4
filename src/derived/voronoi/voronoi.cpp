#include "derived/voronoi/voronoi.hpp"

#include <vector>

#include "derived/voronoi/mend.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/voronoi/mend.cl.hpp"
#include "launchers/voronoi/voronoi.cl.hpp"
#include "points/download.hpp"

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

// Moves circumcentres so that cells are polygons that do not cross themselves.
void mend_duals(host::Runtime& runtime, const DeviceMesh& mesh, const Buffers& result) {
  const std::size_t n = mesh.points(), triangles = mesh.triangle_count();
  const auto mark = [&](const Buffer<cl_uint>& doubtful) {
    runtime.map(triangles, kernels::mark_doubtful_duals{.points = n,
                                                        .input = mesh.coordinates,
                                                        .triangles = mesh.triangles,
                                                        .neighbors = mesh.neighbors,
                                                        .centres = result.circumcentres,
                                                        .doubtful = doubtful});
  };
  if (triangles == 0) return;
  const std::vector<cl_uint> doubts = doubts_of(runtime, triangles, mark);
  if (doubts.empty()) return;
  const std::vector<double> sites = download(runtime, mesh.coordinates, 2 * n);
  std::vector<double> centres = download(runtime, result.circumcentres, 2 * triangles);
  const std::vector<cl_int> offsets = download(runtime, result.cell_offsets, n + 1),
                            corners = download(runtime, result.cells, 3 * triangles);
  mend_centres(runtime, mesh, doubts, sites, offsets, corners, download(runtime, result.unbounded, n),
               centres);
  runtime.write(result.circumcentres, 0, 2 * triangles, centres.data());
}

}  // namespace

void compute(host::Runtime& runtime, const DeviceMesh& mesh, const Buffers& result) {
  Arena::Scope scope(runtime.arena());
  write_circumcentres(runtime, mesh, result.circumcentres);
  write_cells(runtime, mesh, result);
  runtime.fill(result.unbounded, mesh.points(), cl_uchar{0});
  runtime.map(mesh.hull_offsets.back(),
              kernels::mark_hull{.points = mesh.points(), .hull = mesh.hull, .unbounded = result.unbounded});
  mend_duals(runtime, mesh, result);
}

}  // namespace flaunay::voronoi
