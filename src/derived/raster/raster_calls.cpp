// The public calls for rasters and contours.
#include "call/frame.hpp"
#include "derived/contours/contours.hpp"
#include "derived/raster/raster.hpp"

namespace flaunay {

namespace {

void check(const MeshView& mesh, const double* values) {
  check_array(mesh.coordinates, mesh.points, "points");
  check_array(values, mesh.points, "values");
  check_array(mesh.triangles, mesh.count, "triangles", kMostIndexed / 3);
  check_array(mesh.neighbors, mesh.count, "neighbours of triangles");
}

}  // namespace

void rasterize(Triangulator& triangulator, const MeshView& mesh, const double* values, const RasterGrid& grid,
               const RasterOptions& options, double* pixels) {
  call::Implementation& self = TriangulatorAccess::implementation(triangulator);
  call::take_turn(self, [&] {
    const std::size_t count = raster::checked_pixels(grid, options);
    check(mesh, values);
    if (count == 0) return;
    check_array(pixels, count, "pixels", kMostCountable);
    call::Frame call(self.with_doubles(self.for_host_memory()));
    host::Runtime& runtime = call.runtime;
    const raster::Surface surface{call.in(mesh.coordinates, 2 * mesh.points),
                                  call.in(mesh.triangles, 3 * mesh.count),
                                  call.in(mesh.neighbors, 3 * mesh.count),
                                  call.in(values, mesh.points),
                                  mesh.points,
                                  mesh.count};
    // The caller's memory itself if kernels run natively.
    const auto buffer =
        runtime.is_native() ? call.in(pixels, count) : runtime.arena().allocate<cl_double>(count);
    raster::compute(runtime, surface, grid, options, buffer);
    if (!runtime.is_native()) runtime.read(buffer, 0, count, pixels);
    call.end();
  });
}

Contours trace_contours(Triangulator& triangulator, const MeshView& mesh, const double* values,
                        const std::vector<double>& heights, double max_edge) {
  call::Implementation& self = TriangulatorAccess::implementation(triangulator);
  return call::take_turn(self, [&] {
    check(mesh, values);
    contours::check(heights, max_edge);
    host::Runtime& runtime = self.native().runtime;
    contours::Lines lines(heights, max_edge);
    lines.add(runtime, mesh, values);
    return lines.finish(runtime);
  });
}

}  // namespace flaunay
