// Half-edges of a list of triangles, numbered as in kernels/mesh/halfedges.h.
#pragma once

#include "flaunay/flaunay.hpp"
#include "mesh/halfedges.h"

namespace flaunay::geometry {

using kernel::next_halfedge;
using kernel::previous_halfedge;

/// If the options ask for halfedges, computes them from the neighbours of the result. Clears the neighbours
/// if the options do not ask for these.
void write_halfedges(const Options& options, Triangulation& result);

}  // namespace flaunay::geometry
