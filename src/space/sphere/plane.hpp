// The plane in which points of a sphere are triangulated.
#pragma once

#include <cstdint>
#include <vector>

#include "space/sphere/places.hpp"

namespace flaunay::sphere {

/// The points that have a place in the plane.
struct Plane {
  const std::vector<double>* all = nullptr;  ///< of the sphere, if none is at the pole
  std::vector<double> some;
  std::vector<std::size_t> offsets;
  std::vector<std::int32_t> points;              ///< per place; empty if all points have one
  std::vector<std::vector<std::int32_t>> poles;  ///< per set, the points at the south pole

  const std::vector<double>& places() const { return all != nullptr ? *all : some; }
};

/// Finds the points at the pole, if there are some; the others are those of the plane.
Plane make_plane(const std::vector<double>& places, const std::vector<std::size_t>& offsets,
                 bool has_pole = true);

/// Numbers the arrays of a triangulation of the plane by the n points of the sphere.
void number_by_points(const Plane& plane, std::size_t n, Triangulation& planar);

/// Takes the triangulation of the plane out of that of the sphere, for its locator: triangles, neighbours,
/// hulls and representatives, numbered as the plane's points. O(t + h log h).
Triangulation planar_part(const Plane& plane, const Triangulation& mesh);

}  // namespace flaunay::sphere
