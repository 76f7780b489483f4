#include "constrained/insertion/joined.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "constrained/crossings/lines.hpp"
#include "constrained/crossings/segment_set.hpp"
#include "geometry/magnitudes.hpp"
#include "geometry/sort.hpp"

namespace flaunay::constrained {
using namespace geometry;

JoinedSegments::JoinedSegments(const std::vector<double>& coordinates,
                               const std::vector<std::size_t>& offsets, Ids ends)
    : coordinates_(coordinates), ends_(std::move(ends)), joined_of_(ends_.size() / 2, -1) {
  const SetScalings scalings =
      set_scalings(coordinates.data(), offsets, [&coordinates](std::size_t first, std::size_t last) {
        return inspect(coordinates.data(), first, last);
      });
  Predicates predicates;
  predicates.bounds = scalings.bounds;
  std::vector<Ids> by_set(offsets.size() - 1);
  for (std::size_t s = 0; s < joined_of_.size(); ++s) {
    if (ends_[2 * s] < 0) continue;
    if (comes_before(ends_[2 * s + 1], ends_[2 * s])) std::swap(ends_[2 * s], ends_[2 * s + 1]);
    by_set[set_of(offsets, ends_[2 * s])].push_back(static_cast<std::int32_t>(s));
  }
  for (std::size_t set = 0; set < by_set.size(); ++set) {
    // The ends of pieces are numbered by segments.
    std::vector<Point> points;
    std::vector<Piece> pieces;
    for (const std::int32_t s : by_set[set]) {
      const auto end = static_cast<std::int32_t>(points.size());
      pieces.push_back({end, end + 1});
      for (std::size_t k = 0; k < 2; ++k) {
        const double* const p = &coordinates[2 * static_cast<std::size_t>(ends_[2 * s + k])];
        points.push_back(
            {std::ldexp(p[0], scalings.shift(set)) + 0.0, std::ldexp(p[1], scalings.shift(set)) + 0.0});
      }
    }
    Ids line_of;
    const auto before = static_cast<std::int32_t>(joined_.size() / 2);
    for (const Piece line : join_pieces(predicates, points.data(), pieces, line_of)) {
      for (const std::int32_t end : {line.from, line.to}) {
        joined_.push_back(ends_[2 * by_set[set][end / 2] + end % 2]);
      }
    }
    for (std::size_t k = 0; k < line_of.size(); ++k) joined_of_[by_set[set][k]] = before + line_of[k];
  }
}

Ids JoinedSegments::segment_edges(const Ids& edges, const Ids& ranges) const {
  std::vector<Keyed> by_line;
  for (std::size_t s = 0; s < joined_of_.size(); ++s) {
    if (joined_of_[s] < 0) continue;
    by_line.push_back({static_cast<std::uint64_t>(joined_of_[s]), static_cast<std::int32_t>(s)});
  }
  sort_by_key(by_line);
  // Per vertex on a line the edge that begins there, or after the last vertex one more.
  Ids edge_from(coordinates_.size() / 2), result(ends_.size(), 0);
  for (std::size_t i = 0; i < by_line.size(); ++i) {
    const std::uint64_t line = by_line[i].key;
    if (i == 0 || line != by_line[i - 1].key) {
      for (std::int32_t e = ranges[2 * line]; e < ranges[2 * line + 1]; ++e) {
        edge_from[edges[2 * e]] = e;
        edge_from[edges[2 * e + 1]] = e + 1;
      }
    }
    const auto s = static_cast<std::size_t>(by_line[i].index);
    for (std::size_t k = 0; k < 2; ++k) result[2 * s + k] = edge_from[ends_[2 * s + k]];
  }
  return result;
}

bool JoinedSegments::comes_before(std::int32_t u, std::int32_t v) const {
  const double *p = &coordinates_[2 * static_cast<std::size_t>(u)],
               *q = &coordinates_[2 * static_cast<std::size_t>(v)];
  return std::tie(p[0], p[1]) < std::tie(q[0], q[1]);
}

}  // namespace flaunay::constrained
