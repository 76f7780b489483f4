// An exact check of triangulations of sets of points in the plane, with weights or without.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay::prove {

/// A triangulation together with its points.
struct PlanarClaim {
  const double* points;
  const double* weights;  ///< one per point; null: none has one
  const std::vector<std::size_t>& offsets;
  const Triangulation& mesh;                   ///< its arrays have sizes and indices that fit each other
  const std::vector<std::int32_t>& neighbors;  ///< its neighbours
  const std::vector<std::int32_t>& hidden;     ///< ascending; see Triangulation
};

/// Finds an error in a Delaunay triangulation, or with weights a regular one, or in any of its arrays; empty
/// if all is right. O(n log n), and for h hidden points O(h) steps from one to the next.
std::string find_problem(const PlanarClaim& claim);

/// Throws Violation for half-edges that do not fit neighbours, and for wrong areas of triangles; either may
/// be empty. O(n).
void check_halfedges_and_areas(const double* points, const Triangulation& mesh,
                               const std::vector<std::int32_t>& neighbors);

/// The triangles beyond the edges opposite to corners, or -1; unspecified where an edge is there twice. O(n).
std::vector<std::int32_t> neighbors_of(const std::vector<std::int32_t>& triangles, std::size_t n);

}  // namespace flaunay::prove
