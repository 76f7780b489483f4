// Polygons on the globe as maps have them: longitudes and latitudes, without a side across the date line.
#pragma once

#include <array>
#include <vector>

namespace flaunay::io {

/// Longitude and latitude in degrees.
using OnGlobe = std::array<double, 2>;
using GlobeRing = std::vector<OnGlobe>;

/// Cuts a polygon whose sides are less than 180 degrees of longitude wide at the date line, and leads it
/// along a pole that it has inside or as a corner, as RFC 7946 (section 3.1.9) has it. corners:
/// counter-clockwise as seen from outside. Rings are not closed.
std::vector<GlobeRing> cut_at_date_line(const GlobeRing& corners);

}  // namespace flaunay::io
