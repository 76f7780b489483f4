// Places of points, and their directions on a sphere.
#pragma once

#include <cstddef>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay {

/// Returns x and y per point: its place, as Triangulation::places has it; in the plane its coordinates,
/// unchecked. Elsewhere throws what Triangulator::triangulate throws for the space and the points. O(n).
FLAUNAY_API std::vector<double> places_of(const double* points, std::size_t n, const Space& space);

/// Returns x y z per place on a sphere: unit vectors, rounded.
FLAUNAY_API std::vector<double> directions_of(const std::vector<double>& places);

}  // namespace flaunay
