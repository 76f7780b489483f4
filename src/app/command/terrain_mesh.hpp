// The triangulation of measured points in memory, for what triangulations in chunks do not have: breaklines
// without heights, flat lakes, and files of the triangles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "app/files/map.hpp"
#include "app/files/scan.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/terrain.hpp"

namespace flaunay::cli {

/// Maps whose lines and rings become edges.
struct HardEdges {
  /// Reads the files; empty: none. line_heights: the fields of breaklines with heights; empty: those of
  /// columns. Throws Error(input) if one has no lines, or flat not only polygons.
  HardEdges(const std::string& breaklines, const std::string& flat, const io::Columns& columns,
            const std::vector<std::string>& line_heights, Crossings at_crossings);

  /// Whether all points of breaklines have heights.
  bool has_heights() const;
  Breaklines view() const;

  /// With Crossings::split: cuts lines with heights where they cross, each at the height of the first one.
  void split(Triangulator& triangulator);

  io::Map lines, lakes;
  std::vector<std::int32_t> segments;  ///< of the lines
  std::string path;                    ///< for messages
  Crossings crossings;
  bool has_height_field = false;  ///< of --height
};

struct TerrainMesh {
  std::vector<double> coordinates, heights;
  ConstrainedTriangulation mesh;

  MeshView view() const {
    return {coordinates.data(), heights.size(), mesh.triangles.data(), mesh.neighbors.data(),
            mesh.triangles.size() / 3};
  }
};

/// Reads and triangulates all points of a scan. Lines' ends without heights have those of the points around
/// them. Lakes are flat, and points in them do not count.
TerrainMesh triangulate_scan(Triangulator& triangulator, io::Scan& scan, HardEdges& edges,
                             Duplicates duplicates);

}  // namespace flaunay::cli
