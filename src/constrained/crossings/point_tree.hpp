// A tree of boxes around points, which finds the points near a segment.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "constrained/crossings/crossing.hpp"
#include "geometry/sort.hpp"

namespace flaunay::constrained {

/// Finds points near segments. Each node has half of its parent's points. O(n log n) to build, and O(n)
/// memory.
class PointTree {
 public:
  /// points: their coordinates, by index; ids: those that the tree has. Magnitudes must be below `largest`.
  PointTree(const geometry::Point* points, std::vector<std::int32_t> ids, double largest)
      : ids_(std::move(ids)), rounding_(0x1p-50 * largest) {
    if (ids_.empty()) return;
    const std::vector<geometry::Keyed> order =
        geometry::sort_by_place(ids_, [points](std::int32_t id) { return points[id]; });
    points_.reserve(ids_.size());
    for (const std::int32_t id : ids_) points_.push_back(points[id]);
    build(order, 0, static_cast<std::int32_t>(ids_.size()));
  }

  /// Calls visit(id) with all points whose distance from the segment is at most `distance` in both
  /// coordinates, and with some that are farther away. Returns how many boxes it has looked at.
  template <typename Visit>
  std::size_t visit_near(const Line& segment, double distance, const Visit& visit) const {
    return ids_.empty() ? 0 : visit_near(0, segment, distance, visit);
  }

 private:
  static constexpr std::int32_t kLeaf = 8;

  // Its first child follows it.
  struct Node {
    Box box{{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
    std::int32_t begin, end;  // its points
    std::int32_t second;      // child; 0 in a leaf
  };

  // Cells of the curve are halved, and points that are all at one place of it by their number.
  void build(const std::vector<geometry::Keyed>& order, std::int32_t begin, std::int32_t end) {
    const std::size_t node = nodes_.size();
    nodes_.push_back({{}, begin, end, 0});
    Box box{{HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL}};
    if (end - begin <= kLeaf) {
      for (std::int32_t k = begin; k < end; ++k) box = joined(box, {points_[k], points_[k]});
    } else {
      const std::uint64_t first = order[begin].key, last = order[end - 1].key;
      std::int32_t middle = begin + (end - begin) / 2;
      if (first != last) {
        std::uint64_t bit = 1;
        while (bit <= (first ^ last) / 2) bit *= 2;
        const auto split =
            std::partition_point(order.begin() + begin, order.begin() + end,
                                 [bit](const geometry::Keyed& k) { return (k.key & bit) == 0; });
        middle = static_cast<std::int32_t>(split - order.begin());
      }
      build(order, begin, middle);
      const auto second = static_cast<std::int32_t>(nodes_.size());
      build(order, middle, end);
      nodes_[node].second = second;
      box = joined(nodes_[node + 1].box, nodes_[second].box);
    }
    nodes_[node].box = box;
  }
  static Box joined(const Box& p, const Box& q) {
    return {{std::min(p.low.x, q.low.x), std::min(p.low.y, q.low.y)},
            {std::max(p.high.x, q.high.x), std::max(p.high.y, q.high.y)}};
  }

  template <typename Visit>
  std::size_t visit_near(std::int32_t n, const Line& segment, double distance, const Visit& visit) const {
    const Node& node = nodes_[n];
    if (!may_be_near(node.box, segment, distance + rounding_)) return 1;
    if (node.second != 0) {
      return 1 + visit_near(n + 1, segment, distance, visit) +
             visit_near(node.second, segment, distance, visit);
    }
    for (std::int32_t k = node.begin; k < node.end; ++k) {
      if (may_be_near({points_[k], points_[k]}, segment, distance + rounding_)) visit(ids_[k]);
    }
    return 1 + static_cast<std::size_t>(node.end - node.begin);
  }

  std::vector<std::int32_t> ids_;
  std::vector<geometry::Point> points_;  // of the ids
  std::vector<Node> nodes_;
  double rounding_;
};

}  // namespace flaunay::constrained
