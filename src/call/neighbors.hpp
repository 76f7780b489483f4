// What all queries for several nearest points check.
#pragma once

#include <algorithm>
#include <cstddef>

#include "call/frame.hpp"
#include "flaunay/neighbors.hpp"
#include "geometry/arguments.hpp"

namespace flaunay::call {

/// Throws Error(usage) for options that make no sense, and Error(input) for too many results of m queries.
inline void check(const NeighborOptions& options, std::size_t m) {
  expect(options.count > 0, "the number of nearest points must be 1 or more");
  expect(options.max_distance >= 0, "the largest distance must be 0 or more");
  check_count(options.count, "neighbours of each query",
              std::min(kMostIndexed, kMostCountable / std::max<std::size_t>(m, 1)));
}

}  // namespace flaunay::call
