// The constrained Delaunay triangulation by kernels: all segments at once, on a device or natively. It gives
// the same results as constrained.hpp, its sequential twin.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "constrained/insertion/constrained.hpp"
#include "points/device_mesh.hpp"

namespace flaunay::constrained {

using host::Buffer;

/// Where results go; see Result.
struct ConstrainedBuffers {
  /// Those of the Delaunay triangulation, which are then changed, or others.
  Buffer<cl_int> triangles{}, neighbors{};
  Buffer<cl_int> halfedges{};  ///< may be null
  Buffer<cl_uchar> constrained{};
  Buffer<cl_int> segment_edges{};
};
/// Called once with the number of constraint edges; returns the buffer for their ends, two per edge.
using ProvideEdges = std::function<Buffer<cl_int>(std::size_t edges)>;

/// Makes segments edges of a triangulation in device memory. segments: two indices of points each. Throws
/// what the twin throws, and geometry::TooWideForFixedPoint before anything is changed; results are
/// unspecified otherwise. Waits about once per round, of which there are O(log segments) as a rule. Segments
/// that overlap so much that they have very many edges in common, more than 16 per point and segment, are
/// left to the twin.
void constrain(host::Runtime& runtime, const points::DeviceMesh& delaunay, const Buffer<cl_int>& segments,
               std::size_t segment_count, const ConstrainedBuffers& result, const ProvideEdges& provide);

/// The same in host memory; see constrain in constrained.hpp. Takes triangles and neighbors out of the
/// triangulation, which become those of the result; the rest of it stays. with_halfedges: whether
/// Result::halfedges is wanted.
Result constrain(host::Runtime& runtime, const double* coordinates, const std::vector<std::size_t>& offsets,
                 Triangulation& delaunay, const std::vector<std::int32_t>& segments,
                 bool with_halfedges = false);

}  // namespace flaunay::constrained
