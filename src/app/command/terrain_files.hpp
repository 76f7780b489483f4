// The files that flaunay terrain writes.
#pragma once

#include <string>
#include <vector>

#include "app/command/output.hpp"
#include "app/command/terrain_mesh.hpp"
#include "app/files/scan.hpp"
#include "flaunay/terrain.hpp"

namespace flaunay::cli {

/// Pixels of one size: their corners, or with is_point their centres, are multiples of it. As of
/// flaunay.terrain in Python, in the same operations.
struct PixelGrid {
  /// Throws Error(usage) for a box that is none, and for too many pixels.
  PixelGrid(const io::Box& box, double size, bool is_point);
  std::size_t count() const { return pixels.rows * pixels.columns; }

  double resolution;
  bool is_point;
  double west = 0, north = 0;
  RasterGrid pixels;
};

/// The outputs of a run, by the endings of their paths.
struct TerrainFiles {
  /// Throws Error(usage) for another ending, and for one that needs GDAL if it is not there.
  explicit TerrainFiles(const std::vector<std::string>& paths);

  std::vector<std::string> arrays, rasters, pictures, lines, meshes;
};

void write_array(OutputFiles& outputs, const std::string& path, const PixelGrid& grid, const double* pixels);
/// Changes the pixels.
void write_rasters(OutputFiles& outputs, const std::vector<std::string>& paths, const PixelGrid& grid,
                   double nodata, const std::string& crs, double* pixels);
void write_picture(OutputFiles& outputs, const std::string& path, const PixelGrid& grid, const double* pixels,
                   const ShadingOptions& shading);
/// The triangles without an edge longer than max_edge.
void write_surface(OutputFiles& outputs, const std::string& path, const TerrainMesh& terrain,
                   double max_edge);

}  // namespace flaunay::cli
