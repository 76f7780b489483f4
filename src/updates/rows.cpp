#include "updates/rows.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "refinement/codes.h"
#include "updates/codes.h"

namespace flaunay::updates {
namespace {

using Ids = std::vector<std::int32_t>;

bool is_triangle(const kernel::mesh_row& row) {
  return row.corner[0] >= 0 && row.corner[1] >= 0 && row.corner[2] >= 0;
}

// The hull from its lexicographically smallest vertex on. A ghost has its edge between its other corners.
Ids hull_of(const std::vector<kernel::mesh_row>& rows, const std::vector<double>& coordinates) {
  const auto end_of = [](const kernel::mesh_row& row) {
    return static_cast<std::size_t>(std::find(row.corner, row.corner + 3, kernel::INFINITE_VERTEX) -
                                    row.corner);
  };
  const auto place = [&](std::int32_t v) {
    const double* const p = &coordinates[2 * static_cast<std::size_t>(v)];
    return std::pair(p[0], p[1]);
  };
  std::size_t first = rows.size();
  const auto from = [&](std::size_t t) { return rows[t].corner[(end_of(rows[t]) + 2) % 3]; };
  for (std::size_t t = 0; t < rows.size(); ++t) {
    if (rows[t].corner[0] == kernel::NO_TRIANGLE || is_triangle(rows[t])) continue;
    if (first == rows.size() || place(from(t)) < place(from(first))) first = t;
  }
  Ids hull;
  std::size_t at = first;
  do {
    hull.push_back(from(at));
    at = static_cast<std::size_t>(rows[at].neighbor[(end_of(rows[at]) + 2) % 3]);
  } while (at != first);
  return hull;
}

}  // namespace

TriangleRows rows_of(const std::vector<kernel::mesh_row>& rows) {
  TriangleRows result;
  result.triangles.assign(3 * rows.size(), -1);
  result.neighbors.assign(3 * rows.size(), -1);
  for (std::size_t t = 0; t < rows.size(); ++t) {
    if (!is_triangle(rows[t])) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t beyond = rows[t].neighbor[k];
      result.triangles[3 * t + k] = rows[t].corner[k];
      if (is_triangle(rows[static_cast<std::size_t>(beyond)])) result.neighbors[3 * t + k] = beyond;
    }
  }
  return result;
}

Triangulation triangles_of(const std::vector<kernel::mesh_row>& rows,
                           const std::vector<double>& coordinates) {
  Triangulation result;
  result.hull = hull_of(rows, coordinates);
  Ids triangle_of(rows.size(), -1);
  std::int32_t count = 0;
  for (std::size_t t = 0; t < rows.size(); ++t) {
    if (is_triangle(rows[t])) triangle_of[t] = count++;
  }
  result.triangles.resize(3 * static_cast<std::size_t>(count));
  result.neighbors.resize(result.triangles.size());
  for (std::size_t t = 0; t < rows.size(); ++t) {
    if (triangle_of[t] < 0) continue;
    const std::int32_t* const corner = rows[t].corner;
    const auto smallest = static_cast<std::size_t>(std::min_element(corner, corner + 3) - corner);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t to = 3 * static_cast<std::size_t>(triangle_of[t]) + k, at = (smallest + k) % 3;
      result.triangles[to] = corner[at];
      result.neighbors[to] = triangle_of[static_cast<std::size_t>(rows[t].neighbor[at])];
    }
  }
  return result;
}

}  // namespace flaunay::updates
