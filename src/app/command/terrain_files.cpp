#include "app/command/terrain_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "app/command/errors.hpp"
#include "app/files/formats.hpp"
#include "app/files/geotiff.hpp"
#include "app/files/layers.hpp"
#include "app/files/mesh.hpp"
#include "files/file.hpp"
#include "files/npy_header.hpp"

namespace flaunay::cli {
namespace {

// 32 GiB, or less where sizes have 32 bits.
constexpr double kMostPixels =
    std::min(0x1p32, static_cast<double>(std::numeric_limits<std::size_t>::max() / sizeof(double)));

}  // namespace

PixelGrid::PixelGrid(const io::Box& box, double size, bool is_point_)
    : resolution(size), is_point(is_point_) {
  for (int k = 0; k < 2; ++k) {
    if (!std::isfinite(box[k]) || !std::isfinite(box[k + 2]) || box[k] > box[k + 2]) {
      fail_usage(
          fmt::format("the map would be from ({}, {}) to ({}, {}): bounds must be finite, the lower "
                      "ones first",
                      box[0], box[1], box[2], box[3]));
    }
  }
  const double low_x = std::floor(box[0] / size), low_y = std::floor(box[1] / size);
  const double wide = std::max(std::ceil(box[2] / size) - low_x, 1.0) + (is_point ? 1 : 0);
  const double high = std::max(std::ceil(box[3] / size) - low_y, 1.0) + (is_point ? 1 : 0);
  if (!(wide * high <= kMostPixels)) {
    fail_usage(
        fmt::format("--resolution {}: makes {:.0f} x {:.0f} pixels of {} x {}; at most {:.0f} are possible",
                    size, wide, high, box[2] - box[0], box[3] - box[1], kMostPixels));
  }
  const double x = low_x - (is_point ? 0.5 : 0.0), y = low_y - (is_point ? 0.5 : 0.0);
  west = x * size;
  north = (y + high) * size;
  pixels = {(x + 0.5) * size,
            (y + high - 0.5) * size,
            size,
            -size,
            static_cast<std::size_t>(high),
            static_cast<std::size_t>(wide)};
}

TerrainFiles::TerrainFiles(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    const std::string ending = io::ending_of(path);
    if (ending == ".npy") {
      arrays.push_back(path);
    } else if (ending == ".tif" || ending == ".tiff" || ending == ".png") {
      io::require_gdal(path);
      (ending == ".png" ? pictures : rasters).push_back(path);
    } else if (io::find_format(path, io::Use::write_features) != nullptr) {
      lines.push_back(path);
    } else if (io::find_format(path, io::Use::write_surface) != nullptr) {
      meshes.push_back(path);
    } else {
      io::fail_ending(path, ".tif, .npy, .png, " + io::endings_for(io::Use::write_features) + ", " +
                                io::endings_for(io::Use::write_surface));
    }
  }
}

void write_array(OutputFiles& outputs, const std::string& path, const PixelGrid& grid, const double* pixels) {
  io::OutputFile& file = outputs.open(path);
  const std::string header = io::npy_header("<f8", grid.pixels.rows, grid.pixels.columns);
  file.write(header.data(), header.size());
  file.write(pixels, grid.count() * sizeof(double));
}

void write_rasters(OutputFiles& outputs, const std::vector<std::string>& paths, const PixelGrid& grid,
                   double nodata, const std::string& crs, double* pixels) {
  if (paths.empty()) return;
  // In place: each is written where one was read before.
  auto* const narrow = reinterpret_cast<float*>(pixels);
  for (std::size_t i = 0; i < grid.count(); ++i) {
    double wide;
    std::memcpy(&wide, pixels + i, sizeof wide);
    const auto pixel = static_cast<float>(std::isnan(wide) ? nodata : wide);
    std::memcpy(narrow + i, &pixel, sizeof pixel);
  }
  for (const std::string& path : paths) {
    const std::string partial = outputs.open(path).partial_path();
    if (partial.empty()) fail_usage(fmt::format("{}: is no regular file, which a GeoTIFF must be", path));
    io::write_geotiff(partial, path,
                      {narrow, grid.pixels.rows, grid.pixels.columns, grid.west, grid.north, grid.resolution,
                       grid.is_point, nodata, crs});
  }
}

void write_picture(OutputFiles& outputs, const std::string& path, const PixelGrid& grid, const double* pixels,
                   const ShadingOptions& shading) {
  const int bands = shading.colors ? 4 : 2;  // colours or grey, and then alpha
  std::vector<std::uint8_t> picture(static_cast<std::size_t>(bands) * grid.count());
  shade_hills(grid.pixels, pixels, shading, picture.data());
  const std::string png = io::png_of(path, picture.data(), bands, grid.pixels.rows, grid.pixels.columns);
  outputs.open(path).write(png.data(), png.size());
}

void write_surface(OutputFiles& outputs, const std::string& path, const TerrainMesh& terrain,
                   double max_edge) {
  ConstrainedTriangulation mesh;
  mesh.constraint_edges = terrain.mesh.constraint_edges;
  const double longest = max_edge * max_edge;
  const std::vector<std::int32_t>& corners = terrain.mesh.triangles;
  for (std::size_t c = 0; c < corners.size(); c += 3) {
    bool is_kept = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const double* const a = &terrain.coordinates[2 * static_cast<std::size_t>(corners[c + k])];
      const double* const b = &terrain.coordinates[2 * static_cast<std::size_t>(corners[c + (k + 1) % 3])];
      const double dx = b[0] - a[0], dy = b[1] - a[1];
      is_kept = is_kept && dx * dx + dy * dy <= longest;
    }
    if (is_kept) mesh.triangles.insert(mesh.triangles.end(), &corners[c], &corners[c] + 3);
  }
  const io::Points points{terrain.coordinates, {}, terrain.heights};
  io::MeshContents contents{points, mesh};
  if (!mesh.constraint_edges.empty()) contents.constrained = &mesh;
  io::write_mesh(outputs, path, contents);
}

}  // namespace flaunay::cli
