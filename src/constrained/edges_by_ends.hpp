// Edges that are found by their ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace flaunay::constrained {

/// Finds edges by their ends. Each is kept at the one that has fewer edges: in a plane, few are looked
/// through.
class EdgesByEnds {
 public:
  using Ids = std::vector<std::int32_t>;

  /// ends: 2 points per edge, which must not change; points: their number.
  EdgesByEnds(const Ids& ends, std::size_t points)
      : ends_(ends), degrees_(points, 0), first_(points + 1, 0), edges_(ends.size() / 2) {
    for (const std::int32_t v : ends) ++degrees_[v];
    for (std::size_t e = 0; e < edges_.size(); ++e) ++first_[keeper(ends[2 * e], ends[2 * e + 1])];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    for (std::size_t e = 0; e < edges_.size(); ++e)
      edges_[--first_[keeper(ends[2 * e], ends[2 * e + 1])]] = static_cast<std::int32_t>(e);
  }
  /// The number of the edge with these ends; there must be one.
  std::int32_t number(std::int32_t a, std::int32_t b) const {
    const std::int32_t at = keeper(a, b), other = a == at ? b : a;
    std::size_t k = first_[at];
    while (ends_[2 * static_cast<std::size_t>(edges_[k])] != other &&
           ends_[2 * static_cast<std::size_t>(edges_[k]) + 1] != other)
      ++k;
    return edges_[k];
  }

 private:
  std::int32_t keeper(std::int32_t a, std::int32_t b) const {
    return degrees_[a] < degrees_[b] || (degrees_[a] == degrees_[b] && a < b) ? a : b;
  }

  const Ids& ends_;
  Ids degrees_, first_, edges_;
};

}  // namespace flaunay::constrained
