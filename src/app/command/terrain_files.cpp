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
#include "app/files/mesh.hpp"
#include "files/file.hpp"
#include "files/npy_header.hpp"

namespace flaunay::cli {
namespace {

// 32 GiB, or less where sizes have 32 bits.
constexpr double kMostPixels =
    std::min(0x1p32, static_cast<double>(std::numeric_limits<std::size_t>::max() / sizeof(double)));

void write_geojson(OutputFiles& outputs, const std::string& path, const Contours& contours,
                   const std::vector<double>& heights, const std::string& crs) {
  io::OutputFile& file = outputs.open(path);
  file.print("{{\"type\":\"FeatureCollection\",");
  const int code = io::epsg_code(crs);
  // As GDAL writes it. Without it, RFC 7946 says that coordinates are longitude and latitude.
  if (code != 0) {
    file.print("\"crs\":{{\"type\":\"name\",\"properties\":{{\"name\":\"urn:ogc:def:crs:EPSG::{}\"}}}},",
               code);
  }
  file.print("\"features\":[");
  for (std::size_t i = 0; i < contours.heights.size(); ++i) {
    file.print(
        "{}\n{{\"type\":\"Feature\",\"properties\":{{\"height\":{}}},\"geometry\":{{\"type\":\"LineString\","
        "\"coordinates\":[",
        i == 0 ? "" : ",", heights[static_cast<std::size_t>(contours.heights[i])]);
    for (std::size_t p = contours.offsets[i]; p < contours.offsets[i + 1]; ++p) {
      file.print("{}[{},{}]", p == contours.offsets[i] ? "" : ",", contours.coordinates[2 * p],
                 contours.coordinates[2 * p + 1]);
    }
    file.print("]}}}}");
  }
  file.print("\n]}}\n");
}

// Half the difference of a pixel's neighbours; at the border, that to the only neighbour.
double slope(const double* pixel, std::size_t i, std::size_t count, std::ptrdiff_t step) {
  if (count < 2) return 0;
  if (i == 0) return pixel[step] - pixel[0];
  if (i == count - 1) return pixel[0] - pixel[-step];
  return (pixel[step] - pixel[-step]) / 2;
}

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
    } else if (ending == ".geojson") {
      lines.push_back(path);
    } else if (ending == ".tif" || ending == ".tiff" || ending == ".png" || ending == ".gpkg") {
      io::require_gdal(path);
      (ending == ".png" ? pictures : ending == ".gpkg" ? lines : rasters).push_back(path);
    } else if (io::find_format(path, io::Use::write_surface) != nullptr) {
      meshes.push_back(path);
    } else {
      io::fail_ending(path, ".tif, .npy, .png, .geojson, .gpkg, " + io::endings_for(io::Use::write_surface));
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

void write_picture(OutputFiles& outputs, const std::string& path, const PixelGrid& grid,
                   const double* pixels) {
  // Lit from the north-west, 45 degrees high. Grey and then alpha, as flaunay.terrain in Python has them.
  constexpr double kWhite = 255, kRoot = 1.4142135623730951;
  const std::size_t rows = grid.pixels.rows, columns = grid.pixels.columns;
  std::vector<std::uint8_t> picture(2 * grid.count());
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t i = row * columns + column;
      const double x = slope(pixels + i, column, columns, 1) / grid.resolution;
      const double y = -slope(pixels + i, row, rows, static_cast<std::ptrdiff_t>(columns)) / grid.resolution;
      const double light = (1 - x / kRoot + y / kRoot) / std::sqrt(2 * (1 + x * x + y * y));
      if (!std::isfinite(light)) continue;
      picture[i] = static_cast<std::uint8_t>(kWhite * std::clamp(light, 0.0, 1.0));
      picture[grid.count() + i] = static_cast<std::uint8_t>(kWhite);
    }
  }
  const std::string png = io::png_of(path, picture.data(), rows, columns);
  outputs.open(path).write(png.data(), png.size());
}

void write_contours(OutputFiles& outputs, const std::string& path, const Contours& contours,
                    const std::vector<double>& heights, const std::string& crs) {
  if (io::ending_of(path) == ".geojson") return write_geojson(outputs, path, contours, heights, crs);
  const std::string package = io::geopackage_of(path, contours, heights, crs);
  outputs.open(path).write(package.data(), package.size());
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
