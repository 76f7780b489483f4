// On which side of a ring its inside is.
#pragma once

#include <cstddef>

namespace flaunay::io {

/// The sign of the area of a closed polygon of n positions, x0 y0 x1 y1 ..., by exact arithmetic: 1 if it
/// runs counter-clockwise, -1 if clockwise, 0 without an area. Coordinates must be finite.
int ring_orientation(const double* coordinates, std::size_t n);

}  // namespace flaunay::io
