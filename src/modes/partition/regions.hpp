// Regions: parts of a triangulation whose borders are Delaunay edges, each solved on its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "flaunay/research.hpp"
#include "geometry/mesh.hpp"
#include "geometry/predicates.hpp"
#include "geometry/region_arrays.hpp"

namespace flaunay::partition {

/// A directed border edge, with the region on its left: two positions in the region's points.
using BorderEdge = std::pair<std::int32_t, std::int32_t>;

/// Returns the triangles inside a border: 3 positions in points each, counter-clockwise.
///
/// mesh: any Delaunay triangulation of the region's points, internal ones and border points. Border edges are
/// Delaunay edges of the whole set. So if the mesh lacks a border edge, the edge is a chord of a polygon of
/// cocircular points; such polygons are triangulated again with their chords as edges. A border may pass a
/// point several times and run along an edge in both directions. Throws Error(input) if the border is not
/// valid: if it has an edge that no Delaunay triangulation of the points has, an edge without a left side, an
/// edge twice, or sides that contradict each other. O(n log n), unless many border edges meet many cocircular
/// polygons at one point.
std::vector<std::int32_t> region_triangles(const geometry::Predicates& predicates,
                                           const geometry::Point* points, std::size_t n,
                                           const std::vector<BorderEdge>& border, geometry::Mesh mesh);

/// A function that triangulates points[0..n), which are distinct and in the order of (x, y). Triangles hold
/// positions in points. work: if not null, the work is added to it.
using TriangulatePoints = geometry::Mesh (*)(const geometry::Predicates& predicates,
                                             const geometry::Point* points, std::size_t n,
                                             research::Work* work);

/// Triangulates region r by `triangulate` on its own points. Returns 3 ids per triangle, counter-clockwise.
/// points: the points of all ids. work: if not null, receives the work of `triangulate`. Throws Error(input)
/// if the region's corners do not form a border. O(n log n).
std::vector<std::int32_t> solve_region(const geometry::Predicates& predicates, const geometry::Point* points,
                                       const geometry::RegionArrays& regions, std::size_t r,
                                       TriangulatePoints triangulate, research::Work* work = nullptr);

/// Triangulates all regions by solve_region. Returns 3 ids per triangle, counter-clockwise, region after
/// region; the number of threads does not change the result.
///
/// points: the points of all ids. threads: number of host threads; 0: one per core. counts: if not null,
/// receives the work of all regions, and the longest of their critical paths. Throws Error(internal), which
/// names the first region whose corners do not form a border. O(n log n) work.
std::vector<std::int32_t> solve_regions(const geometry::Predicates& predicates, const geometry::Point* points,
                                        const geometry::RegionArrays& regions, TriangulatePoints triangulate,
                                        int threads, research::OperationCounts* counts = nullptr);

/// The number of levels by which to cut n points before this many threads (0: one per core) solve the
/// regions: `wanted` if that is positive, otherwise enough for several regions per thread, but none tiny.
int levels_for(std::size_t n, int wanted, int threads);

}  // namespace flaunay::partition
