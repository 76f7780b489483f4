// An exact, independent check of a triangulation on the host. Shares no code with the kernels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace flaunay {

/// The result of verify. ok is true if and only if problem is empty.
struct VerifyReport {
  bool ok = true;
  std::string problem;  ///< the first violation, naming the triangle or point and its coordinates
  std::size_t points = 0;
  std::size_t distinct_points = 0;
  std::size_t triangles = 0;
  std::size_t hull_vertices = 0;      ///< points on the boundary, collinear ones included
  std::size_t cocircular_edges = 0;   ///< interior edges whose two triangles share a circle
  std::size_t constraint_edges = 0;   ///< those that segments are made of, if there are segments
  std::size_t excused_triangles = 0;  ///< with a smaller angle than asked for, which the input has
  std::size_t exact_evaluations = 0;  ///< predicates that floating point could not decide
};

/// Checks, exactly and for any finite input: every index valid; every triangle counter-clockwise; each
/// directed edge once; edges without a twin form one closed convex counter-clockwise cycle (points on its
/// edges allowed) that is the convex hull; every distinct point used (duplicates: exactly one index of each
/// group); every interior edge locally Delaunay (which makes the whole Delaunay); count 2n - 2 - h.
/// All-collinear input: no triangles. coordinates: x0 y0 ..., n points; triangles: 3 per triangle, indices of
/// points. O(n log n).
VerifyReport verify(const double* coordinates, std::size_t n, const std::vector<std::int32_t>& triangles);

/// Also checks the neighbours (3 per triangle: the triangle opposite to each vertex, -1 on the hull).
VerifyReport verify(const double* coordinates, std::size_t n, const std::vector<std::int32_t>& triangles,
                    const std::vector<std::int32_t>& neighbors);

}  // namespace flaunay
