// Point sets of which a round of blocks or of chunks finishes little or nothing.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/fixtures.hpp"

namespace flaunay::testing {

/// n points as close to one another as doubles allow, around each of several points.
inline Coordinates one_ulp_clouds(std::size_t n, std::size_t clouds, std::uint64_t seed) {
  FixtureRandom random(seed);
  const Coordinates centres = make_fixture("uniform", clouds, seed);
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    for (const std::size_t c : {0, 1}) {
      const double centre = centres[2 * (i % clouds) + c] + 1;
      points.push_back(centre + static_cast<double>(random.integer(-4, 4)) * 0x1p-52);
    }
  }
  return points;
}

/// Uniform cells, 2^20 times as long as wide: circles reach beyond any block.
inline Coordinates long_thin_cells(std::size_t n, std::uint64_t seed) {
  Coordinates points = make_fixture("uniform", n, seed);
  for (std::size_t i = 0; i < points.size(); i += 2) points[i] *= 0x1p20;
  return points;
}

/// On lines in all directions.
inline Coordinates on_lines(std::size_t n, std::size_t lines, std::uint64_t seed) {
  return fixtures_detail::on_lines(n, seed, lines);
}

/// A square lattice, turned by an angle that rounds its coordinates.
inline Coordinates turned_lattice(std::size_t n) {
  const auto width = static_cast<std::size_t>(std::sqrt(static_cast<double>(n)));
  Coordinates points;
  for (std::size_t i = 0; i < n; ++i) {
    const auto x = static_cast<double>(i % width), y = static_cast<double>(i / width);
    points.push_back(0.8 * x - 0.6 * y);
    points.push_back(0.6 * x + 0.8 * y);
  }
  return points;
}

/// Of which a round emits little or nothing.
inline std::vector<std::pair<std::string, Coordinates>> stalling(std::size_t n, std::uint64_t seed) {
  Coordinates columns;
  FixtureRandom random(seed);
  for (std::size_t i = 0; i < n; ++i) {
    columns.push_back(static_cast<double>(i % 3));
    columns.push_back(static_cast<double>(random.integer(0, 1000000)));
  }
  return {{"circle", make_fixture("circle", n, seed)},
          {"integer circle", make_fixture("integer-circle", n, seed)},
          {"columns", columns},
          {"long thin cells", long_thin_cells(n, seed)},
          {"one-ulp clouds", one_ulp_clouds(n, 5, seed)},
          {"30 lines", on_lines(n, 30, seed)},
          {"turned lattice", turned_lattice(n)},
          {"perturbed lattice", perturbed(turned_lattice(n), seed)},
          {"collinear", make_fixture("collinear", n, seed)}};
}

}  // namespace flaunay::testing
