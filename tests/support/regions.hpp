// Regions as the twins of the flattened stages have them.
#pragma once

#include <algorithm>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

namespace flaunay::testing {

struct Corner {
  int before, vertex, after;
  bool operator==(const Corner& o) const {
    return before == o.before && vertex == o.vertex && after == o.after;
  }
  bool operator<(const Corner& o) const {
    return std::tie(vertex, before, after) < std::tie(o.vertex, o.before, o.after);
  }
};

/// Internal points in the order of x and of y, and corners, as a multiset: sorted.
struct Region {
  std::vector<int> x_list, y_list;
  std::vector<Corner> corners;
  bool operator==(const Region& o) const {
    return x_list == o.x_list && y_list == o.y_list && corners == o.corners;
  }
  /// Internal points and border vertices, each once.
  std::vector<int> points() const {
    std::set<int> all(x_list.begin(), x_list.end());
    for (const Corner& corner : corners) all.insert(corner.vertex);
    return {all.begin(), all.end()};
  }
};

/// The regions of a level and those that retire, in order.
struct Regions {
  std::vector<Region> open, retired;
  void add(Region region) {
    std::sort(region.corners.begin(), region.corners.end());
    if (!region.x_list.empty()) {
      open.push_back(std::move(region));
    } else if (!region.corners.empty()) {
      retired.push_back(std::move(region));
    }
  }
};

}  // namespace flaunay::testing
