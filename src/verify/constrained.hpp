// An exact, independent check of a constrained Delaunay triangulation on the host, by the definition in
// docs/constrained.md. Shares no code with src/constrained and the kernels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "verify/verify.hpp"

namespace flaunay {

/// Which triangles a result has.
enum class VerifyOutside {
  keep,   ///< all, up to the convex hull
  hull,   ///< without those that are connected with the outside over edges that are no constraints
  holes,  ///< also without those in any other faces between the constraints
};

/// What a constrained triangulation is checked against.
struct VerifyConstraints {
  /// 2 indices of points per segment. Required.
  const std::vector<std::int32_t>* segments = nullptr;
  VerifyOutside outside = VerifyOutside::keep;
  /// If given: the edges that segments are made of, 2 points per edge, and per segment the first of its edges
  /// and the one after its last.
  const std::vector<std::int32_t>* edges = nullptr;
  const std::vector<std::int32_t>* segment_edges = nullptr;
};

/// Checks, exactly and for any finite input: what `verify` checks of triangles, edges and points; that every
/// segment is an edge, or a chain of edges if points are on it; that every other edge is locally Delaunay;
/// that triangles with a common circle that no constraint divides are a fan from their lexicographically
/// smallest vertex; and that the triangles tile the convex hull or, with triangles left out, whole faces
/// between the constraints: every edge with one triangle is on the hull or a constraint. neighbors: null, or
/// 3 per triangle. Segments that cross where no point is are an error, too. O((n + s) log (n + s)) for n
/// points and s segments, whatever overlaps and whatever meets at a point.
VerifyReport verify_constrained(const double* coordinates, std::size_t n,
                                const std::vector<std::int32_t>& triangles,
                                const std::vector<std::int32_t>* neighbors,
                                const VerifyConstraints& constraints);

}  // namespace flaunay
