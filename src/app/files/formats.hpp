// File formats, chosen by the ending of the path: how each is read and written. Each format is defined in the
// file that reads and writes it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/map.hpp"
#include "app/files/mesh.hpp"
#include "app/files/points.hpp"
#include "files/file.hpp"
#include "files/output.hpp"

namespace flaunay::io {

/// A file format. Null members are not supported by it.
struct Format {
  std::string_view ending;        ///< in lower case
  std::string_view content = "";  ///< of files with points, for messages

  // Points are read in one of three ways: as records of a binary file, as text in pieces, or with a whole
  // map.
  /// Finds the records. Throws Error(input) that names the file if it has another format or is incomplete.
  PointRecords (*records)(const std::string& path, InputFile& file, const Columns& columns) = nullptr;
  std::unique_ptr<PointText> (*text)(const std::string& path, const Columns& columns) = nullptr;
  Map (*map)(const std::string& path, const Columns& columns) = nullptr;
  /// Throws an error that says why files of this format are not read.
  void (*refuse)(const std::string& path) = nullptr;

  std::vector<std::int32_t> (*segments)(const std::string& path, std::size_t points) = nullptr;
  std::vector<std::int32_t> (*triangles)(const std::string& path) = nullptr;

  // Points are written in pieces.
  /// Writes the header of a file with n points.
  void (*begin_points)(OutputFile& file, std::uint64_t n, bool has_markers) = nullptr;
  /// Writes the next points. first: the index of the first of them. markers: may be null.
  void (*write_points)(OutputFile& file, const double* coordinates, const std::int32_t* markers,
                       std::uint64_t first, std::size_t count) = nullptr;
  std::size_t least_bytes = 0;  ///< of a point

  using WriteMesh = void (*)(OutputFile& file, const MeshContents& contents);
  WriteMesh write_mesh = nullptr;
  /// In place of write_mesh: writes a layer of features, and its sidecars.
  void (*write_layer)(Outputs& outputs, const std::string& path, const MeshContents& contents) = nullptr;
  std::array<std::string_view, 9> sidecars = {};
  bool has_labels = false;  ///< whether write_mesh writes regions and depths
  bool is_spatial = false;  ///< whether it writes heights
  /// A file beside this one that is read or written, too, and one only with constraints.
  struct Beside {
    std::string_view ending = "";
    WriteMesh write = nullptr;
  } beside = {}, constraints_beside = {};
};

extern const Format kNpy, kNode, kXy, kXyz, kTxt, kCsv, kBin, kLas, kLaz, kPoly, kGeoJson, kJson, kEle, kOff,
    kObj, kPly, kMsh, kVtu, kSvg, kGpkg, kShp, kFgb, kParquet;

/// Format::text of the formats that have columns.
std::unique_ptr<PointText> column_text_of_points(const std::string& path, const Columns& columns);

/// Uses of a file.
struct Use {
  using Test = bool (*)(const Format& format);
  static bool read_points(const Format& format) {
    return format.records != nullptr || format.text != nullptr || format.map != nullptr;
  }
  static bool read_records(const Format& format) { return format.records != nullptr; }
  static bool read_map(const Format& format) { return format.map != nullptr; }
  static bool read_segments(const Format& format) { return format.segments != nullptr; }
  static bool read_triangles(const Format& format) { return format.triangles != nullptr; }
  static bool write_points(const Format& format) { return format.write_points != nullptr; }
  static bool write_mesh(const Format& format) { return format.write_mesh != nullptr || write_layer(format); }
  static bool write_layer(const Format& format) { return format.write_layer != nullptr; }
  /// Features with fields: layers and GeoJSON.
  static bool write_features(const Format& format) { return write_mesh(format) && read_map(format); }
  /// Whether it is written for a terrain. Maps are for contours there.
  static bool write_surface(const Format& format) { return has_heights(format) && !write_features(format); }
  static bool has_heights(const Format& format) { return write_mesh(format) && format.is_spatial; }
};

/// The format of a path. Throws Error(usage) that lists the endings if no format with this ending has this
/// use. "-" is text: of meshes, .off.
const Format& format_of(const std::string& path, Use::Test use);
/// The format of a path; null if no format with its ending has this use.
const Format* find_format(const std::string& path, Use::Test use);
/// ".npy, .node, ..."
std::string endings_for(Use::Test use);

/// x.poly to x.node: the path with another ending.
std::string path_beside(const std::string& path, std::string_view ending);

}  // namespace flaunay::io
