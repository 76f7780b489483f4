// Triangles from the rows of a mesh that changes, where some rows are ghosts and some are free.
#pragma once

#include <vector>

#include "flaunay/dynamic.hpp"
#include "updates/mesh.hpp"

namespace flaunay::updates {

/// The triangles at their rows; -1 in rows that are ghosts or free. O(t).
TriangleRows rows_of(const std::vector<kernel::mesh_row>& rows);

/// The triangles, their neighbours and the hull, from its lexicographically smallest vertex on. O(t).
Triangulation triangles_of(const std::vector<kernel::mesh_row>& rows, const std::vector<double>& coordinates);

}  // namespace flaunay::updates
