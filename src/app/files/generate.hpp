// Point sets for demonstrations, tests and benchmarks; the same on every machine for the same seed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "app/files/points.hpp"

namespace flaunay::io {

struct GeneratedPoint {
  double x, y;
};
class Random;

struct Distribution {
  std::string name;
  std::string description;
  /// Makes points [first, first + count) of n. To be called for all of them in their order.
  using MakePoints = std::function<void(std::size_t first, std::size_t count, double* coordinates)>;
  MakePoints (*maker)(std::size_t n, Random& random);
};

/// The known distributions, each with a line of description; the first four are from the paper.
const std::vector<Distribution>& distributions();

/// Makes n points of the named distribution. Throws Error(usage) with the known names if there is no such
/// one.
Points generate(const std::string& distribution, std::size_t n, std::uint64_t seed);

/// Takes the next `count` points: x0 y0 x1 y1 ...
using PointConsumer = std::function<void(const double* coordinates, std::size_t count)>;
/// Hands these points over in pieces; most distributions hold no more than a piece.
void generate(const std::string& distribution, std::size_t n, std::uint64_t seed,
              const PointConsumer& consume);

}  // namespace flaunay::io
