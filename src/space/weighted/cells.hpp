// Arrays derived from regular triangulations: power cells, and the points that are not hidden.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "space/spaces.hpp"

namespace flaunay::weighted {

/// The points that are not hidden, and the triangulation of these.
struct Visible {
  std::vector<double> coordinates;
  std::vector<std::size_t> offsets;   ///< sets + 1 values
  std::vector<std::int32_t> numbers;  ///< by visible point, that among all
  Triangulation mesh;
};

/// O(n).
Visible visible_points(const double* points, const std::vector<std::size_t>& offsets,
                       const Triangulation& mesh);

/// See Triangulator::clipped_voronoi.
ClippedVoronoi make_cells(call::Implementation& self, const call::CellInput& input);

}  // namespace flaunay::weighted
