// Layers of features in the formats of geographic information systems, by GDAL: layers_gdal.cpp if the CMake
// option FLAUNAY_GDAL is on, otherwise geotiff_none.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/map.hpp"
#include "files/output.hpp"
#include "flaunay/terrain.hpp"

namespace flaunay::io {

/// Lines, or polygons of one ring each, to be written.
struct Layer {
  using Value = FieldValue;
  struct Field {
    std::string name;
    Value type;  ///< a value of the type that all have
    /// That of a feature, by its number; nothing, and numbers that are not finite, are null.
    std::function<Value(std::size_t feature)> value;
  };

  std::string name;
  bool is_polygons = false, has_heights = false;
  std::string crs;  ///< empty: none
  std::size_t size = 0;
  /// Appends x, y and height of each position of a feature. Rings end where they begin.
  std::function<void(std::size_t feature, std::vector<double>& positions)> append;
  std::vector<Field> fields;
};

/// A value of the type that all values have: of a text, unless all are numbers.
FieldValue common_type(const std::vector<FieldValue>& values);

/// The name of a field beside those that are given: with flaunay_ before it if they have it, in any case.
std::string own_name(std::string name, const std::vector<Layer::Field>& given);

/// Writes a layer by path's ending, .geojson (without heights) or one of GDAL's formats, and the files beside
/// path that the latter have. Throws Error(input).
void write_layer(Outputs& outputs, const std::string& path, const Layer& layer);
void write_gdal_layer(Outputs& outputs, const std::string& path, const Layer& layer);
/// Contours with their heights.
void write_lines(Outputs& outputs, const std::string& path, const Contours& contours,
                 const std::vector<double>& heights, const std::string& crs);

/// Reads a layer: its points, lines and polygons, the fields that are asked for, and the properties of
/// polygons. path: of the file, with a colon and the layer's name behind it if there are several. Throws
/// Error(input) that names the file, the layer and the feature.
Map read_layer(const std::string& path, const Columns& columns);

/// Sets the system of coordinates of a file to what the user says, if that is something. Throws Error(input)
/// if GDAL, which writes to `output`, does not know it.
void choose_crs(const std::string& asked, const std::string& input, const std::string& output,
                std::string& crs);

/// Throws Error(input) with the path if its system surely differs from that of other coordinates.
void check_same_crs(const std::string& path, const std::string& crs, const std::string& others,
                    const std::string& others_crs);

/// The path without the name of a layer: a.gpkg of a.gpkg:lakes.
std::string without_layer(const std::string& path);

/// Adds a note if GeoJSON at path cannot name the system.
void note_crs(Outputs& outputs, const std::string& path, const std::string& crs);
/// The member "crs" of GeoJSON as GDAL writes it, with a comma; empty unless the system has a number of EPSG.
/// Without it, RFC 7946 says that coordinates are longitude and latitude.
std::string geojson_crs(const std::string& crs);

}  // namespace flaunay::io
