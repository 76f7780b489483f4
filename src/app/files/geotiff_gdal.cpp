#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <array>
#include <cstdlib>
#include <memory>

#include "app/files/geotiff.hpp"
#include "files/file.hpp"

namespace flaunay::io {
namespace {

// GDAL's messages become those of errors.
class Quiet {
 public:
  Quiet() {
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  ~Quiet() { CPLPopErrorHandler(); }

  std::string reason() const {
    const std::string message = CPLGetLastErrorMsg();
    return message.empty() ? "GDAL does not say why" : message;
  }
};

struct Close {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Close>;

bool read_crs(const std::string& crs, OGRSpatialReference& system) {
  const Quiet quiet;
  if (system.SetFromUserInput(crs.c_str()) != OGRERR_NONE) return false;
  system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return true;
}

}  // namespace

void require_gdal(const std::string&) {}

std::string crs_text(const std::string& crs, const std::string& what) {
  OGRSpatialReference system;
  if (!read_crs(crs, system)) fail(what, "GDAL knows no coordinate system '{}'", crs);
  char* text = nullptr;
  system.exportToWkt(&text);
  const std::string wkt = text;
  CPLFree(text);
  return wkt;
}

bool is_same_crs(const std::string& a, const std::string& b) {
  OGRSpatialReference first, second;
  return a == b || (read_crs(a, first) && read_crs(b, second) && first.IsSame(&second) != 0);
}

int epsg_code(const std::string& crs) {
  OGRSpatialReference system;
  if (!read_crs(crs, system)) return 0;
  const char* const name = system.GetAuthorityName(nullptr);
  const char* const code = system.GetAuthorityCode(nullptr);
  return name != nullptr && code != nullptr && std::string(name) == "EPSG" ? std::atoi(code) : 0;
}

void write_geotiff(const std::string& path, const std::string& name, const GeoRaster& raster) {
  const Quiet quiet;
  if (GetGDALDriverManager()->GetDriverByName("COG") == nullptr) GDALAllRegister();
  GDALDriver* const in_memory = GetGDALDriverManager()->GetDriverByName("MEM");
  GDALDriver* const cog = GetGDALDriverManager()->GetDriverByName("COG");
  if (in_memory == nullptr || cog == nullptr) fail(name, "GDAL has no driver COG, which it needs");
  const Dataset source(in_memory->Create("", static_cast<int>(raster.columns), static_cast<int>(raster.rows),
                                         0, GDT_Float32, nullptr));
  std::array<char, 64> place{};
  CPLPrintPointer(place.data(), raster.pixels, static_cast<int>(place.size()) - 1);
  CPLStringList band_options;
  band_options.SetNameValue("DATAPOINTER", place.data());
  if (!source || source->AddBand(GDT_Float32, band_options.List()) != CE_None) {
    fail(name, "cannot be written: {}", quiet.reason());
  }
  std::array<double, 6> transform = {raster.west, raster.resolution, 0, raster.north, 0, -raster.resolution};
  source->SetGeoTransform(transform.data());
  OGRSpatialReference system;
  if (!raster.crs.empty() && read_crs(raster.crs, system)) source->SetSpatialRef(&system);
  source->SetMetadataItem("AREA_OR_POINT", raster.is_point ? "Point" : "Area");
  source->GetRasterBand(1)->SetNoDataValue(raster.nodata);
  CPLStringList options;
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "YES");
  options.SetNameValue("LEVEL", "1");  // a quarter less time than by default, for 4 % more bytes
  options.SetNameValue("NUM_THREADS", "ALL_CPUS");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  const Dataset written(cog->CreateCopy(path.c_str(), source.get(), FALSE, options.List(), nullptr, nullptr));
  if (!written) fail(name, "cannot be written: {}", quiet.reason());
}

}  // namespace flaunay::io
