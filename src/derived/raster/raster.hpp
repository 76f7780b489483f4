// Rasters of values at the corners of triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "flaunay/terrain.hpp"
#include "host/runtime.hpp"
#include "launchers/raster/scan.cl.hpp"

namespace flaunay::raster {

using host::Buffer;

/// A mesh and values in memory of a runtime; see MeshView.
struct Surface {
  Buffer<cl_double> coordinates{};
  Buffer<cl_int> triangles{}, neighbors{};
  Buffer<cl_double> values{};
  std::size_t points = 0, count = 0;

  operator kernels::scanned_mesh() const {
    return {.points = points,
            .count = count,
            .coordinates = coordinates,
            .triangles = triangles,
            .neighbors = neighbors};
  }
};

/// Throws Error(usage) for a grid or options that make no sense, and Error(input) for pixels that are too
/// small. Returns the number of pixels.
std::size_t checked_pixels(const RasterGrid& grid, const RasterOptions& options);

/// Writes all pixels; see rasterize. The grid and the options have been checked. Waits. Throws as rasterize.
void compute(host::Runtime& runtime, const Surface& surface, const RasterGrid& grid,
             const RasterOptions& options, const Buffer<cl_double>& pixels);

/// Writes the pixels in the triangles alone.
void scan(host::Runtime& runtime, const Surface& surface, const RasterGrid& grid,
          const RasterOptions& options, const Buffer<cl_double>& pixels);

/// A pixel on a side of a triangle, by its place in the raster, and the value that the triangle gives it.
struct SidePixel {
  std::uint64_t pixel;
  double value;
};
/// Appends the pixels on sides, without their ends, that would belong to a triangle on the other side. They
/// belong to this triangle if no triangle is there, or the one there has no pixels. sides: 3 t + k, opposite
/// to corner k of triangle t.
void append_side_pixels(host::Runtime& runtime, const Surface& surface, const Buffer<cl_int>& sides,
                        std::size_t count, const RasterGrid& grid, const RasterOptions& options,
                        std::vector<SidePixel>& pixels);

}  // namespace flaunay::raster
