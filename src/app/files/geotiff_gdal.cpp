// Uses GDAL's C interface. The library is opened when it is first needed: it brings a hundred others, which
// take longer to load than small inputs take in all.
#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>

#include <array>
#include <cstdlib>
#include <memory>
#include <type_traits>

#include "app/files/geotiff.hpp"
#include "files/file.hpp"
#include "host/system/library.hpp"

namespace flaunay::io {
namespace {

#define FLAUNAY_GDAL_FUNCTIONS(X) \
  X(CPLErrorReset)                \
  X(CPLGetLastErrorMsg)           \
  X(CPLPopErrorHandler)           \
  X(CPLPrintPointer)              \
  X(CPLPushErrorHandler)          \
  X(CPLQuietErrorHandler)         \
  X(CSLDestroy)                   \
  X(CSLSetNameValue)              \
  X(GDALAddBand)                  \
  X(GDALAllRegister)              \
  X(GDALClose)                    \
  X(GDALCreate)                   \
  X(GDALCreateCopy)               \
  X(GDALDatasetCommitTransaction) \
  X(GDALDatasetCreateLayer)       \
  X(GDALDatasetStartTransaction)  \
  X(GDALGetDriverByName)          \
  X(GDALGetRasterBand)            \
  X(GDALSetGeoTransform)          \
  X(GDALSetMetadataItem)          \
  X(GDALSetRasterNoDataValue)     \
  X(GDALSetSpatialRef)            \
  X(OGR_F_Create)                 \
  X(OGR_F_Destroy)                \
  X(OGR_F_SetFieldDouble)         \
  X(OGR_F_SetGeometryDirectly)    \
  X(OGR_Fld_Create)               \
  X(OGR_Fld_Destroy)              \
  X(OGR_G_CreateGeometry)         \
  X(OGR_G_SetPoints)              \
  X(OGR_L_CreateFeature)          \
  X(OGR_L_CreateField)            \
  X(OGR_L_GetLayerDefn)           \
  X(OSRDestroySpatialReference)   \
  X(OSRExportToWkt)               \
  X(OSRGetAuthorityCode)          \
  X(OSRGetAuthorityName)          \
  X(OSRIsSame)                    \
  X(OSRNewSpatialReference)       \
  X(OSRSetAxisMappingStrategy)    \
  X(OSRSetFromUserInput)          \
  X(OSRStripVertical)             \
  X(VSIFree)                      \
  X(VSIGetMemFileBuffer)          \
  X(VSIUnlink)

struct Gdal {
#define MEMBER(name) decltype(&::name) name;
  FLAUNAY_GDAL_FUNCTIONS(MEMBER)
#undef MEMBER
};

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

const Gdal& gdal() {
  static const Gdal opened = open_gdal();
  return opened;
}

// Turns GDAL's messages into messages of errors.
class Quiet {
 public:
  Quiet() {
    gdal().CPLPushErrorHandler(gdal().CPLQuietErrorHandler);
    gdal().CPLErrorReset();
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  ~Quiet() { gdal().CPLPopErrorHandler(); }

  std::string reason() const {
    const std::string message = gdal().CPLGetLastErrorMsg();
    return message.empty() ? "GDAL does not say why" : message;
  }
};

struct Close {
  void operator()(GDALDatasetH dataset) const { gdal().GDALClose(dataset); }
};
using Dataset = std::unique_ptr<void, Close>;

struct Destroy {
  void operator()(OGRSpatialReferenceH system) const { gdal().OSRDestroySpatialReference(system); }
};
using System = std::unique_ptr<std::remove_pointer_t<OGRSpatialReferenceH>, Destroy>;

// Null if GDAL does not know it.
System read_crs(const std::string& crs) {
  const Quiet quiet;
  System system(gdal().OSRNewSpatialReference(nullptr));
  if (gdal().OSRSetFromUserInput(system.get(), crs.c_str()) != OGRERR_NONE) return nullptr;
  gdal().OSRSetAxisMappingStrategy(system.get(), OAMS_TRADITIONAL_GIS_ORDER);
  return system;
}

// Lists of options, as GDAL has them.
class Settings {
 public:
  Settings() = default;
  Settings(const Settings&) = delete;
  Settings& operator=(const Settings&) = delete;
  ~Settings() { gdal().CSLDestroy(list_); }
  void set(const char* name, const char* value) { list_ = gdal().CSLSetNameValue(list_, name, value); }
  char** get() { return list_; }

 private:
  char** list_ = nullptr;
};

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

GDALDriverH driver(const char* format, const std::string& name) {
  const GDALDriverH found = gdal().GDALGetDriverByName(format);
  if (found == nullptr) fail(name, "GDAL has no driver {}, which it needs", format);
  return found;
}

// A file of GDAL in memory.
class MemoryFile {
 public:
  explicit MemoryFile(const char* ending) : path_(std::string("/vsimem/flaunay") + ending) {}
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { gdal().VSIUnlink(path_.c_str()); }

  const char* path() const { return path_.c_str(); }
  std::string bytes() const {
    vsi_l_offset size = 0;
    const GByte* const first = gdal().VSIGetMemFileBuffer(path_.c_str(), &size, FALSE);
    return {reinterpret_cast<const char*>(first), static_cast<std::size_t>(size)};
  }

