// Arrays derived from regular triangulations: power cells, and the points that are not hidden.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"
#include "host/runtime.hpp"

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

/// See Triangulator::clipped_voronoi; the arrays fit each other.
ClippedVoronoi make_cells(host::Runtime& runtime, const double* points, const double* weights, std::size_t n,
                          const Triangulation& mesh, const std::vector<double>& corners);

}  // namespace flaunay::weighted
