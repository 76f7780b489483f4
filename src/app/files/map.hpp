// Reading maps and drawings: points with segments between them. Formats by the file's ending.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/points.hpp"

namespace flaunay::io {

/// A place in a region, and what a .poly file says about the region.
struct PolyRegion {
  double place[2], attribute;
  std::optional<double> area;  ///< the largest one, for programs that add points
};

/// Points with segments between them, and what the file says about the inside.
struct Map {
  Points points;
  /// 2 points per segment, in the order of the file: of rings, if there are polygons.
  std::vector<std::int32_t> segments;
  /// Further segments, of lines beside polygons. They bound nothing.
  std::vector<std::int32_t> lines;
  std::vector<double> holes;                  ///< x and y per hole: a place inside of it
  std::vector<std::int32_t> segment_markers;  ///< of a .poly file that has some
  std::vector<PolyRegion> regions;            ///< of a .poly file
  /// Ring r has segments [ring_offsets[r], ring_offsets[r + 1]), which begin at its points in their order.
  /// Part q has rings [part_offsets[q], part_offsets[q + 1]), its border and then its holes, and polygon p
  /// has rings [polygon_offsets[p], polygon_offsets[p + 1]).
  std::vector<std::size_t> ring_offsets = {0}, part_offsets = {0}, polygon_offsets = {0};
  /// Per polygon of GeoJSON or a layer the properties of its feature: the members of a JSON object without
  /// its braces, or empty.
  std::vector<std::string> properties = {};
  bool has_others = false;                    ///< lines or points besides polygons
  bool has_height_field = false;              ///< heights are those of a field that was asked for
  std::vector<std::string> field_names = {};  ///< of a layer, and of GeoJSON of which fields are read

  std::size_t polygon_count() const { return polygon_offsets.size() - 1; }
  /// Joins the points from the first one on to a line.
  void add_line(std::size_t first);
  /// Joins them to a ring. If the last one closes it, it is left out. Returns whether it does.
  bool add_ring(std::size_t first);
  /// Leaves no heights if all are unknown, and notes how many of a field are.
  void complete_heights(const std::string& path);
  /// For messages, the names of the fields.
  std::string known_fields() const;
  /// Throws Error(input) if the option asked for fields, and there is none, or it has no value.
  void check_height_field(const std::string& path, const std::vector<std::string>& fields,
                          std::string_view option = "--height") const;
};

/// Whether the ending of path is that of a map: .poly, .geojson, .json, or that of a layer.
bool is_map(const std::string& path);

/// Reads a map from path, by its ending (any case):
///   .poly            Triangle's format: comments, attributes, boundary markers, first index 0 or 1; without
///                    vertices, the vertices of the .node file beside it
///   .geojson .json   GeoJSON (RFC 7946): any object; the third coordinate is a height, later ones are
///                    ignored, and rings that are not closed are read as closed
///   .gpkg .shp .fgb .parquet   a layer, see read_layer
/// Throws Error(input) that names the file and the place: line and column for text, the path in the document
/// for JSON.
Map read_map(const std::string& path, const Columns& columns = {});
/// Reads a map of lines beside points whose columns are given. heights: its fields with heights, which it
/// must have; empty: those of the columns.
Map read_lines(const std::string& path, const Columns& columns, const std::vector<std::string>& heights);
/// Whether maps with the path's ending have fields: layers and GeoJSON.
bool has_fields(const std::string& path);

/// The files that read_map may read: path, and the .node file beside a .poly file.
std::vector<std::string> files_of_map(const std::string& path);

/// Reads segments, 2 indices of `points` points each, by the ending of path: .npy (any type of integers,
/// s x 2), or .txt or .csv (two per line, as points). Throws Error(input) that names the place.
std::vector<std::int32_t> read_segments(const std::string& path, std::size_t points);
/// Throws Error(usage) that lists the endings if read_segments does not know the ending of path.
void check_segments_ending(const std::string& path);

}  // namespace flaunay::io
