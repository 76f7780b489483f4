// Partitions: the regions that are left after a few levels, for the host.
#include <algorithm>

#include "modes/flattened/levels.hpp"

namespace flaunay::flattened {
using namespace geometry;

PointSets to_host(Workspace& work, const PointTable& table,
                  const std::vector<std::int32_t>& representatives) {
  PointSets sets;
  sets.points.resize(table.count);
  static_assert(sizeof(Point) == sizeof(cl_double2));
  work.runtime.read(table.points, 0, table.count, reinterpret_cast<cl_double2*>(sets.points.data()));
  sets.source = read_all(work, table.source, table.count);
  sets.set_offsets = read_all(work, table.set_offsets, table.sets + 1);
  sets.representatives = representatives;
  sets.predicates.bounds = work.bounds;
  return sets;
}

std::vector<research::Region> to_input(Workspace& work, const PointTable& table,
                                       const RegionArrays& regions) {
  const std::vector<cl_int> source = read_all(work, table.source, table.count);
  std::vector<research::Region> result(regions.size());
  // The position of each border id in the points of the current region.
  std::vector<std::int32_t> position(table.count, -1);
  for (std::size_t r = 0; r < result.size(); ++r) {
    research::Region& region = result[r];
    for (std::int32_t i = regions.point_offsets[r]; i < regions.point_offsets[r + 1]; ++i) {
      region.points.push_back(source[regions.points[i]]);
    }
    const auto first = regions.corners.begin() + 3 * regions.corner_offsets[r];
    const auto last = regions.corners.begin() + 3 * regions.corner_offsets[r + 1];
    std::vector<std::int32_t> vertices;
    for (auto corner = first; corner != last; corner += 3) vertices.push_back(corner[1]);
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const std::int32_t id : vertices) {
      position[id] = static_cast<std::int32_t>(region.points.size());
      region.points.push_back(source[id]);
    }
    for (auto corner = first; corner != last; corner += 3) {
      region.border.push_back(position[corner[1]]);
      region.border.push_back(position[corner[2]]);
    }
  }
  return result;
}

}  // namespace flaunay::flattened
