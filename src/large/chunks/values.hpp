// Values at points, such as heights, and the final triangles of a chunk with them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

#include "flaunay/terrain.hpp"

namespace flaunay::chunks {

/// Final triangles of a chunk, as in MeshView, with a value per point.
struct ChunkSurface {
  std::vector<double> coordinates, values;
  std::vector<std::int32_t> triangles, neighbors;
  /// Sides whose other triangle, if there is one, belongs to another chunk, as entries of `neighbors`. There
  /// is the triangle itself.
  std::vector<std::int32_t> open;
};

/// The source of values, and their receiver.
struct Values {
  ValuedPoints& points;
  Duplicates duplicates;
  std::uint64_t fixed = 0;  ///< the first points of the input, this many, whose values take precedence
  /// Several threads may call it.
  std::function<void(ChunkSurface&&)> take;
};

/// The common value of equal points, whatever their order. Sorts the values, at least one.
inline double common_value(std::vector<double>& values, Duplicates duplicates) {
  std::sort(values.begin(), values.end());
  if (duplicates == Duplicates::lowest) return values.front();
  if (duplicates == Duplicates::highest) return values.back();
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace flaunay::chunks
