// The edges of constraints in a triangulation that changes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "flaunay/dynamic.hpp"
#include "updates/mesh.hpp"

namespace flaunay::updates {

class ConstraintEdges {
 public:
  /// No edges.
  ConstraintEdges() = default;
  /// The edges of a triangulation whose points have numbers below `numbers`.
  ConstraintEdges(const ConstrainedTriangulation& mesh, std::size_t numbers);

  bool empty() const { return edges_.empty(); }
  /// Whether a point is the end of an edge.
  bool has_end(std::int32_t v) const { return ends_[static_cast<std::size_t>(v)] != 0; }
  /// The edges by the numbers of their ends. O(n log n).
  LivingConstraints listed(const std::vector<double>& coordinates) const;
  /// Per corner of a triangulation with these edges the segment of the edge opposite, or -1. O(t).
  std::vector<std::int32_t> segments_of_corners(const ConstrainedTriangulation& mesh) const;
  /// Replaces the edges that were split by their parts. Parts may have been split, too. numbers: of points.
  /// If it throws, nothing has changed.
  void split(const std::vector<SplitEdge>& splits, std::size_t numbers);

 private:
  // Per pair of ends the smallest index of a segment that has it.
  std::unordered_map<std::uint64_t, std::int32_t> edges_;
  std::vector<std::uint8_t> ends_;  // per number of a point
};

}  // namespace flaunay::updates
