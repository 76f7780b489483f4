// Regions of a triangulation with constraints, their depths, and the triangles kept: without the outside and
// without holes. docs/constrained.md defines them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/constrained.hpp"
#include "geometry/magnitudes.hpp"
#include "host/runtime.hpp"
#include "points/device_mesh.hpp"

namespace flaunay::constrained {

using host::Arena;
using host::Buffer;

/// Triangulations of sets with constraints, in device memory. The arrays are as in ConstrainedTriangulation.
/// Arrays of segments are read only for fill rules that need them.
/// Points that splitting added have coordinates, but are not in the offsets.
struct DomainMesh : points::DeviceMesh {
  std::size_t segments = 0, edges = 0;
  Buffer<cl_uchar> constrained{};
  Buffer<cl_int> segment_ends{}, piece_offsets{}, piece_edges{}, constraint_edges{};
};

/// The regions of all sets, in the arena of the runtime.
struct Regions {
  std::size_t count = 0;
  Buffer<cl_int> of_triangles{};
  Buffer<cl_int> depths{}, polygons{}, seeds{};  ///< labels by region; empty until they are found
  Buffer<cl_uchar> left{};                       ///< by region: 1 if it is left
};

/// Finds the regions. All regions are kept. Waits once. O(n log n), but mostly O(n).
Regions find_regions(host::Runtime& runtime, const DomainMesh& mesh);

/// The rules that define depths, and which regions are kept.
struct DepthRules {
  FillRule fill = FillRule::nesting;
  Outside outside = Outside::keep;
  bool are_closed = false;  ///< whether segments are known to be closed curves
};

/// Computes the depths of regions, and which regions are kept. Throws Error(input), which names a point, if
/// segments are no closed curves and the rule needs closed ones. Waits 2 times, or once more for each
/// Tuning::depth_rounds levels; regions deeper than a few times as many levels are reached on the host.
void find_depths(host::Runtime& runtime, const DomainMesh& mesh, const DepthRules& rules, Regions& regions);

/// Places in regions, as the caller has them: holes or seeds of attributes.
struct Places {
  const char* name;  ///< in messages
  const double* coordinates;
  std::size_t count;
  std::vector<std::size_t> offsets;  ///< of sets
};
/// Throw Error(usage) if the offsets do not fit this many sets.
Places holes_of(const Constraints& constraints, std::size_t sets);
Places seeds_of(const Constraints& constraints, std::size_t sets);

/// Values instead of a triangle for a place that is in none.
constexpr std::int32_t kNowhere = -1, kOnConstraint = -2;
/// Returns the triangle of each place, in the caller's order, or one of the values above. Reads the
/// coordinates, the triangles and the constrained edges of the mesh, with doubles, which the runtime must
/// have. coordinates, offsets: of the points in host memory; points that splitting added come after all
/// others, set by set. Throws Error(input), which names a place, if one is not finite, too fine or too far
/// away. Waits once. O(n log m) for m places, if not many have an x coordinate in the range of one triangle.
std::vector<std::int32_t> find_places(host::Runtime& runtime, const DomainMesh& mesh, const Places& places,
                                      const double* coordinates, const std::vector<std::size_t>& offsets,
                                      const std::vector<std::size_t>& added_offsets);
/// Throws Error(input), which names the first place that is in no triangle or on a constraint.
void check_found(const Places& places, const std::vector<std::int32_t>& found);
/// Leaves out the regions of triangles. Does not wait.
void drop_holes(host::Runtime& runtime, const std::vector<std::int32_t>& triangles, Regions& regions);

/// Where the kept triangles and regions go.
struct LeftPlaces {
  std::vector<std::size_t> triangle_offsets;
  std::size_t regions = 0;
  Buffer<cl_uint> triangles{}, numbers{};
};
LeftPlaces place_left(host::Runtime& runtime, const DomainMesh& mesh, const Regions& regions);

/// The arrays of ConstrainedTriangulation for the kept triangles.
struct LeftBuffers {
  Buffer<cl_int> triangles{}, neighbors{};
  Buffer<cl_uchar> constrained{};
  Buffer<cl_int> regions{};
};
/// Writes the kept triangles, and numbers labels by kept regions. Does not wait. O(n).
void write_left(host::Runtime& runtime, const DomainMesh& mesh, const LeftPlaces& places,
                const LeftBuffers& left, Regions& regions);

/// Writes the labels of n triangles. regions: by triangle. labels: by region.
void write_labels(host::Runtime& runtime, std::size_t n, const Buffer<cl_int>& regions,
                  const Buffer<cl_int>& labels, const Buffer<cl_int>& triangle_labels);

}  // namespace flaunay::constrained
