// Pictures of triangulations and partitions.
#pragma once

#include <string>

#include "app/files/points.hpp"
#include "files/output.hpp"
#include "flaunay/constrained.hpp"
#include "flaunay/research.hpp"

namespace flaunay::io {

void write_svg(Outputs& outputs, const std::string& path, const Points& points, const Triangulation& mesh);

/// The same with the constraint edges drawn strongly, and what is outside or a hole in pale colours. points:
/// those that splitting added follow the others.
void write_svg(Outputs& outputs, const std::string& path, const Points& points,
               const ConstrainedTriangulation& mesh, FillRule fill_rule);

/// Writes a picture of the regions, one colour each, with their points and borders.
void write_partition_svg(Outputs& outputs, const std::string& path, const Points& points,
                         const research::Partition& partition);

}  // namespace flaunay::io
