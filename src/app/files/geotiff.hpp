// Maps in the formats of geographic information systems, by GDAL: geotiff_gdal.cpp if the CMake option
// FLAUNAY_GDAL is on, otherwise geotiff_none.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace flaunay::io {

/// Throws Error(usage) that says so if this build cannot write the file, and Error(input) if GDAL has no
/// driver for this layer, or the file has layers that flaunay has not written.
void require_gdal(const std::string& path);

/// Longitude and latitude, as a file of GeoJSON has them that names no system.
constexpr const char* kDegrees = "OGC:CRS84";

/// A system of coordinates that --crs says in any way that GDAL reads (EPSG:n, a file of WKT, ...), as
/// "EPSG:n" or WKT; without GDAL, the text itself. Throws Error(input).
std::string crs_text(const std::string& crs);
/// Throws Error(input) with the path if GDAL does not know the system that the file names. Only names and WKT
/// count, since GDAL would call servers and read other files.
void check_crs(const std::string& crs, const std::string& path);
/// Whether both are one system; without GDAL, whether they are one text.
bool is_same_crs(const std::string& a, const std::string& b);
/// Whether coordinates are surely of two systems, heights aside: false if one of the texts says nothing.
bool are_different_crs(const std::string& a, const std::string& b);
/// Whether coordinates are longitudes and latitudes; without GDAL, by the number of EPSG.
bool is_geographic(const std::string& crs);
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

/// The bytes of a .png file. bands: grey or colours and then alpha, row by row. name: for messages.
std::string png_of(const std::string& name, const std::uint8_t* bands, int count, std::size_t rows,
                   std::size_t columns);

}  // namespace flaunay::io
