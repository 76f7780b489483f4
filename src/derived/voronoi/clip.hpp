// Voronoi cells clipped to a convex polygon, their areas and centroids.
#pragma once

#include <functional>

#include "derived/voronoi/clip_polygon.hpp"
#include "points/device_mesh.hpp"

namespace flaunay::voronoi {

/// The arrays of flaunay::ClippedVoronoi for n points. They need only the alignment of their elements.
struct ClippedBuffers {
  host::Buffer<cl_int> offsets{};       ///< n + 1
  host::Buffer<cl_double> areas{};      ///< n
  host::Buffer<cl_double> centroids{};  ///< 2 n
};

/// Provides memory for this many vertices, 2 coordinates each.
using ProvideVertices = std::function<host::Buffer<cl_double>(std::size_t vertices)>;

/// Enqueues the computation of clipped cells. Waits twice: for the magnitudes of the points, and for the
/// number of vertices. Throws Error(input) if points and polygon are too different in magnitude. If the mesh
/// is not valid, the results are unspecified, but no memory outside of the arrays is accessed. Temporary
/// memory: 82 bytes per triangle, and 16 per point if coordinates are scaled. A cell of d triangles takes O(d
/// log d) steps, O(d) of them by one work-item; a polygon of m corners takes O(log m) per triangle and O(m)
/// per Voronoi edge that crosses it or may do so.
void compute_clipped(host::Runtime& runtime, const points::DeviceMesh& mesh, const ClipPolygon& polygon,
                     const ClippedBuffers& result, const ProvideVertices& provide);

/// Mends the polygons of cells (derived/voronoi/mend.hpp). If any polygon must be mended, that is done on the
/// host, and offsets and vertices are written again. count: the number of vertices. Returns how many vertices
/// are left. Waits once, or until all is mended.
std::size_t mend_clipped(host::Runtime& runtime, const points::DeviceMesh& mesh, const ClipPolygon& polygon,
                         const host::Buffer<cl_int>& offsets, const host::Buffer<cl_double>& vertices,
                         std::size_t count);

/// Enqueues moving each of n points that has a cell to its centroid.
void move_to_centroids(host::Runtime& runtime, std::size_t n, const ClippedBuffers& cells,
                       const host::Buffer<cl_double>& points);

}  // namespace flaunay::voronoi
