// The dual of a triangulation.
#pragma once

#include "derived/mesh.hpp"

namespace flaunay::derived {

/// As in flaunay::Voronoi; n points, T triangles. All aligned as elements only.
struct VoronoiBuffers {
  Buffer<cl_double> circumcentres{};  ///< 2 T
  Buffer<cl_int> cell_offsets{};      ///< n + 1
  Buffer<cl_int> cells{};             ///< 3 T
  Buffer<cl_uchar> unbounded{};       ///< n
};

/// Enqueues all and waits for nothing. Indices of a mesh that is none lead nowhere: its results are
/// unspecified. Temporary: 4 n bytes. O(n); a point of degree d takes one work-item d steps.
void voronoi(host::Runtime& runtime, const Mesh& mesh, const VoronoiBuffers& result);

}  // namespace flaunay::derived
