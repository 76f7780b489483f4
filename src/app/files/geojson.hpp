// GeoJSON (RFC 7946).
#pragma once

#include <string>

#include "app/files/map.hpp"

namespace flaunay::io {

/// Reads any object. The polygons of a MultiPolygon are one with several outer rings. A ring's closing
/// position is no point of its own; otherwise each position is a point, in the order of the file. Throws
/// Error(input) that names the path in the document.
Map read_geojson(const std::string& path);

}  // namespace flaunay::io
