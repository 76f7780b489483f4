// The dual of a triangulation.
#pragma once

#include "points/device_mesh.hpp"

namespace flaunay::voronoi {

using namespace points;

/// The arrays of flaunay::Voronoi for n points and T triangles. They need only the alignment of their
/// elements.
struct Buffers {
  Buffer<cl_double> circumcentres{};  ///< 2 T
  Buffer<cl_int> cell_offsets{};      ///< n + 1
  Buffer<cl_int> cells{};             ///< 3 T
  Buffer<cl_uchar> unbounded{};       ///< n
};

/// Enqueues the computation of the dual, and does not wait. If the mesh is not valid, the results are
/// unspecified, but no memory outside of the arrays is accessed. Temporary memory: 13 bytes per triangle. A
/// cell of d triangles takes O(d log d) steps, of which one work-item does O(d).
void compute(host::Runtime& runtime, const DeviceMesh& mesh, const Buffers& result);

}  // namespace flaunay::voronoi
