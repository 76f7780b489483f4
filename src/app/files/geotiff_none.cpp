#include "app/files/geotiff.hpp"
#include "files/file.hpp"

namespace flaunay::io {

void require_gdal(const std::string& path) {
  throw Error(ErrorKind::usage,
              printable(fmt::format(
                  "{}: this flaunay was built without GDAL (-DFLAUNAY_GDAL=ON); take .npy or .geojson, or "
                  "flaunay.terrain in Python (pip install flaunay[terrain])",
                  path)));
}

std::string crs_text(const std::string& crs, const std::string&) { return crs; }

bool is_same_crs(const std::string& a, const std::string& b) { return a == b; }

int epsg_code(const std::string& crs) {
  constexpr std::string_view kPrefix = "EPSG:";
  return crs.rfind(kPrefix, 0) == 0 ? std::atoi(crs.c_str() + kPrefix.size()) : 0;
}

bool are_different_crs(const std::string& a, const std::string& b) {
  return epsg_code(a) != 0 && epsg_code(b) != 0 && epsg_code(a) != epsg_code(b);
}

void write_geotiff(const std::string&, const std::string& name, const GeoRaster&) { require_gdal(name); }

std::string png_of(const std::string& name, const std::uint8_t*, std::size_t, std::size_t) {
  require_gdal(name);
  return {};
}

std::string geopackage_of(const std::string& name, const Contours&, const std::vector<double>&,
                          const std::string&) {
  require_gdal(name);
  return {};
}

}  // namespace flaunay::io
