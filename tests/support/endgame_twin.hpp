// What must hold of the triangles of regions without internal points.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/exact_points.hpp"
#include "tests/support/regions.hpp"

namespace flaunay::testing {

/// How many triangles a region without internal points has: k - 2 for each closed walk of k corners.
inline std::size_t triangle_count_twin(const std::vector<Corner>& corners) {
  std::map<std::pair<int, int>, std::size_t> corner_after;  // by directed edge (before, vertex)
  for (std::size_t c = 0; c < corners.size(); ++c) {
    if (!corner_after.emplace(std::make_pair(corners[c].before, corners[c].vertex), c).second) {
      throw std::logic_error("a border edge of two corners");
    }
  }
  std::size_t walks = 0;
  std::vector<bool> seen(corners.size(), false);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    walks += !seen[c];
    for (std::size_t at = c; !seen[at];) {
      seen[at] = true;
      at = corner_after.at({corners[at].vertex, corners[at].after});
    }
  }
  return corners.size() - 2 * walks;
}

/// Empty if the triangles (3 ids each) are a Delaunay triangulation of the region, else what is wrong with
/// them.
inline std::string region_fault(const ExactPoints& points, const std::vector<Corner>& corners,
                                const std::vector<int>& triangles) {
  if (triangles.size() != 3 * triangle_count_twin(corners)) return "wrong number of triangles";
  std::set<int> vertices;
  std::set<std::pair<int, int>> border;
  for (const Corner& corner : corners) {
    vertices.insert(corner.vertex);
    border.insert({corner.vertex, corner.after});
  }
  std::map<std::pair<int, int>, int> apex_of;  // by directed edge
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const int v[3] = {triangles[t], triangles[t + 1], triangles[t + 2]};
    const std::string name =
        " (" + std::to_string(v[0]) + " " + std::to_string(v[1]) + " " + std::to_string(v[2]) + ")";
    for (const int id : v) {
      if (vertices.count(id) == 0) return "a vertex that is none of the region's" + name;
    }
    if (points.orient(v[0], v[1], v[2]) <= 0) return "a triangle that is not counter-clockwise" + name;
    for (int j = 0; j < 3; ++j) {
      if (!apex_of.emplace(std::make_pair(v[j], v[(j + 1) % 3]), v[(j + 2) % 3]).second) {
        return "an edge of two triangles on one side" + name;
      }
    }
    // Beyond this size, edges suffice (below), and all circles cost too much.
    if (vertices.size() <= 200) {
      for (const int id : vertices) {
        if (points.in_circle(v[0], v[1], v[2], id) > 0) return "a circle that is not empty" + name;
      }
    }
  }
  for (const std::pair<int, int>& edge : border) {
    if (apex_of.count(edge) == 0) return "a border edge without a triangle";
  }
  for (const auto& [edge, apex] : apex_of) {
    const auto twin = apex_of.find({edge.second, edge.first});
    const bool is_border = border.count(edge) != 0;
    if (is_border == (twin != apex_of.end())) return is_border ? "a border edge inside" : "a hole";
    if (!is_border && points.in_circle(edge.first, edge.second, apex, twin->second) > 0) {
      return "an edge that is not Delaunay";
    }
  }
  return "";
}

}  // namespace flaunay::testing
