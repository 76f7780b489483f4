// A picture of a triangulation.
#pragma once

#include <string>

#include "flaunay/flaunay.hpp"
#include "io/points.hpp"

namespace flaunay::io {

void write_svg(const std::string& path, const Points& points, const Triangulation& mesh);

}  // namespace flaunay::io
