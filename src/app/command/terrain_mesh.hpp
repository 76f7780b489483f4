// The triangulation of measured points in memory, for what triangulations in chunks do not have: breaklines,
// and contours.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/command/output.hpp"
#include "app/files/map.hpp"
#include "app/files/scan.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/terrain.hpp"

namespace flaunay::cli {

struct TerrainMesh {
  std::vector<double> coordinates, heights;
  ConstrainedTriangulation mesh;

  MeshView view() const {
    return {coordinates.data(), heights.size(), mesh.triangles.data(), mesh.neighbors.data(),
            mesh.triangles.size() / 3};
  }
};

/// Reads and triangulates all points of a scan. breaklines: a map whose lines and rings become edges, or
/// empty. Heights that they lack are those of the points around them.
TerrainMesh triangulate_scan(Triangulator& triangulator, io::Scan& scan, const std::string& breaklines,
                             Duplicates duplicates);

/// The heights of contours: those that were given, or if it is one, all multiples of it between the heights.
std::vector<double> contour_heights(const std::vector<double>& given, const std::vector<double>& heights);

/// Writes lines as GeoJSON, with their heights. crs: of the coordinates; may be empty.
void write_contours(OutputFiles& outputs, const std::string& path, const Contours& contours,
                    const std::vector<double>& heights, const std::string& crs);

}  // namespace flaunay::cli
