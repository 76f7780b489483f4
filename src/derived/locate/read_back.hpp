// Triangulations that are read back from locators.
#pragma once

#include <cstddef>
#include <vector>

#include "derived/locate/locator.hpp"
#include "flaunay/flaunay.hpp"

namespace flaunay::locate {

/// What a locator was made of.
struct ReadMesh {
  std::vector<std::size_t> point_offsets;
  std::vector<double> coordinates;
  Triangulation triangulation;  ///< without what locators do not need
};

/// Reads the mesh of a locator in fixed point. Points that are neither corners nor on the hull, which are
/// equal to others, are taken for the first vertex of their set's hull: answers do not depend on them. Waits
/// 6 times. O(n).
ReadMesh read_back(host::Runtime& runtime, const Locator& locator);

}  // namespace flaunay::locate
