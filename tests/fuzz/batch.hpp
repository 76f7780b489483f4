// Batches of point sets, as the fuzzer of the triangulation makes and shrinks them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/fixtures.hpp"

namespace flaunay::fuzz {

using testing::Coordinates;

/// One entry per set: x0 y0 x1 y1 ...
using Batch = std::vector<Coordinates>;

/// Points, and segments between them: 2 indices each.
struct SegmentSet {
  Coordinates points;
  std::vector<std::int32_t> segments;
};
using SegmentBatch = std::vector<SegmentSet>;

inline std::size_t points_of(const Batch& batch) {
  std::size_t points = 0;
  for (const Coordinates& set : batch) points += set.size() / 2;
  return points;
}

}  // namespace flaunay::fuzz
