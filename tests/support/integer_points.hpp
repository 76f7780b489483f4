// Points with integer coordinates: many duplicates, collinear and cocircular ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace flaunay::testing {

/// Random ones with coordinates from 0 to `range`.
inline std::vector<double> random_integer_points(std::size_t n, int range, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> integer(0, range);
  std::vector<double> coordinates(2 * n);
  for (double& value : coordinates) value = integer(random);
  return coordinates;
}

/// Those of a grid, row by row.
inline std::vector<double> grid_points(int columns, int rows) {
  std::vector<double> coordinates;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) coordinates.insert(coordinates.end(), {double(x), double(y)});
  }
  return coordinates;
}

}  // namespace flaunay::testing
