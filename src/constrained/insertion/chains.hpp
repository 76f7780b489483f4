// The canonical constrained Delaunay triangulations of many polygons at once, on a device.
#pragma once

#include <cstddef>
#include <limits>

#include "host/runtime.hpp"

namespace flaunay::constrained {

using host::Buffer;

/// Chains of vertices, each left of the base between its ends; see PolygonTriangulator. Chain c has the
/// vertices [offsets[c], offsets[c + 1]) of `chain`, at least two.
struct DeviceChains {
  std::size_t count = 0;
  std::size_t vertices = 0;  ///< no fewer than offsets[count]
  /// No chain has more vertices. A small number spares work.
  std::size_t longest = std::numeric_limits<std::size_t>::max();
  float circle_bound = 0;       ///< of in-circle tests, see predicates/bounds.h
  Buffer<cl_double2> points{};  ///< scaled
  Buffer<cl_int> offsets{};     ///< count + 1
  Buffer<cl_int> chain{};       ///< indices of points
};

/// Writes the triangles of chain c, which are three positions in the chain each, to the rows of `triangles`
/// from offsets[c] - 2 * c on. They are PolygonTriangulator's, in its order. So the child of row r = (i, j,
/// k) at the chord (i, j) is row r + 1, if j - i > 1, and the child at (j, k) is row r + j - i, if k - j > 1.
/// Chains may be followed by empty ones, which are only counted. Temporary memory: 56 bytes per vertex, and
/// 87 more per vertex of a long chain. Waits only if chains may be long for a work-item.
void triangulate_chains(host::Runtime& runtime, const DeviceChains& chains, const Buffer<cl_int>& triangles);

}  // namespace flaunay::constrained
