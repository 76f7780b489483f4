// The twin of the stage `border`: the convex hull of a set.
#pragma once

#include <vector>

#include "tests/support/exact_points.hpp"

namespace flaunay::testing {

/// The convex hull of ascending ids with the points on its edges, counter-clockwise from the smallest id;
/// collinear ids as they are.
inline std::vector<int> border_twin(const ExactPoints& points, const std::vector<int>& ids, bool& collinear) {
  collinear = true;
  for (std::size_t i = 2; i < ids.size(); ++i) collinear &= points.orient(ids[0], ids[1], ids[i]) == 0;
  if (collinear) return ids;
  const auto half = [&](const std::vector<int>& in_order) {
    std::vector<int> chain;
    for (const int id : in_order) {
      while (chain.size() >= 2 && points.orient(chain[chain.size() - 2], chain.back(), id) < 0)
        chain.pop_back();
      chain.push_back(id);
    }
    return chain;
  };
  std::vector<int> border = half(ids);
  const std::vector<int> upper = half({ids.rbegin(), ids.rend()});
  border.insert(border.end(), upper.begin() + 1, upper.end() - 1);
  return border;
}

}  // namespace flaunay::testing
