// Point sets for demonstrations, tests and benchmarks; the same on every machine for the same seed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/points.hpp"

namespace flaunay::io {

struct Distribution {
  std::string name;
  std::string description;
};

/// The known distributions: uniform, normal, kuzmin, line (the paper's four), grid, rotated-grid, hexagonal,
/// circle, integer-circle, nested-circles, columns, small-integers, half-duplicates, collinear, parabola,
/// clusters, spiral, horizontal, thirty-lines, power-of-two-span, one-ulp, mostly-equal, two-clusters.
const std::vector<Distribution>& distributions();

/// n points of the named distribution. Throws Error(usage) that lists the names if there is no such.
Points generate(const std::string& distribution, std::size_t n, std::uint64_t seed);

}  // namespace flaunay::io
