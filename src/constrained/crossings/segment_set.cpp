#include "constrained/crossings/segment_set.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "flaunay/flaunay.hpp"

namespace flaunay::constrained {
using namespace geometry;

void check_segments(const std::vector<std::size_t>& offsets, const Ids& segments) {
  const auto n = static_cast<std::int32_t>(offsets.back());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (segments[i] < 0 || segments[i] >= n) {
      throw Error(ErrorKind::usage,
                  fmt::format("segment {} has point {}, but there are {} points", i / 2, segments[i], n));
    }
    if (i % 2 == 0 || offsets.size() == 2) continue;
    if (set_of(offsets, segments[i - 1]) != set_of(offsets, segments[i])) {
      throw Error(ErrorKind::usage, fmt::format("segment {} joins points {} and {} of different sets", i / 2,
                                                segments[i - 1], segments[i]));
    }
  }
}

std::size_t set_of(const std::vector<std::size_t>& offsets, std::int32_t point) {
  const auto next = std::upper_bound(offsets.begin(), offsets.end(), static_cast<std::size_t>(point));
  return static_cast<std::size_t>(next - offsets.begin()) - 1;
}

std::vector<Ids> segments_of_sets(const double* coordinates, const std::vector<std::size_t>& offsets,
                                  const Ids& segments) {
  std::vector<Ids> by_set(offsets.size() - 1);
  std::size_t set = 0;
  for (std::size_t s = 0; s < segments.size() / 2; ++s) {
    const auto from = static_cast<std::size_t>(segments[2 * s]),
               to = static_cast<std::size_t>(segments[2 * s + 1]);
    if (coordinates[2 * from] == coordinates[2 * to] && coordinates[2 * from + 1] == coordinates[2 * to + 1])
      continue;
    if (from < offsets[set] || from >= offsets[set + 1]) set = set_of(offsets, segments[2 * s]);
    by_set[set].push_back(static_cast<std::int32_t>(s));
  }
  return by_set;
}

SegmentSet::SegmentSet(const double* coordinates, const std::vector<std::size_t>& offsets, std::size_t set,
                       const Ids& segments, const Ids& numbers)
    : first(static_cast<std::int32_t>(offsets[set])),
      points(ingest(coordinates + 2 * offsets[set], {0, offsets[set + 1] - offsets[set]})),
      vertices(coordinates + 2 * offsets[set], points, 0) {
  Ids rank(points.representatives.size());
  for (std::size_t i = 0; i < points.source.size(); ++i) {
    rank[points.source[i]] = static_cast<std::int32_t>(i);
  }
  const auto vertex = [&](std::int32_t i) { return rank[points.representatives[i - first]]; };
  pieces.reserve(numbers.size());
  for (const std::int32_t s : numbers) {
    const std::int32_t a = vertex(segments[2 * s]), b = vertex(segments[2 * s + 1]);
    pieces.push_back({std::min(a, b), std::max(a, b)});
  }
}

}  // namespace flaunay::constrained
