// Segments between given points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/constrained/check.hpp"
#include "tests/support/fixtures.hpp"
#include "tests/support/integer_points.hpp"

namespace flaunay::testing {

/// Between any points.
inline Segments random_segments(FixtureRandom& random, std::size_t points, std::size_t count) {
  Segments segments;
  for (std::size_t i = 0; i < 2 * count && points > 0; ++i) {
    segments.push_back(static_cast<std::int32_t>(random.integer(0, static_cast<std::int64_t>(points) - 1)));
  }
  return segments;
}

/// Segments that do not cross: some edges of a triangulation of the points, stretched so that it is
/// another one.
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

struct SetsWithSegments {
  Coordinates points;
  std::vector<std::size_t> offsets = {0};
  Segments segments;
};

/// Small sets, every fifth on a line, whose magnitudes differ by more than one scaling allows. Segments in
/// sets on lines overlap, and go through points; others do not. They can be left out.
inline SetsWithSegments several_sets(int count, bool with_lines) {
  FixtureRandom random(5);
  SetsWithSegments all;
  for (int s = 0; s < count; ++s) {
    const bool is_line = s % 5 == 0;
    Coordinates set = random_integer_points(static_cast<std::size_t>(random.integer(0, 12)), 5, 100 + s);
    if (is_line) {
      for (std::size_t i = 1; i < set.size(); i += 2) set[i] = 2 * set[i - 1];
    }
    for (double& c : set) c *= s % 3 == 0 ? 0x1p-400 : 0x1p400;
    const auto first = static_cast<std::int32_t>(all.offsets.back());
    all.points.insert(all.points.end(), set.begin(), set.end());
    all.offsets.push_back(all.points.size() / 2);
    Segments own = edges_of_stretched(set, 4, 2, 100 + static_cast<std::uint64_t>(s));
    if (is_line && with_lines) own = random_segments(random, set.size() / 2, 4);
    for (const std::int32_t v : own) all.segments.push_back(first + v);
  }
  return all;
}

}  // namespace flaunay::testing
