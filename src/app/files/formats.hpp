// The formats of files: what is read and written, by the ending of the path. A format is a row of the table
// in formats.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/map.hpp"
#include "app/files/mesh.hpp"
#include "app/files/point_text.hpp"
#include "app/files/points.hpp"
#include "files/file.hpp"
#include "files/output.hpp"

namespace flaunay::io {

/// How points are written, in pieces.
struct PointFormat {
  /// What comes before them. n: their number.
  void (*begin)(OutputFile& file, const std::string& path, std::uint64_t n);
  /// The next points, of which the first has this index.
  void (*write)(OutputFile& file, const double* coordinates, std::uint64_t first, std::size_t count);
  std::size_t least_bytes;  ///< of a point
  /// All points, if the format has their markers.
  void (*with_markers)(OutputFile& file, const Points& points) = nullptr;
};

/// What is null is not in the format.
struct Format {
  std::string_view ending;        ///< in lower case
  std::string_view content = "";  ///< of files with points, for messages

  // Points are read in one of three ways: as records of a binary file, as text in pieces, or with a whole
  // map.
  /// Finds the records. Throws Error(input) that names the file if it is none of the format, or not complete.
  PointRecords (*records)(const std::string& path, InputFile& file) = nullptr;
  std::unique_ptr<PointText> (*text)(const std::string& path) = nullptr;
  Map (*map)(const std::string& path) = nullptr;
  /// Throws an error that says why files of this format are not read.
  void (*refuse)(const std::string& path) = nullptr;

  std::vector<std::int32_t> (*segments)(const std::string& path, std::size_t points) = nullptr;
  std::vector<std::int32_t> (*triangles)(const std::string& path) = nullptr;

  const PointFormat* points_out = nullptr;
  void (*mesh_out)(Outputs& outputs, const std::string& path, const MeshContents& contents) = nullptr;
  /// Whether mesh_out writes regions and depths.
  bool has_labels = false;
  /// The ending of a file beside this one that is read or written, too, and of one only with constraints.
  std::string_view beside = "", constraints_beside = "";
};

/// What a file is for.
enum class Use {
  read_points,
  read_records,
  read_map,
  read_segments,
  read_triangles,
  write_points,
  write_mesh
};

/// The format of a path. Throws Error(usage) that lists the endings if there is none for this use. "-" is
/// text.
const Format& format_of(const std::string& path, Use use);
/// The format of a path, if there is one for this use; null otherwise.
const Format* find_format(const std::string& path, Use use);
/// ".npy, .node, ..."
std::string endings_for(Use use);

}  // namespace flaunay::io
