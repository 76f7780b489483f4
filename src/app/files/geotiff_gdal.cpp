// Rasters, pictures and systems of coordinates by GDAL.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <string_view>

#include "app/files/gdal.hpp"
#include "app/files/geotiff.hpp"
#include "files/file.hpp"
#include "host/system/library.hpp"

namespace flaunay::io {
namespace {

// FLAUNAY_GDAL_LIBRARY: its name, with the version of the binary interface that this was built for.
Gdal open_gdal() {
  void* const library = system::open_library(FLAUNAY_GDAL_LIBRARY);
  if (library == nullptr) {
    throw Error(ErrorKind::usage, "GDAL's library " FLAUNAY_GDAL_LIBRARY
                                  " cannot be opened; install it, or take .npy or .geojson");
  }
  Gdal gdal{};
#define FIND(name)                                                                                   \
  gdal.name = reinterpret_cast<decltype(&::name)>(system::find_function(library, #name));            \
  if (gdal.name == nullptr) {                                                                        \
    throw Error(ErrorKind::usage, "GDAL's library " FLAUNAY_GDAL_LIBRARY " has no function " #name); \
  }
  FLAUNAY_GDAL_FUNCTIONS(FIND)
#undef FIND
  gdal.GDALAllRegister();
  return gdal;
}

// A data set in memory that refers to bands of pixels, row by row, one after the other.
Dataset dataset_of(void* pixels, GDALDataType type, std::size_t bytes, int bands, std::size_t rows,
                   std::size_t columns) {
  const GDALDriverH in_memory = gdal().GDALGetDriverByName("MEM");
  Dataset made(
      gdal().GDALCreate(in_memory, "", static_cast<int>(columns), static_cast<int>(rows), 0, type, nullptr));
  for (int band = 0; made && band < bands; ++band) {
    std::array<char, 64> place{};
    gdal().CPLPrintPointer(
        place.data(), static_cast<char*>(pixels) + static_cast<std::size_t>(band) * rows * columns * bytes,
        static_cast<int>(place.size()) - 1);
    Settings settings;
    settings.set("DATAPOINTER", place.data());
    if (gdal().GDALAddBand(made.get(), type, settings.get()) != CE_None) made.reset();
  }
  return made;
}

}  // namespace

const Gdal& gdal() {
  static const Gdal opened = open_gdal();
  return opened;
}

System read_crs(const std::string& crs) {
  const Quiet quiet;
  System system(gdal().OSRNewSpatialReference(nullptr));
  const std::string text = crs == kDegrees ? "EPSG:4326" : crs;
  constexpr std::string_view kNames[] = {"EPSG:", "ESRI:", "OGC:", "urn:ogc:def:crs:"};
  const bool is_name = text.find('/') == std::string::npos &&
                       std::any_of(std::begin(kNames), std::end(kNames),
                                   [&](std::string_view name) { return text.rfind(name, 0) == 0; });
  char* wkt = const_cast<char*>(text.c_str());  // which GDAL only reads
  if ((is_name ? gdal().OSRSetFromUserInput(system.get(), text.c_str())
               : gdal().OSRImportFromWkt(system.get(), &wkt)) != OGRERR_NONE)
    return nullptr;
  gdal().OSRSetAxisMappingStrategy(system.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return system;
}

System known_crs(const std::string& crs, const std::string& path) {
  System system = read_crs(crs);
  if (!system)
    fail(path, "has the coordinate system '{}', which GDAL does not know; say by --crs what it is", crs);
  return system;
}

std::string text_of(OGRSpatialReferenceH system) {
  const auto got = [](const auto& get, const auto&... arguments) {
    const char* const text = get(arguments...);
    return std::string(text == nullptr ? "" : text);
  };
  if (system == nullptr) return "";
  // As layers without a system have them.
  const std::string title = got(gdal().OSRGetName, system);
  if (title.rfind("Undefined", 0) == 0 || title.rfind("Unknown engineering", 0) == 0) return "";
  const std::string code = got(gdal().OSRGetAuthorityName, system, nullptr) + ":" +
                           got(gdal().OSRGetAuthorityCode, system, nullptr);
  if (code == kDegrees || (code.rfind("EPSG:", 0) == 0 && code != "EPSG:")) return code;
  char* text = nullptr;
  gdal().OSRExportToWkt(system, &text);
  const std::string wkt = text == nullptr ? "" : text;
  gdal().VSIFree(text);
  return wkt;
}

GDALDriverH gdal_driver(const char* format, const std::string& name) {
  const GDALDriverH found = gdal().GDALGetDriverByName(format);
  if (found == nullptr) fail(name, "GDAL has no driver {}, which it needs", format);
  return found;
}

std::string crs_text(const std::string& crs) {
  const Quiet quiet;
  const System system(gdal().OSRNewSpatialReference(nullptr));
  if (gdal().OSRSetFromUserInput(system.get(), crs.c_str()) != OGRERR_NONE)
    fail("--crs", "GDAL knows no coordinate system '{}'; expected one such as EPSG:25832, or WKT", crs);
  return text_of(system.get());
}

void check_crs(const std::string& crs, const std::string& path) {
  if (!crs.empty()) known_crs(crs, path);
}

bool is_same_crs(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const System first = read_crs(a), second = read_crs(b);
  return first && second && gdal().OSRIsSame(first.get(), second.get()) != 0;
}

bool are_different_crs(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty() || a == b) return false;
  if (a == kDegrees || b == kDegrees) return !is_geographic(a) || !is_geographic(b);
  const System first = read_crs(a), second = read_crs(b);
  if (!first || !second) return true;
  gdal().OSRStripVertical(first.get());
  gdal().OSRStripVertical(second.get());
  return gdal().OSRIsSame(first.get(), second.get()) == 0;
}

int epsg_code(const std::string& crs) {
  constexpr std::string_view kPrefix = "EPSG:";
  const System system = crs.rfind(kPrefix, 0) == 0 ? nullptr : read_crs(crs);
  const std::string text = system ? text_of(system.get()) : crs;
  return text.rfind(kPrefix, 0) == 0 ? std::atoi(text.c_str() + kPrefix.size()) : 0;
}

bool is_geographic(const std::string& crs) {
  const System system = read_crs(crs);
  return system && gdal().OSRIsGeographic(system.get()) != 0;
}

void write_geotiff(const std::string& path, const std::string& name, const GeoRaster& raster) {
  const Quiet quiet;
  const GDALDriverH cog = gdal_driver("COG", name);
  const Dataset source =
      dataset_of(raster.pixels, GDT_Float32, sizeof *raster.pixels, 1, raster.rows, raster.columns);
  if (!source) fail(name, "cannot be written: {}", quiet.reason());
  std::array<double, 6> transform = {raster.west, raster.resolution, 0, raster.north, 0, -raster.resolution};
  gdal().GDALSetGeoTransform(source.get(), transform.data());
  if (!raster.crs.empty()) gdal().GDALSetSpatialRef(source.get(), known_crs(raster.crs, name).get());
  gdal().GDALSetMetadataItem(source.get(), "AREA_OR_POINT", raster.is_point ? "Point" : "Area", nullptr);
  gdal().GDALSetRasterNoDataValue(gdal().GDALGetRasterBand(source.get(), 1), raster.nodata);
  Settings options;
  options.set("COMPRESS", "DEFLATE");
  options.set("PREDICTOR", "YES");
  options.set("LEVEL", "1");  // a quarter less time than by default, for 4 % more bytes
  options.set("NUM_THREADS", "ALL_CPUS");
  options.set("BIGTIFF", "IF_SAFER");
  const Dataset written(
      gdal().GDALCreateCopy(cog, path.c_str(), source.get(), FALSE, options.get(), nullptr, nullptr));
  if (!written) fail(name, "cannot be written: {}", quiet.reason());
}

std::string png_of(const std::string& name, const std::uint8_t* bands, int count, std::size_t rows,
                   std::size_t columns) {
  const Quiet quiet;
  const GDALDriverH png = gdal_driver("PNG", name);
  // GDAL takes a pointer to mutable data even if it only reads.
  const Dataset source = dataset_of(const_cast<std::uint8_t*>(bands), GDT_Byte, 1, count, rows, columns);
  const MemoryFile file(".png");
  Dataset written(
      source ? gdal().GDALCreateCopy(png, file.path(), source.get(), FALSE, nullptr, nullptr, nullptr)
             : nullptr);
  if (!written) fail(name, "cannot be written: {}", quiet.reason());
  written.reset();
  return file.bytes();
}

}  // namespace flaunay::io
