#include "flattened/stages.hpp"

namespace flaunay::flattened {

Borders initial_borders(Workspace& work, PointTable& table, Level& level, RetiredRegions& retired) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  const std::size_t n = table.count;
  const std::size_t sets = table.sets;
  Arena::Scope scope(scratch);

  // Two planar regions a set, all of its points in each.
  Level planar;
  planar.regions = 2 * sets;
  planar.points = 2 * n;
  planar.x_list = scratch.allocate<cl_int>(2 * n);
  planar.y_list = planar.x_list;
  planar.point_regions = scratch.allocate<cl_int>(2 * n);
  planar.axis = scratch.allocate<cl_int>(2 * sets);
  planar.cut = scratch.allocate<cl_double>(2 * sets);
  planar.first_end = scratch.allocate<cl_int>(2 * sets);
  planar.last_end = scratch.allocate<cl_int>(2 * sets);
  planar.point_offsets = scratch.allocate<cl_int>(2 * sets + 1);
  planar.corner_offsets = scratch.allocate<cl_int>(2 * sets + 1);
  planar.corner_ids = scratch.allocate<cl_int>(0);
  planar.corner_regions = scratch.allocate<cl_int>(0);
  runtime.fill(planar.corner_offsets, 2 * sets + 1, cl_int{0});
  runtime.map("border", "doubled_lists", n, table.set_of_id, table.set_offsets, planar.x_list,
              planar.point_regions);
  runtime.map("border", "set_ends", sets, table.set_offsets, table.points, planar.axis, planar.cut,
              planar.first_end, planar.last_end);
  work.add_depth(Component::hull, log2_ceiling(n));
  runtime.map("border", "doubled_offsets", sets, table.set_offsets, planar.point_offsets);
  LevelStatistics ignored;
  project(work, table, planar);
  const Paths paths = hulls(work, table, planar, ignored);

  const Pruned on = allocate_pruned(work, planar);
  prune(work, table, planar, paths, true, on);
  const auto counts = scratch.allocate<cl_uint>(2 * n + 1);
  runtime.map("prune", "flag_counts", 2 * n, on.flags, counts);
  host::exclusive_scan(runtime, counts, 2 * n, counts);

  const auto hull_sizes = scratch.allocate<cl_uint>(sets + 1);
  const auto collinear = scratch.allocate<cl_int>(sets);
  const auto child_points = scratch.allocate<cl_int>(sets);
  const auto child_corners = scratch.allocate<cl_int>(sets);
  const auto sizes = scratch.allocate<cl_uint8>(sets + 1);
  runtime.map("border", "border_sizes", sets, table.set_offsets, counts, hull_sizes, collinear, child_points,
              child_corners);
  runtime.map("merge", "set_sizes", sets, child_points, child_corners, sizes);
  host::exclusive_scan(runtime, hull_sizes, sets, hull_sizes);

  Borders borders;
  std::vector<cl_uint> offsets(sets + 1);
  std::vector<cl_int> flat(sets), ids(sets + 1);
  runtime.read(hull_sizes, 0, sets + 1, offsets.data());
  runtime.read(collinear, 0, sets, flat.data());
  runtime.read(table.set_offsets, 0, sets + 1, ids.data());
  borders.hull_offsets.assign(offsets.begin(), offsets.end());
  borders.size = offsets.back();
  for (std::size_t s = 0; s < sets; ++s) {
    const std::size_t count = static_cast<std::size_t>(ids[s + 1] - ids[s]);
    if (!flat[s]) borders.triangles += 2 * count - 2 - (offsets[s + 1] - offsets[s]);
  }

  borders.hull = work.persistent.allocate<cl_int>(borders.size);
  runtime.map("border", "border_write", 2 * n, planar.x_list, planar.point_regions, table.set_offsets, counts,
              collinear, hull_sizes, borders.hull, table.side);
  const Children children = place_children(work, sizes, sets, level, retired);
  runtime.map("border", "border_corners", borders.size, borders.hull, hull_sizes, table.set_of_id, collinear,
              children.region, children.base, level.corner_ids, level.corner_regions, retired.corner_ids);

  // The lists of level 0: internal points in the order of ids, which is by x, and by y.
  for (const bool by_y : {false, true}) {
    Buffer<cl_int> list = table.y_order;
    if (!by_y) {
      list = scratch.allocate<cl_int>(n);
      runtime.map("border", "all_ids", n, list);
    }
    runtime.map("lists", "first_flags", n, list, table.side, counts);
    host::exclusive_scan(runtime, counts, n, counts);
    runtime.map("lists", "first_list", n, list, counts, table.set_of_id, children.region,
                by_y ? level.y_list : level.x_list, level.point_regions);
  }
  return borders;
}

}  // namespace flaunay::flattened
