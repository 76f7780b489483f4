// Pictures of triangulations and partitions.
#pragma once

#include <string>

#include "app/files/mesh.hpp"
#include "app/files/points.hpp"
#include "files/output.hpp"
#include "flaunay/research.hpp"

namespace flaunay::io {

/// With constraints, their edges are drawn strongly, and what is outside or a hole is in pale colours.
void write_svg(Outputs& outputs, const std::string& path, const MeshContents& contents);

/// Writes a picture of the regions, one colour each, with their points and borders.
void write_partition_svg(Outputs& outputs, const std::string& path, const Points& points,
                         const research::Partition& partition);

}  // namespace flaunay::io
