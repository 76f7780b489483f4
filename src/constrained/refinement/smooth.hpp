// Moves vertices of a mesh that is refined to better places, and keeps it Delaunay (docs/refinement.md).
#pragma once

#include <cstddef>
#include <utility>

#include "host/runtime.hpp"
#include "launchers/refinement/smooth.cl.hpp"

namespace flaunay::constrained {

/// The mesh, in the arrays of its rounds.
struct MeshToSmooth {
  std::size_t rows, vertices;
  kernel::refinement_rules rules;  ///< what triangles must stay better than
  kernels::refined_mesh mesh;
  host::Buffer<kernel::mesh_row> triangles;
  host::Buffer<cl_double2> points;
  host::Buffer<cl_ulong> keys;
  host::Buffer<cl_uchar> refused;
};

/// Moves vertices that are not on edges that must stay, all at once, and flips edges until the triangulation
/// is the canonical one again. No triangle turns over in between, and none has a smaller angle than before
/// and than it should have. Returns the rows that were changed, in the caller's arena scope, and their
/// number.
std::pair<host::Buffer<cl_int>, std::size_t> smooth(host::Runtime& runtime, const MeshToSmooth& mesh);

}  // namespace flaunay::constrained
