// The constrained Delaunay triangulation: all segments become edges at once, on a device or natively.
// docs/constrained.md defines it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "points/device_mesh.hpp"

namespace flaunay::constrained {

using host::Buffer;

struct Result {
  /// As in Triangulation. Rows of the Delaunay triangulation that no segment crosses are unchanged, at their
  /// places; the other places have the new triangles in ascending order.
  std::vector<std::int32_t> triangles, neighbors;
  /// As in ConstrainedTriangulation.
  std::vector<std::uint8_t> constrained;
  /// The edges that segments are made of, each once: 2 vertices per edge, the lexicographically smaller one
  /// first.
  std::vector<std::int32_t> constraint_edges;
  /// 2 per segment: its edges are [first, second) in constraint_edges, from its lexicographically smaller end
  /// to the other one. 0, 0 if its ends have the same coordinates.
  std::vector<std::int32_t> segment_edges;
  /// As in Triangulation; empty unless asked for.
  std::vector<std::int32_t> halfedges;
};

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
/// geometry::TooWideForFixedPoint before anything is changed; Error(usage) if an index is no point, or if the
/// ends of a segment are in different sets; Error(input) if two segments cross at a place that is no point.
/// That names the first segment that crosses one with a smaller index, the one with the smallest index of
/// those, and the place. Results are unspecified then. Waits about once per round, of which there are
/// O(log segments) as a rule. The edges of segments that have very many in common, more than 16 per point and
/// segment, are found on the host.
void constrain(host::Runtime& runtime, const points::DeviceMesh& delaunay, const Buffer<cl_int>& segments,
               std::size_t segment_count, const ConstrainedBuffers& result, const ProvideEdges& provide);

/// The same in host memory. coordinates, offsets: as in Triangulator::triangulate. Takes triangles and
/// neighbors out of the triangulation, which become those of the result; the rest of it stays. Also throws
/// Error(usage) if the number of indices is odd, or if neighbours are missing. with_halfedges: whether
/// Result::halfedges is wanted.
Result constrain(host::Runtime& runtime, const double* coordinates, const std::vector<std::size_t>& offsets,
                 Triangulation& delaunay, const std::vector<std::int32_t>& segments,
                 bool with_halfedges = false);

}  // namespace flaunay::constrained
