// Voronoi cells of points on the sphere.
#pragma once

#include "space/spaces.hpp"

namespace flaunay::sphere {

/// See Triangulator::voronoi.
Voronoi make_dual(call::Implementation& self, const call::CellInput& input);

/// Per point the direction of the centroid of its cell, by these coordinates: see Triangulator::relax. NaN
/// for points that another one represents, for a point alone, and for cells that are too small to have one.
/// The mesh is one that a call made. O(t).
std::vector<double> centroids(call::Implementation& self, const call::CellInput& input);

}  // namespace flaunay::sphere
