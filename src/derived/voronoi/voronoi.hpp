// The dual of a triangulation.
#pragma once

#include "points/device_mesh.hpp"

namespace flaunay::voronoi {

/// The arrays of flaunay::Voronoi for n points and T triangles. They need only the alignment of their
/// elements.
struct Buffers {
  host::Buffer<cl_double> circumcentres{};  ///< 2 T
  host::Buffer<cl_int> cell_offsets{};      ///< n + 1
  host::Buffer<cl_int> cells{};             ///< 3 T
  host::Buffer<cl_uchar> unbounded{};       ///< n
};

/// Enqueues the computation of the dual. Waits once, or until circumcentres are mended (mend.hpp). If the
/// mesh is not valid, the results are unspecified, but no memory outside of the arrays is accessed. Temporary
/// memory: 13 bytes per triangle. A cell of d triangles takes O(d log d) steps, O(d) of them by one
/// work-item.
void compute(host::Runtime& runtime, const points::DeviceMesh& mesh, const Buffers& result);

/// Computes the circumcentres of all triangles: 2 per triangle.
void write_circumcentres(host::Runtime& runtime, const points::DeviceMesh& mesh,
                         const host::Buffer<cl_double>& circumcentres);

/// The ways around the vertices, from corner to corner; see kernels/voronoi/voronoi.cl.
struct Walks {
  host::Buffer<cl_int> ahead{};     ///< 3 per triangle: the same vertex in the next triangle around it, or -1
  host::Buffer<cl_uchar> firsts{};  ///< 1 per triangle: the set of its corners at which cells begin
};

/// Links corners and writes to sizes, n + 1, the number of triangles of each cell and a 0. The walks come
/// from the runtime's arena.
Walks measure_cells(host::Runtime& runtime, const points::DeviceMesh& mesh,
                    const host::Buffer<cl_uint>& sizes);

}  // namespace flaunay::voronoi
