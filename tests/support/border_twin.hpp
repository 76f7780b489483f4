// The twin of the stage `border`: the convex hulls of sets, and the first regions.
#pragma once

#include <CL/cl.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include "tests/support/exact_points.hpp"
#include "tests/support/regions.hpp"

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

struct BordersTwin {
  std::vector<int> hull;
  std::vector<std::size_t> hull_offsets{0};
  std::size_t triangles = 0;
  Regions regions;
  std::vector<bool> on_border;  ///< by id; collinear sets have nothing else
};

inline BordersTwin borders_twin(const ExactPoints& points, const std::vector<cl_int>& set_offsets,
                                const std::vector<cl_int>& y_order) {
  BordersTwin twin;
  twin.on_border.assign(points.size(), false);
  for (std::size_t s = 0; s + 1 < set_offsets.size(); ++s) {
    std::vector<int> ids(static_cast<std::size_t>(set_offsets[s + 1] - set_offsets[s]));
    std::iota(ids.begin(), ids.end(), set_offsets[s]);
    bool collinear = false;
    const std::vector<int> hull = border_twin(points, ids, collinear);
    const std::size_t h = hull.size();
    for (const int id : hull) twin.on_border[static_cast<std::size_t>(id)] = true;
    Region region;
    if (!collinear) {
      twin.triangles += 2 * ids.size() - 2 - h;
      for (std::size_t k = 0; k < h; ++k)
        region.corners.push_back({hull[(k + h - 1) % h], hull[k], hull[(k + 1) % h]});
      const auto internal = [&](int id) { return !twin.on_border[static_cast<std::size_t>(id)]; };
      std::copy_if(ids.begin(), ids.end(), std::back_inserter(region.x_list), internal);
      std::copy_if(y_order.begin() + set_offsets[s], y_order.begin() + set_offsets[s + 1],
                   std::back_inserter(region.y_list), internal);
    }
    twin.regions.add(std::move(region));
    twin.hull.insert(twin.hull.end(), hull.begin(), hull.end());
    twin.hull_offsets.push_back(twin.hull.size());
  }
  return twin;
}

}  // namespace flaunay::testing
