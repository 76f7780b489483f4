#include "constrained/segments.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "flaunay/flaunay.hpp"

namespace flaunay::constrained {

std::size_t set_of(const std::vector<std::size_t>& offsets, std::int32_t point) {
  return std::upper_bound(offsets.begin(), offsets.end(), static_cast<std::size_t>(point)) - offsets.begin() -
         1;
}

void check_segments(const std::vector<std::size_t>& offsets, const std::vector<std::int32_t>& segments) {
  if (segments.size() % 2 != 0) {
    throw Error(ErrorKind::usage,
                fmt::format("segments need two points each, but {} indices were given", segments.size()));
  }
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

}  // namespace flaunay::constrained
