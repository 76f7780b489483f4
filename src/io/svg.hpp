// Pictures of triangulations and partitions.
#pragma once

#include <string>

#include "flaunay/research.hpp"
#include "io/output.hpp"
#include "io/points.hpp"

namespace flaunay::io {

void write_svg(Outputs& outputs, const std::string& path, const Points& points, const Triangulation& mesh);

/// Writes a picture of the regions, one colour each, with their points and borders.
void write_partition_svg(Outputs& outputs, const std::string& path, const Points& points,
                         const research::Partition& partition);

}  // namespace flaunay::io
