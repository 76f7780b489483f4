#include "app/files/geotiff.hpp"
#include "app/files/layers.hpp"
#include "files/file.hpp"

namespace flaunay::io {

void require_gdal(const std::string& path) {
  throw Error(ErrorKind::usage,
              printable(fmt::format("{}: this flaunay was built without GDAL (-DFLAUNAY_GDAL=ON); take .npy "
                                    "or .geojson, which ogr2ogr makes "
                                    "of layers, or flaunay.terrain in Python (pip install flaunay[terrain])",
                                    path)));
}

std::string crs_text(const std::string& crs) { return crs; }

void check_crs(const std::string&, const std::string&) {}

bool is_same_crs(const std::string& a, const std::string& b) { return a == b; }

int epsg_code(const std::string& crs) {
  constexpr std::string_view kPrefix = "EPSG:";
  return crs.rfind(kPrefix, 0) == 0 ? std::atoi(crs.c_str() + kPrefix.size()) : 0;
}

bool is_geographic(const std::string& crs) { return crs == kDegrees || epsg_code(crs) / 1000 == 4; }

bool are_different_crs(const std::string& a, const std::string& b) {
  const auto is_known = [](const std::string& crs) { return crs == kDegrees || epsg_code(crs) != 0; };
  if (!is_known(a) || !is_known(b)) return false;
  return a == kDegrees || b == kDegrees ? !is_geographic(a) || !is_geographic(b) : a != b;
}

void write_geotiff(const std::string&, const std::string& name, const GeoRaster&) { require_gdal(name); }

std::string png_of(const std::string& name, const std::uint8_t*, int, std::size_t, std::size_t) {
  require_gdal(name);
  return {};
}

Map read_layer(const std::string& path, const Columns&) {
  require_gdal(path);
  return {};
}

void write_gdal_layer(Outputs&, const std::string& path, const Layer&) { require_gdal(path); }

}  // namespace flaunay::io
