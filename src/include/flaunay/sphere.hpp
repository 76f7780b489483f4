// Places and directions of points on a sphere.
#pragma once

#include <cstddef>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay {

/// Returns x and y per point: its place, as Triangulation::places has it. Throws what
/// Triangulator::triangulate throws for points on the sphere. O(n).
FLAUNAY_API std::vector<double> places_on_sphere(const double* points, std::size_t n,
                                                 SphereCoordinates coordinates);

/// Returns x y z per place: unit vectors, rounded.
FLAUNAY_API std::vector<double> directions_of(const std::vector<double>& places);

}  // namespace flaunay
