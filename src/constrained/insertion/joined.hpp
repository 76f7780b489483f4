// Segments that overlap, joined on the host to segments that do not, so that they have each edge once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "constrained/crossings/pairs.hpp"

namespace flaunay::constrained {

class JoinedSegments {
 public:
  /// ends: two vertices per segment; both are -1 for segments without edges.
  JoinedSegments(const std::vector<double>& coordinates, const std::vector<std::size_t>& offsets,
                 std::vector<std::int32_t> ends);

  /// The ends of the joined segments, two each.
  const std::vector<std::int32_t>& joined() const { return joined_; }
  /// The edges of each segment, as in ConstrainedTriangulation::piece_edges. edges: all constraint edges.
  /// ranges: of the joined segments.
  std::vector<std::int32_t> segment_edges(const std::vector<std::int32_t>& edges,
                                          const std::vector<std::int32_t>& ranges) const;

 private:
  // Whether a vertex is lexicographically smaller than another one of its set.
  bool comes_before(std::int32_t u, std::int32_t v) const;

  const std::vector<double>& coordinates_;
  std::vector<std::int32_t> ends_, joined_;
  std::vector<std::int32_t> joined_of_;  // by segment, or -1
};

}  // namespace flaunay::constrained
