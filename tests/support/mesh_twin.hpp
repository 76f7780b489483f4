// The twin of the stage `mesh`: triangles and hulls from edge rings.
#pragma once

#include <CL/cl.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

#include "tests/support/divide_twin.hpp"

namespace flaunay::testing {

/// What is extracted from rings that pass RingCheck. A triangle belongs to its middle vertex along x; of the
/// two that a vertex may have, the one below it comes first.
struct MeshTwin {
  std::vector<std::int32_t> triangles, hull;
  std::vector<std::size_t> triangle_offsets{0}, hull_offsets{0};
  std::vector<bool> outside;  ///< per edge, whether its left side is outside
  std::size_t vertices = 0;

  explicit MeshTwin(const HostRings& g) : outside(g.edges.size()) {
    for (std::size_t s = 0; s < g.sets(); ++s) {
      const std::vector<cl_int> members = g.vertices_of(g.set_blocks[s], g.set_blocks[s + 1]);
      vertices += members.size();
      add_set(g, s, members);
      triangle_offsets.push_back(triangles.size() / 3);
      hull_offsets.push_back(hull.size());
    }
  }

 private:
  struct Row {
    cl_int middle;
    bool above;
    std::array<cl_int, 3> sources;
  };

  void add_set(const HostRings& g, std::size_t s, std::vector<cl_int> members) {
    if (members.empty()) return;
    std::sort(members.begin(), members.end(),
              [&](cl_int v, cl_int w) { return comes_first(g.point(v), g.point(w), 0); });
    std::vector<cl_int> around;
    const cl_int start = g.edge_of(members[0]);
    for (cl_int e = start; e != kNone && !outside[e ^ 1]; e = g.along_hull(e)) {
      outside[e ^ 1] = true;
      around.push_back(g.from(e));
    }
    std::vector<Row> rows;
    const auto first =
        static_cast<cl_int>(kEdgesPerPoint) * g.offsets[static_cast<std::size_t>(g.set_blocks[s])];
    const auto last =
        static_cast<cl_int>(kEdgesPerPoint) * g.offsets[static_cast<std::size_t>(g.set_blocks[s + 1])];
    for (cl_int e = first; e < last; ++e) {
      if (g.used(e) && !outside[e] && e < g.along_face(e) && e < g.along_face(g.along_face(e))) {
        rows.push_back(row_of(g, e));
      }
    }
    std::sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) {
      return std::tie(a.middle, a.above) < std::tie(b.middle, b.above);
    });
    for (const Row& row : rows) triangles.insert(triangles.end(), row.sources.begin(), row.sources.end());
    for (const cl_int v : rows.empty() ? members : around) {
      hull.push_back(g.source[static_cast<std::size_t>(v)]);
    }
  }

  /// Of the triangle left of e.
  static Row row_of(const HostRings& g, cl_int e) {
    std::array<cl_int, 3> corners{g.from(e), g.to(e), g.to(g.along_face(e))};
    std::array<cl_int, 3> by_x = corners;
    std::sort(by_x.begin(), by_x.end(),
              [&](cl_int v, cl_int w) { return comes_first(g.point(v), g.point(w), 0); });
    Row row;
    row.middle = by_x[1];
    // Counter-clockwise from the middle one on: the triangle is above it if the right one comes next.
    const auto middle = std::find(corners.begin(), corners.end(), row.middle);
    row.above = (middle + 1 == corners.end() ? corners.front() : middle[1]) == by_x[2];
    for (std::size_t k = 0; k < 3; ++k) row.sources[k] = g.source[static_cast<std::size_t>(corners[k])];
    std::rotate(row.sources.begin(), std::min_element(row.sources.begin(), row.sources.end()),
                row.sources.end());
    return row;
  }
};

}  // namespace flaunay::testing