 private:
  std::string path_;
};

}  // namespace

void require_gdal(const std::string&) { gdal(); }

std::string crs_text(const std::string& crs, const std::string& what) {
  const System system = read_crs(crs);
  if (!system) fail(what, "GDAL knows no coordinate system '{}'", crs);
  char* text = nullptr;
  gdal().OSRExportToWkt(system.get(), &text);
  const std::string wkt = text;
  gdal().VSIFree(text);
  return wkt;
}

bool is_same_crs(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const System first = read_crs(a), second = read_crs(b);
  return first && second && gdal().OSRIsSame(first.get(), second.get()) != 0;
}

bool are_different_crs(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty()) return false;
  const System first = read_crs(a), second = read_crs(b);
  if (!first || !second) return false;
  gdal().OSRStripVertical(first.get());
  gdal().OSRStripVertical(second.get());
  return gdal().OSRIsSame(first.get(), second.get()) == 0;
}

int epsg_code(const std::string& crs) {
  const System system = read_crs(crs);
  if (!system) return 0;
  const char* const name = gdal().OSRGetAuthorityName(system.get(), nullptr);
  const char* const code = gdal().OSRGetAuthorityCode(system.get(), nullptr);
  return name != nullptr && code != nullptr && std::string(name) == "EPSG" ? std::atoi(code) : 0;
}

void write_geotiff(const std::string& path, const std::string& name, const GeoRaster& raster) {
  const Quiet quiet;
  const GDALDriverH cog = driver("COG", name);
  const Dataset source =
      dataset_of(raster.pixels, GDT_Float32, sizeof *raster.pixels, 1, raster.rows, raster.columns);
  if (!source) fail(name, "cannot be written: {}", quiet.reason());
  std::array<double, 6> transform = {raster.west, raster.resolution, 0, raster.north, 0, -raster.resolution};
  gdal().GDALSetGeoTransform(source.get(), transform.data());
  if (!raster.crs.empty()) {
    if (const System system = read_crs(raster.crs)) gdal().GDALSetSpatialRef(source.get(), system.get());
  }
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

std::string png_of(const std::string& name, const std::uint8_t* bands, std::size_t rows,
                   std::size_t columns) {
  const Quiet quiet;
  const GDALDriverH png = driver("PNG", name);
  // GDAL takes a pointer to mutable data even if it only reads.
  const Dataset source = dataset_of(const_cast<std::uint8_t*>(bands), GDT_Byte, 1, 2, rows, columns);
  const MemoryFile file(".png");
  Dataset written(
      source ? gdal().GDALCreateCopy(png, file.path(), source.get(), FALSE, nullptr, nullptr, nullptr)
             : nullptr);
  if (!written) fail(name, "cannot be written: {}", quiet.reason());
  written.reset();
  return file.bytes();
}

std::string geopackage_of(const std::string& name, const Contours& contours,
                          const std::vector<double>& heights, const std::string& crs) {
  const Quiet quiet;
  const auto check = [&](bool is_done) {
    if (!is_done) fail(name, "cannot be written: {}", quiet.reason());
  };
  const MemoryFile file(".gpkg");
  Dataset package(gdal().GDALCreate(driver("GPKG", name), file.path(), 0, 0, 0, GDT_Unknown, nullptr));
  check(package != nullptr);
  const System system = crs.empty() ? nullptr : read_crs(crs);
  const OGRLayerH layer =
      gdal().GDALDatasetCreateLayer(package.get(), "contours", system.get(), wkbLineString, nullptr);
  check(layer != nullptr);
  const OGRFieldDefnH field = gdal().OGR_Fld_Create("height", OFTReal);
  const bool has_field = gdal().OGR_L_CreateField(layer, field, FALSE) == OGRERR_NONE;
  gdal().OGR_Fld_Destroy(field);
  check(has_field && gdal().GDALDatasetStartTransaction(package.get(), FALSE) == OGRERR_NONE);
  for (std::size_t i = 0; i < contours.heights.size(); ++i) {
    constexpr int kStep = 2 * sizeof(double);
    const OGRGeometryH line = gdal().OGR_G_CreateGeometry(wkbLineString);
    const double* const first = &contours.coordinates[2 * contours.offsets[i]];
    gdal().OGR_G_SetPoints(line, static_cast<int>(contours.offsets[i + 1] - contours.offsets[i]), first,
                           kStep, first + 1, kStep, nullptr, 0);
    const OGRFeatureH feature = gdal().OGR_F_Create(gdal().OGR_L_GetLayerDefn(layer));
    gdal().OGR_F_SetFieldDouble(feature, 0, heights[static_cast<std::size_t>(contours.heights[i])]);
    gdal().OGR_F_SetGeometryDirectly(feature, line);
    const bool is_added = gdal().OGR_L_CreateFeature(layer, feature) == OGRERR_NONE;
    gdal().OGR_F_Destroy(feature);
    check(is_added);
  }
  check(gdal().GDALDatasetCommitTransaction(package.get()) == OGRERR_NONE);
  package.reset();
  return file.bytes();
}

}  // namespace flaunay::io
