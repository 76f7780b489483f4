#include "derived/raster/raster.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "derived/surface.hpp"
#include "geometry/arguments.hpp"
#include "host/launch/vector_operations.hpp"
#include "launchers/raster/scan.cl.hpp"
#include "launchers/raster/sides.cl.hpp"
#include "points/inspect.hpp"
#include "predicates/bounds.h"

namespace flaunay::raster {
namespace {

using geometry::Magnitudes;

// How far a computed row or column can be from the right one: a few roundings of numbers of pixels, and of
// coordinates in units of pixels.
double margin_of(double first, double step, std::size_t count) {
  constexpr double kSpare = 0x1p-30, kRoundings = 0x1p-50;
  return kSpare + kRoundings * (std::fabs(first / step) + static_cast<double>(count));
}

void check_axis(double first, double step, std::size_t count, const char* rows, char name) {
  constexpr auto kMost = static_cast<std::size_t>(std::numeric_limits<cl_int>::max());
  expect(count <= kMost, fmt::format("a raster of {} {}: {} are possible", count, rows, kMost));
  expect(std::isfinite(first) && std::isfinite(step) && step != 0,
         fmt::format("{} = {} and d{} = {} are no raster's", name, first, name, step));
  // Then rounding moves pixels by less than a quarter of their size.
  if (!(margin_of(first, step, count) < 0.25)) {
    throw Error(ErrorKind::input, fmt::format("the pixels are too small for doubles: d{} = {}, but {} = {}",
                                              name, step, name, first));
  }
}

Magnitudes magnitudes_of(const RasterGrid& grid) {
  const double corners[] = {grid.x,
                            grid.y,
                            grid.dx,
                            grid.dy,
                            grid.x + static_cast<double>(grid.columns) * grid.dx,
                            grid.y + static_cast<double>(grid.rows) * grid.dy};
  return geometry::inspect(corners, 0, 3);
}

void check_range(const Magnitudes& magnitudes) {
  if (geometry::bits_of(magnitudes) == 0 || (magnitudes.largest <= kernel::LARGEST_QUERY_EXPONENT &&
                                             magnitudes.lowest >= kernel::LOWEST_QUERY_EXPONENT))
    return;
  throw Error(ErrorKind::input,
              fmt::format("the coordinates of points and pixels are too large or too fine for a raster: they "
                          "must be multiples of 2^{} below 2^{}",
                          kernel::LOWEST_QUERY_EXPONENT, kernel::LARGEST_QUERY_EXPONENT + 1));
}

kernel::pixel_grid scanned_grid(const RasterGrid& grid, const RasterOptions& options) {
  kernel::pixel_grid scanned{};
  scanned.x = grid.x;
  scanned.y = grid.y;
  scanned.dx = grid.dx;
  scanned.dy = grid.dy;
  scanned.column_margin = margin_of(grid.x, grid.dx, grid.columns);
  scanned.row_margin = margin_of(grid.y, grid.dy, grid.rows);
  scanned.longest = options.max_edge * options.max_edge;
  scanned.rows = static_cast<int>(grid.rows);
  scanned.columns = static_cast<int>(grid.columns);
  scanned.columns_by = 1 / grid.dx;
  scanned.rows_by = 1 / grid.dy;
  return scanned;
}

}  // namespace

std::size_t checked_pixels(const RasterGrid& grid, const RasterOptions& options) {
  check_axis(grid.x, grid.dx, grid.columns, "columns", 'x');
  check_axis(grid.y, grid.dy, grid.rows, "rows", 'y');
  expect(grid.dx > 0, fmt::format("dx = {} must be positive", grid.dx));
  expect(options.max_edge >= 0, fmt::format("max_edge = {} must be a length", options.max_edge));
  expect(grid.columns == 0 ||
             grid.rows <= std::numeric_limits<std::size_t>::max() / sizeof(double) / grid.columns,
         fmt::format("{} x {} pixels are more than memory can have", grid.rows, grid.columns));
  check_range(magnitudes_of(grid));
  return grid.rows * grid.columns;
}

void compute(host::Runtime& runtime, const Surface& surface, const RasterGrid& grid,
             const RasterOptions& options, const Buffer<cl_double>& pixels) {
  runtime.fill(pixels, grid.rows * grid.columns, options.fill);
  scan(runtime, surface, grid, options, pixels);
}

void scan(host::Runtime& runtime, const Surface& surface, const RasterGrid& grid,
          const RasterOptions& options, const Buffer<cl_double>& pixels) {
  host::Arena::Scope scope(runtime.arena());
  const Magnitudes of_points = points::inspect(runtime, surface.coordinates, surface.points);
  if (of_points.bad != kernel::NO_BAD)
    throw Error(ErrorKind::input, fmt::format("point {} is not finite", of_points.bad));
  check_range(geometry::joined(of_points, magnitudes_of(grid)));
  const auto wrong = runtime.arena().allocate<cl_int>(1);
  runtime.fill(wrong, 1, std::numeric_limits<cl_int>::max());
  runtime.chunks(surface.count, runtime.sizes().chunk(surface.count),
                 kernels::scan_triangles{.grid = scanned_grid(grid, options),
                                         .scanned_mesh = surface,
                                         .values = surface.values,
                                         .pixels = pixels,
                                         .wrong = wrong});
  const cl_int first_wrong = runtime.read_one(wrong, 0);
  if (first_wrong != std::numeric_limits<cl_int>::max())
    refuse_triangle(static_cast<std::size_t>(first_wrong), surface.points, surface.count);
}

void append_side_pixels(host::Runtime& runtime, const Surface& surface, const Buffer<cl_int>& sides,
                        std::size_t count, const RasterGrid& grid, const RasterOptions& options,
                        std::vector<SidePixel>& pixels) {
  if (count == 0) return;
  host::Arena::Scope scope(runtime.arena());
  const kernel::pixel_grid scanned = scanned_grid(grid, options);
  const auto offsets = runtime.arena().allocate<cl_uint>(count + 1);
  runtime.map(count, kernels::count_side_pixels{
                         .grid = scanned, .scanned_mesh = surface, .sides = sides, .counts = offsets});
  host::exclusive_scan(runtime, offsets, count, offsets);
  const auto found = static_cast<std::size_t>(runtime.read_one(offsets, count));
  if (found == 0) return;
  const auto places = runtime.arena().allocate<cl_ulong>(found);
  const auto values = runtime.arena().allocate<cl_double>(found);
  runtime.map(count, kernels::list_side_pixels{.grid = scanned,
                                               .scanned_mesh = surface,
                                               .values = surface.values,
                                               .sides = sides,
                                               .offsets = offsets,
                                               .places = places,
                                               .found = values});
  std::vector<cl_ulong> all_places(found);
  std::vector<cl_double> all_values(found);
  runtime.read(places, 0, found, all_places.data());
  runtime.read(values, 0, found, all_values.data());
  for (std::size_t i = 0; i < found; ++i) pixels.push_back({all_places[i], all_values[i]});
}

}  // namespace flaunay::raster
