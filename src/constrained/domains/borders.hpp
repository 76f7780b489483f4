// The walk from outside over the borders between regions, one region after the other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "constrained/fill_rules.h"

namespace flaunay::constrained {

/// Computes the levels of regions, and their potentials: the sums of what is crossed from outside. between:
/// two regions per border, of which the first may be -1, the outside. steps: what is crossed from the first
/// one to the second one. levels: those of regions that are known are right, and there are none beyond the
/// largest of them that are not known; others are UNREACHED. O(regions + borders).
inline void walk_borders(const std::vector<std::int32_t>& between, const std::vector<std::int32_t>& steps,
                         std::vector<std::int32_t>& levels, std::vector<std::int32_t>& potentials) {
  const auto outside = static_cast<std::int32_t>(levels.size());
  levels.push_back(0);
  potentials.push_back(0);
  const auto region = [&](std::size_t end) { return between[end] < 0 ? outside : between[end]; };
  // The ends of borders, grouped by region.
  std::vector<std::int32_t> offsets(levels.size() + 1, 0), ends(between.size());
  for (std::size_t end = 0; end < between.size(); ++end) ++offsets[region(end) + 1];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  std::vector<std::int32_t> place(offsets.begin(), offsets.end() - 1);
  for (std::size_t end = 0; end < between.size(); ++end) {
    ends[place[region(end)]++] = static_cast<std::int32_t>(end);
  }
  std::vector<std::int32_t> queue;
  for (std::int32_t r = 0; r <= outside; ++r) {
    if (levels[r] != kernel::UNREACHED) queue.push_back(r);
  }
  std::stable_sort(queue.begin(), queue.end(),
                   [&](std::int32_t a, std::int32_t b) { return levels[a] < levels[b]; });
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const std::int32_t from = queue[head];
    for (std::int32_t i = offsets[from]; i < offsets[from + 1]; ++i) {
      const std::int32_t end = ends[i], to = region(static_cast<std::size_t>(end ^ 1));
      if (levels[to] != kernel::UNREACHED) continue;
      levels[to] = levels[from] + 1;
      potentials[to] = potentials[from] + (end % 2 == 0 ? steps[end / 2] : -steps[end / 2]);
      queue.push_back(to);
    }
  }
  levels.pop_back();
  potentials.pop_back();
}

}  // namespace flaunay::constrained
