// Maps in the formats of geographic information systems, by GDAL: geotiff_gdal.cpp if the CMake option
// FLAUNAY_GDAL is on, otherwise geotiff_none.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/terrain.hpp"

namespace flaunay::io {

/// Throws Error(usage) that says so if this build cannot write the file.
void require_gdal(const std::string& path);

/// A system of coordinates as GDAL reads it (EPSG:n, WKT, ...), as WKT; without GDAL, the text itself. what:
/// where it comes from, for messages. Throws Error(input).
std::string crs_text(const std::string& crs, const std::string& what);
/// Whether both are one system; without GDAL, whether they are one text.
bool is_same_crs(const std::string& a, const std::string& b);
/// Whether coordinates are surely of two systems, heights aside: false if one of the texts says nothing.
bool are_different_crs(const std::string& a, const std::string& b);
/// The number of EPSG; 0 if it has none or is not known.
int epsg_code(const std::string& crs);

/// A raster, row by row from north to south.
struct GeoRaster {
  float* pixels;
  std::size_t rows, columns;
  double west, north, resolution;  ///< of the corners of pixels
  bool is_point;                   ///< whether pixels stand for points, their centres
  double nodata;
  std::string crs;  ///< empty: none
};
/// Writes a cloud-optimised GeoTIFF. path: that of the file on its way, name: that of the output, for
/// messages. Throws Error(input).
void write_geotiff(const std::string& path, const std::string& name, const GeoRaster& raster);

/// The bytes of a .png file. bands: grey and then alpha, row by row. name: for messages, as of the next one.
std::string png_of(const std::string& name, const std::uint8_t* bands, std::size_t rows, std::size_t columns);
/// The bytes of a .gpkg file of contour lines. heights: the heights of contours.
std::string geopackage_of(const std::string& name, const Contours& contours,
                          const std::vector<double>& heights, const std::string& crs);

}  // namespace flaunay::io
