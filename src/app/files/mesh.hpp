// Writing triangulations to files, and reading triangles back for verification.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "app/files/map.hpp"
#include "app/files/points.hpp"
#include "files/output.hpp"
#include "flaunay/constrained.hpp"

namespace flaunay::io {

/// A mesh to be written.
struct MeshContents {
  const Points& points;
  const Triangulation& mesh;
  const ConstrainedTriangulation* constrained = nullptr;  ///< the mesh, if it has constraints
  const Map* map = nullptr;                               ///< then the map of the constraints
  FillRule fill_rule = FillRule::nesting;                 ///< the meaning of depths
  bool is_on_globe = false;  ///< points are longitudes and latitudes, and triangles lie on the sphere

  std::size_t triangle_count() const { return mesh.triangles.size() / 3; }
  double height(std::size_t point) const { return points.heights.empty() ? 0 : points.heights[point]; }
  const std::int32_t* corners(std::size_t triangle) const { return &mesh.triangles[3 * triangle]; }
  /// The mesh, or one that has nothing if there are no constraints.
  const ConstrainedTriangulation& constraints() const;
  bool has_labels() const;  ///< regions and depths
};

/// Writes the mesh by path's ending: .ele (with .node beside it, Triangle's format, 0-based), .off, .ply
/// (binary little-endian), .vtu, .obj, .msh (Gmsh 2.2), .npy (int32, m x 3), .geojson (a polygon per
/// triangle), .svg (a picture), and layers of a polygon per triangle: .gpkg, .shp, .fgb, .parquet. Points
/// that splitting added follow the input's points. Heights, which must be known for all points, are in .off,
/// .ply, .vtu, .obj, .msh and .geojson. Constraints are written as far as the format can have them:
///   .ele             attribute, region and depth as attributes, and beside it a .poly with the constraint
///                    edges, whose markers are their segments' markers or, if these have none, the numbers of
///                    their segments, from 1, and with the holes and regions
///   .obj .ply        the constraint edges, as lines, and as comments of the header
///   .msh             the constraint edges, and markers, attributes or polygons, and regions as its groups
///   .vtu .geojson    region and depth of each triangle; .geojson also its polygon, and its properties
///   .svg             the constraint edges, and the inside in other colours than the outside
/// Throws Error(input) naming path and the system's reason if it cannot be written.
void write_mesh(Outputs& outputs, const std::string& path, const MeshContents& contents);

/// The files that write_mesh writes for path: some formats have more than one. Throws Error(usage) for an
/// unknown ending.
std::vector<std::string> mesh_files(const std::string& path, bool with_constraints = false);

/// Whether the format of path has regions and depths.
bool shows_labels(const std::string& path);

/// Writes an .npy array of rows x columns; columns 0 or 1: of one dimension. type: of indices in the file.
void write_npy(Outputs& outputs, const std::string& path, const std::vector<std::int32_t>& values,
               std::size_t columns, IndexType type = IndexType::int32);
/// Writes an .npy array of doubles, whatever the type of indices.
void write_npy(Outputs& outputs, const std::string& path, const std::vector<double>& values,
               std::size_t columns, IndexType type = IndexType::int32);

/// Reads triangles, 0-based, from .npy (int32 or int64, m x 3), .ele (either index base), .off, .obj (faces),
/// .ply as write_mesh writes it. Throws Error(input) that names the place.
std::vector<std::int32_t> read_triangles(const std::string& path);
/// Reads the first attribute of each triangle; empty if the file has none, or is no .ele file.
std::vector<double> read_triangle_attributes(const std::string& path);
/// Reads an .area file of Triangle: the number of triangles, and for each its number, from 0 or 1 on, and the
/// largest area of its parts, 0 for any. Throws Error(input) that names the line.
std::vector<double> read_areas(const std::string& path);

/// Reads neighbours, as write_npy writes Triangulation::neighbors: .npy (int32 or int64, m x 3),
/// triangle indices or -1. Throws Error(usage) for another ending, Error(input) that names the place.
std::vector<std::int32_t> read_neighbors(const std::string& path);

/// Reads Triangulation::corner_offsets: .npy (int8, int32 or int64, m x 6). Errors as for read_neighbors.
std::vector<std::int8_t> read_corner_offsets(const std::string& path);

}  // namespace flaunay::io
