#include "derived/voronoi.hpp"

#include <limits>

#include "host/vector_operations.hpp"
#include "input/magnitudes.hpp"

namespace flaunay::derived {
namespace {

// Read by the device when it comes to it.
const Magnitudes kNothingInspected;

void write_circumcentres(host::Runtime& runtime, const Mesh& mesh, const Buffer<cl_double>& circumcentres) {
  const std::size_t n = mesh.points();
  const auto accounts = runtime.arena().allocate<cl_int>(3);
  runtime.write_later(accounts, 0, 3, &kNothingInspected.largest);
  runtime.chunks("ingest", "inspect", n, runtime.tuning().chunk(n), mesh.coordinates, accounts);
  runtime.map("voronoi", "circumcentres", mesh.triangle_count(), static_cast<cl_int>(n), mesh.coordinates,
              accounts, mesh.triangles, circumcentres);
}

void write_cells(host::Runtime& runtime, const Mesh& mesh, const VoronoiBuffers& result) {
  const std::size_t n = mesh.points();
  const auto points = static_cast<cl_int>(n);
  const auto firsts = runtime.arena().allocate<cl_int>(n);
  // Sums of counts are offsets; the same memory.
  const Buffer<cl_uint> offsets(
      std::shared_ptr<_cl_mem>(result.cell_offsets.memory(), [kept = result.cell_offsets](cl_mem) {}), n + 1);
  runtime.fill(offsets, n + 1, cl_uint{0});
  runtime.fill(firsts, n, std::numeric_limits<cl_int>::max());
  runtime.map("voronoi", "count_corners", 3 * mesh.triangle_count(), points, mesh.triangles, mesh.neighbors,
              offsets, firsts);
  host::exclusive_scan(runtime, offsets, n, offsets);
  runtime.map("voronoi", "walk_cells", n, static_cast<cl_int>(mesh.triangle_count()), mesh.triangles,
              mesh.neighbors, firsts, offsets, result.cells);
}

}  // namespace

void voronoi(host::Runtime& runtime, const Mesh& mesh, const VoronoiBuffers& result) {
  Arena::Scope scope(runtime.arena());
  write_circumcentres(runtime, mesh, result.circumcentres);
  write_cells(runtime, mesh, result);
  runtime.fill(result.unbounded, mesh.points(), cl_uchar{0});
  runtime.map("voronoi", "mark_hull", mesh.hull_offsets.back(), static_cast<cl_int>(mesh.points()), mesh.hull,
              result.unbounded);
}

}  // namespace flaunay::derived
