// Regions: parts of a triangulation whose borders are Delaunay edges, each solved on its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "recursive/mesh.hpp"
#include "recursive/predicates.hpp"

namespace flaunay::recursive {

/// A directed border edge, the region on its left: two positions in the region's points.
using BorderEdge = std::pair<std::int32_t, std::int32_t>;

/// The triangles inside of a border: 3 positions in points each, counter-clockwise.
///
/// mesh: any Delaunay triangulation of the region's points, internal ones and the border's. Border edges are
/// Delaunay edges of the whole set, so one that the mesh lacks is a chord of a polygon of cocircular points;
/// such polygons are triangulated anew. A border may pass a point several times and run along an edge in both
/// directions. Throws Error(input) if it is no border: an edge that no Delaunay triangulation of the points
/// has, one without a left side, the same one twice, or sides that contradict each other. O(n log n), unless
/// many border edges meet many cocircular polygons at one point.
std::vector<std::int32_t> region_triangles(const Predicates& predicates, const Point* points, std::size_t n,
                                           const std::vector<BorderEdge>& border, Mesh mesh);

/// Regions in flat arrays, as the device makes them. Ids are ranks of distinct points in (x, y).
struct RegionArrays {
  /// Region r has the internal points points[point_offsets[r]..point_offsets[r + 1]), ascending ids.
  std::vector<std::int32_t> point_offsets;
  std::vector<std::int32_t> points;
  /// It has the corners corner_offsets[r]..corner_offsets[r + 1], in any order, 3 ids each: the border's
  /// vertex before, the vertex, the one after; the region lies left of the edges between them.
  std::vector<std::int32_t> corner_offsets;
  std::vector<std::int32_t> corners;

  std::size_t size() const { return point_offsets.empty() ? 0 : point_offsets.size() - 1; }
};

/// The triangles of one of the regions, 3 ids each, counter-clockwise, by dwyer() on its own points. points:
/// of all ids. work: as dwyer's. Throws Error(input) if its corners are no border. O(n log n).
std::vector<std::int32_t> solve_region(const Predicates& predicates, const Point* points,
                                       const RegionArrays& regions, std::size_t r, Work* work = nullptr);

/// The triangles of all regions, 3 ids each, counter-clockwise, region after region; the same whatever the
/// number of threads. Each by solve_region.
///
/// points: of all ids. threads: host threads, at least 1; 0 takes one per core. Throws Error(internal) that
/// names the first region whose corners are no border. O(n log n) work.
/// counts: if not null, gets the work of all regions, and the critical path of the dearest.
std::vector<std::int32_t> solve_regions(const Predicates& predicates, const Point* points,
                                        const RegionArrays& regions, int threads,
                                        OperationCounts* counts = nullptr);

}  // namespace flaunay::recursive
