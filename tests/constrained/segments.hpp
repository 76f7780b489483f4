// Segments between given points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/constrained/check.hpp"
#include "tests/support/fixtures.hpp"

namespace flaunay::testing {

/// Between any points.
inline Segments random_segments(FixtureRandom& random, std::size_t points, std::size_t count) {
  Segments segments;
  for (std::size_t i = 0; i < 2 * count && points > 0; ++i) {
    segments.push_back(static_cast<std::int32_t>(random.integer(0, static_cast<std::int64_t>(points) - 1)));
  }
  return segments;
}

/// Segments that do not cross: some edges of a triangulation of the points, stretched so that it is another
// one.
inline Segments edges_of_stretched(const Coordinates& points, double factor, int one_in, std::uint64_t seed) {
  Coordinates stretched = points;
  for (std::size_t i = 0; i < stretched.size(); i += 2) stretched[i] *= factor;
  const Triangulation other = delaunay_of(stretched, {0, points.size() / 2});
  FixtureRandom random(seed);
  Segments segments;
  for (std::size_t c = 0; c < other.triangles.size(); ++c) {
    if (other.neighbors[c] > static_cast<std::int32_t>(c / 3) || random.integer(1, one_in) > 1) continue;
    const std::size_t t = c - c % 3;
    segments.push_back(other.triangles[t + (c + 1) % 3]);
    segments.push_back(other.triangles[t + (c + 2) % 3]);
  }
  return segments;
}

}  // namespace flaunay::testing
