#include "recursive/points.hpp"

#include <algorithm>
#include <cmath>

namespace flaunay::recursive {
namespace {

Magnitudes inspect(const double* coordinates, std::size_t n) {
  Magnitudes magnitudes;
  for (std::size_t i = 0; i < 2 * n; ++i) {
    const double x = coordinates[i];
    if (!std::isfinite(x)) {
      magnitudes.bad = static_cast<int>(i / 2);
      return magnitudes;
    }
    if (x == 0) continue;
    magnitudes.largest = std::max(magnitudes.largest, std::ilogb(x));
    magnitudes.lowest = std::min(magnitudes.lowest, lowest_bit(x));
  }
  return magnitudes;
}

struct IndexedPoint {
  Point point;
  std::int32_t index;
};

// Counts comparisons of coordinates.
struct Before {
  std::uint64_t* comparisons;
  bool operator()(const IndexedPoint& a, const IndexedPoint& b) const {
    *comparisons += a.point.x == b.point.x ? 2 : 1;
    if (a.point.x != b.point.x) return a.point.x < b.point.x;
    if (a.point.y != b.point.y) return a.point.y < b.point.y;
    return a.index < b.index;
  }
};

}  // namespace

PointSets ingest(const double* coordinates, const std::vector<std::size_t>& offsets) {
  check_offsets(offsets);
  const std::size_t n = offsets.back();
  const Scaling scaling = scaling_for(coordinates, n, inspect(coordinates, n));
  PointSets sets;
  sets.predicates.bounds = scaling.bounds;
  sets.representatives.resize(n);
  sets.points.reserve(n);
  sets.source.reserve(n);
  sets.set_offsets.push_back(0);
  std::vector<IndexedPoint> sorted;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    sorted.clear();
    for (std::size_t i = offsets[s]; i < offsets[s + 1]; ++i) {
      // Adding 0 turns -0 into 0.
      sorted.push_back({{std::ldexp(coordinates[2 * i], scaling.shift) + 0.0,
                         std::ldexp(coordinates[2 * i + 1], scaling.shift) + 0.0},
                        static_cast<std::int32_t>(i)});
    }
    std::sort(sorted.begin(), sorted.end(), Before{&sets.comparisons});
    for (std::size_t k = 0; k < sorted.size(); ++k) {
      if (k == 0 || !(sorted[k].point == sorted[k - 1].point)) {
        sets.points.push_back(sorted[k].point);
        sets.source.push_back(sorted[k].index);
      }
      sets.representatives[sorted[k].index] = sets.source.back();
    }
    sets.set_offsets.push_back(static_cast<std::int32_t>(sets.points.size()));
  }
  return sets;
}

}  // namespace flaunay::recursive
