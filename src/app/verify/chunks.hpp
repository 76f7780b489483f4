// The exact check of verify.hpp for triangulations that do not fit memory. Shares no code with the kernels,
// nor with the triangulation in chunks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "app/files/npy.hpp"
#include "flaunay/chunks.hpp"
#include "prove/delaunay_proof.hpp"

namespace flaunay {

/// How much verify_chunks holds in memory at a time.
struct VerifySizes {
  std::uint64_t window_rows = 0;   ///< rows that a thread checks together
  std::uint64_t range_points = 0;  ///< points whose coordinates are held
  std::uint64_t index_ids = 0;     ///< ids that a thread numbers in a pass through a window's rows
  std::uint64_t sort_bytes = 0;    ///< memory of each sort
  std::uint64_t filter_bits = 0;   ///< bits that tell the places of duplicates from most others
  std::size_t piece_rows = 0;      ///< rows or points of a call of a source
  int threads = 0;
};

/// The sizes for this much memory. Throws Error(usage) if it is too little.
VerifySizes verify_sizes(std::uint64_t memory_bytes, std::uint64_t points, std::uint64_t rows, int threads);

struct VerifyChunksOptions {
  std::string scratch;  ///< the folder for data that does not fit memory; empty: TMPDIR, or /tmp
  /// If not empty, called from time to time, from one thread at a time: a stage, and its finished share.
  std::function<void(const std::string& stage, double done)> progress;
};

struct VerifyChunksReport : VerifyReport {
  std::size_t windows = 0;
  std::uint64_t edges_across = 0;   ///< interior edges between triangles of different windows
  std::uint64_t scratch_bytes = 0;  ///< written to the folder
};

/// Makes the checks of verify(), reading everything in pieces. neighbors may be null. Throws Error(input) if
/// a point is not finite, naming it, or if a source or the scratch folder fails. One of several violations is
/// reported: one of the first window, not always the one with the smallest index.
///
/// Rows are taken in windows. The distinct vertices of each window get their coordinates from the points,
/// which are read range after range. A window then checks its triangles, and the edges that two of them
/// share. Half-edges without a twin in their window are sorted by their ends, which brings twins of different
/// windows together; those without twin there are the boundary, which is sorted by coordinates. Points that
/// no row uses are sorted by coordinates, too, together with used points that may be equal.
///
/// Why this is complete, for points that are not all collinear:
///
/// 1. Every triangle is counter-clockwise. Half-edges are paired with others that run the other way, each
///    with at most one. The rest, sorted lexicographically by origin, first those that ascend, then those
///    that descend the other way round, is a sequence in which each begins at the vertex where the one before
///    ends, the first after the last; and it never turns right. So the rest is one convex counter-clockwise
///    polygon: its ascending and its descending vertices are two monotone convex chains between the same
///    two points, and it is not flat, since it encloses the sum of the triangles' areas. Pairs cancel in the
///    sum of the triangles' oriented boundaries. So each point in general position is covered as often as the
///    polygon winds around it: once inside, never outside. The triangles tile a convex polygon.
/// 2. The tiling has no two vertices at one place: the triangles around an inner vertex close, and so cover
///    its surroundings once, with no room for another vertex's; triangles around a boundary vertex cover
///    the polygon's angle there, and the vertices of the polygon are at different places. For the same
///    reason no directed edge occurs twice, although a repeated one need not meet its double in a window; so
///    pairs are the right ones, and neighbours that agree with them are right.
/// 3. Every point that no row uses is equal to a used one. So no point lies inside a triangle or on an edge
///    that does not end there, and the polygon is the convex hull: a triangulation of the distinct points.
/// 4. Each pair's edge is locally Delaunay; by Delaunay's lemma the whole is.
///
/// O(n log n) work. Where rows that are close in the file are close in the plane, few edges lie between
/// windows, and the scratch folder takes about 20 bytes per vertex of a window; rows in random order need up
/// to 320 bytes each.
VerifyChunksReport verify_chunks(PointSource& points, io::RowSource& triangles, io::RowSource* neighbors,
                                 const VerifySizes& sizes, const VerifyChunksOptions& options = {});

}  // namespace flaunay
