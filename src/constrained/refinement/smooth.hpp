// Moves vertices of a mesh that is refined to better places, and keeps it Delaunay (docs/refinement.md).
#pragma once

#include <cstddef>

#include "host/runtime.hpp"
#include "launchers/refinement/smooth.cl.hpp"

namespace flaunay::constrained {

/// The mesh, in the arrays of its phases.
struct MeshToSmooth {
  std::size_t rows, vertices;
  kernel::refinement_rules rules;  ///< triangles must stay better than these
  kernels::refined_mesh mesh;
  host::Buffer<kernel::mesh_row> triangles;
  host::Buffer<cl_double2> points;
  host::Buffer<cl_uchar> states;
};

/// Moves vertices that are not on edges that must stay, all at once, and flips edges until the triangulation
/// is the canonical one again. No triangle turns over in between, and none has a smaller angle than before
/// and than it should have. States of rows that changed are ROW_NEW.
void smooth(host::Runtime& runtime, const MeshToSmooth& mesh);

}  // namespace flaunay::constrained
