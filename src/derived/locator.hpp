// Where queries lie in a triangulation.
#pragma once

#include "derived/mesh.hpp"
#include "derived/query_range.hpp"
#include "hybrid/cut_tree.hpp"

namespace flaunay::derived {

/// As locate.cl has them.
struct Face {
  cl_int corners[3], neighbors[3];
};
struct MeshSet {
  cl_int nodes, depth, starts, triangles, hull, hull_end;
};

/// What queries need of a triangulation, in device memory of its own: some 80 bytes a point.
struct Locator {
  std::size_t sets = 0;
  Magnitudes magnitudes{};  ///< of the points as given
  int shift = 0;            ///< points are scaled by 2^shift
  /// Vertices of triangles, in the order of their first triangles: where they are, their indices among the
  /// points, those triangles, how near their neighbours are.
  Buffer<cl_double2> points{};
  Buffer<cl_int> source{}, first_triangle{}, clearances{};
  Buffer<Face> faces{};  ///< of vertices
  Buffer<cl_double2> hull_points{};
  Buffer<cl_int> hull{};
  Buffer<MeshSet> records{};        ///< by set
  Buffer<hybrid::CutNode> nodes{};  ///< of all sets' trees
  Buffer<cl_int> starts{};          ///< by leaf of all trees: where walks begin
};

/// Its buffers come from `own`, which must stay as long as it. Throws Error(input) for indices that are not
/// those of a triangulation with neighbours, and for points that could not be triangulated. Waits some 6
/// times. O(n log n).
Locator make_locator(host::Runtime& runtime, Arena& own, const Mesh& mesh);

// Queries: m points, x0 y0 x1 y1 ..., aligned as elements only; those of set s are [query_offsets[s],
// query_offsets[s + 1]). Each call waits 2 times, or 3 if queries are sorted, to see that all are finite and
// not too fine nor too far beside the points (else Error(input) that names one), and enqueues the rest. Many
// queries are answered in the order of the trees' leaves, which takes one wait more. Temporary: 24 m bytes,
// 32 m of many queries.

/// For each query the triangle that it lies in, the smallest of several; -1 outside of the hull.
void locate(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& queries, std::size_t m,
            const std::vector<std::size_t>& query_offsets, const Buffer<cl_int>& triangles);

/// For each query the nearest point, the lexicographically first of several, by the index of its
/// representative; -1 if its set is empty. A query takes some steps for each neighbour of its nearest point,
/// unless it is nearer to that than half the distance to the point's own nearest one.
void nearest(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& queries, std::size_t m,
             const std::vector<std::size_t>& query_offsets, const Buffer<cl_int>& points);

/// For each query the linear interpolation of its triangle's three values; NaN outside of the hull. values:
/// one for each point.
void interpolate(host::Runtime& runtime, const Locator& locator, const Buffer<cl_double>& values,
                 const Buffer<cl_double>& queries, std::size_t m,
                 const std::vector<std::size_t>& query_offsets, const Buffer<cl_double>& results);

}  // namespace flaunay::derived
