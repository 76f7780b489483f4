#include "constrained/carry.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "mesh/rows.hpp"

namespace flaunay::constrained {

using Ids = std::vector<std::int32_t>;

void carry_split(const AllPoints& all, Split&& split, ConstrainedTriangulation& result) {
  for (Ids* vertices : {&result.triangles, &result.hull, &result.constraint_edges, &result.representatives}) {
    for (std::int32_t& v : *vertices) v = all.index[v];
  }
  mesh::permute(all.index, 1, result.representatives);
  result.piece_offsets = std::move(split.piece_offsets);
  Ids segment_of(result.piece_edges.size() / 2);
  for (std::size_t s = 0; s + 1 < result.piece_offsets.size(); ++s) {
    std::fill(segment_of.begin() + result.piece_offsets[s], segment_of.begin() + result.piece_offsets[s + 1],
              static_cast<std::int32_t>(s));
  }
  for (std::int32_t& piece : result.edge_segments) piece = segment_of[piece];
  result.added_points = std::move(split.added_points);
  result.added_offsets = std::move(split.added_offsets);
}

void carry_markers(const Constraints& constraints, std::size_t n, ConstrainedTriangulation& result) {
  const std::int32_t* const of_segments = constraints.segment_markers;
  if (of_segments != nullptr) {
    result.edge_markers.clear();
    for (const std::int32_t segment : result.edge_segments) {
      result.edge_markers.push_back(of_segments[segment]);
    }
  }
  if (constraints.point_markers == nullptr) return;
  result.vertex_markers.assign(constraints.point_markers, constraints.point_markers + n);
  constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();
  Ids first(result.added_points.size() / 2, kNone);
  for (std::size_t i = 0; i < result.constraint_edges.size(); ++i) {
    const auto v = static_cast<std::size_t>(result.constraint_edges[i]);
    if (v >= n) first[v - n] = std::min(first[v - n], result.edge_segments[i / 2]);
  }
  for (const std::int32_t segment : first) {
    result.vertex_markers.push_back(of_segments != nullptr && segment != kNone ? of_segments[segment] : 0);
  }
}

}  // namespace flaunay::constrained
