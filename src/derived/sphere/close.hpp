// What a triangulation of places in the plane lacks on the sphere: the triangles around the south pole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/sphere.hpp"

namespace flaunay::sphere {

/// One set of a plane's triangulation, with the numbers of points and triangles that it has on the sphere.
struct PlanarSet {
  const std::int32_t* hull;  ///< its vertices, counter-clockwise; collinear points in their order
  std::size_t hull_size;
  std::size_t first_triangle, last_triangle;
  std::int32_t pole;  ///< the point at the south pole, or -1
};

/// Appends the set's triangles beyond its hull to those of the mesh, which are the plane's, and makes all of
/// them neighbours. Expected O(h log h) for h vertices of the hull, besides O(t).
void close(const PlanarSet& set, SphericalTriangulation& mesh);

}  // namespace flaunay::sphere
