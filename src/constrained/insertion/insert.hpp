// The constrained Delaunay triangulation: all segments become edges at once, on a device or natively.
// docs/constrained.md defines it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "geometry/magnitudes.hpp"
#include "points/device_mesh.hpp"

namespace flaunay::constrained {

using host::Buffer;

/// Where results go.
struct ConstrainedBuffers {
  /// The arrays of the Delaunay triangulation, which are changed then, or other arrays. Rows that no segment
  /// crosses keep their places; a new triangle takes the place of the Delaunay triangle with the same middle
  /// vertex, on the same side of it, above or below.
  Buffer<cl_int> triangles{}, neighbors{};
  Buffer<cl_int> halfedges{};  ///< may be null
  // As in ConstrainedTriangulation. Each segment is one piece.
  Buffer<cl_uchar> constrained{};
  Buffer<cl_int> piece_edges{};
};
/// Called once with the number of constraint edges; returns the buffer for them, two ends per edge.
using ProvideEdges = std::function<Buffer<cl_int>(std::size_t edges)>;

/// Makes segments edges of a triangulation in device memory. segments: two indices of points each. If points
/// do not fit fixed point, nothing is changed. Throws Error(usage) if an index is no point, or if the ends of
/// a segment are in different sets; Error(input) if two segments cross at a place that is no point. The error
/// names the first segment that crosses one with a smaller index, the smallest such index, and the place.
/// Results are unspecified then. Waits about once per round; O(log segments) rounds as a rule. If segments
/// share very many edges, more than 16 per point and segment, the edges are found on the host.
geometry::Fitted<geometry::Done> constrain(host::Runtime& runtime, const points::DeviceMesh& delaunay,
                                           const Buffer<cl_int>& segments, std::size_t segment_count,
                                           const ConstrainedBuffers& result, const ProvideEdges& provide);

}  // namespace flaunay::constrained
