// Weighted points: which triangles hide them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flaunay/flaunay.hpp"

namespace flaunay {

/// Returns for each hidden point the triangle that hides it, exactly: the one of the smallest index that has
/// it inside or on its border. -1 in a set without triangles. points, offsets: those that were triangulated.
/// The triangulation must have neighbours. Throws Error(usage) for arrays that do not fit each other.
/// O(n + h log n) for h hidden points.
FLAUNAY_API std::vector<std::int32_t> hiding_triangles(Triangulator& triangulator, const double* points,
                                                       const std::vector<std::size_t>& offsets,
                                                       const Triangulation& triangulation);

}  // namespace flaunay
