// How many triangles regions without internal points have.
#pragma once

#include <cstddef>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/support/regions.hpp"

namespace flaunay::testing {

/// How many triangles a region without internal points has: k - 2 for each closed walk of k corners.
inline std::size_t triangle_count_twin(const std::vector<Corner>& corners) {
  std::map<std::pair<int, int>, std::size_t> corner_after;  // by directed edge (before, vertex)
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (!corner_after.emplace(std::make_pair(corners[c].before, corners[c].vertex), c).second) {
      throw std::logic_error("a border edge of two corners");
    }
  }
  std::size_t walks = 0;
  std::vector<bool> seen(corners.size(), false);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    walks += !seen[c];
    for (std::size_t at = c; !seen[at];) {
      seen[at] = true;
      at = corner_after.at({corners[at].vertex, corners[at].after});
    }
  }
  return corners.size() - 2 * walks;
}

}  // namespace flaunay::testing
