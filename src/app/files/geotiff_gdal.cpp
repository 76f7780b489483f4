// By GDAL's interface in C. The library is opened when it is first needed: it brings a hundred others, which
// would take longer to load than small inputs take in all.
#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal.h>
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
  X(GDALGetDriverByName)          \
  X(GDALGetRasterBand)            \
  X(GDALSetGeoTransform)          \
  X(GDALSetMetadataItem)          \
  X(GDALSetRasterNoDataValue)     \
  X(GDALSetSpatialRef)            \
  X(OSRDestroySpatialReference)   \
  X(OSRExportToWkt)               \
  X(OSRGetAuthorityCode)          \
  X(OSRGetAuthorityName)          \
  X(OSRIsSame)                    \
  X(OSRNewSpatialReference)       \
  X(OSRSetAxisMappingStrategy)    \
  X(OSRSetFromUserInput)          \
  X(VSIFree)

struct Gdal {
#define MEMBER(name) decltype(&::name) name;
  FLAUNAY_GDAL_FUNCTIONS(MEMBER)
#undef MEMBER
};

// FLAUNAY_GDAL_LIBRARY: its name, with the version of the binary interface that this was built for.
Gdal open_gdal() {
  void* const library = system::open_library(FLAUNAY_GDAL_LIBRARY);
  if (library == nullptr) {
    throw Error(ErrorKind::usage,
                "GDAL's library " FLAUNAY_GDAL_LIBRARY " cannot be opened; install it, or take .npy");
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

// GDAL's messages become those of errors.
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

int epsg_code(const std::string& crs) {
  const System system = read_crs(crs);
  if (!system) return 0;
  const char* const name = gdal().OSRGetAuthorityName(system.get(), nullptr);
  const char* const code = gdal().OSRGetAuthorityCode(system.get(), nullptr);
  return name != nullptr && code != nullptr && std::string(name) == "EPSG" ? std::atoi(code) : 0;
}

void write_geotiff(const std::string& path, const std::string& name, const GeoRaster& raster) {
  const Quiet quiet;
  const GDALDriverH in_memory = gdal().GDALGetDriverByName("MEM"), cog = gdal().GDALGetDriverByName("COG");
  if (in_memory == nullptr || cog == nullptr) fail(name, "GDAL has no driver COG, which it needs");
  const Dataset source(gdal().GDALCreate(in_memory, "", static_cast<int>(raster.columns),
                                         static_cast<int>(raster.rows), 0, GDT_Float32, nullptr));
  std::array<char, 64> place{};
  gdal().CPLPrintPointer(place.data(), raster.pixels, static_cast<int>(place.size()) - 1);
  Settings band;
  band.set("DATAPOINTER", place.data());
  if (!source || gdal().GDALAddBand(source.get(), GDT_Float32, band.get()) != CE_None) {
    fail(name, "cannot be written: {}", quiet.reason());
  }
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

}  // namespace flaunay::io
