// Euler's formula, as a check that nothing is lost.
#pragma once

#include <cstdint>
#include <string>

namespace flaunay::geometry {

/// Throws Error(internal) unless a triangulation can have these numbers of triangles, hull vertices and
/// vertices: triangles = 2 vertices - 2 - hull, or 0 if all vertices are on one line. where: the end of the
/// message's first half, such as " in set 3".
void check_euler(std::uint64_t triangles, std::uint64_t hull, std::uint64_t vertices,
                 const std::string& where = {});

}  // namespace flaunay::geometry
