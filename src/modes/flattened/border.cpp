#include <algorithm>

#include "launchers/flattened/border.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
using namespace statistics;

Borders initial_borders(Workspace& work, PointTable& table, Level& level, RetiredRegions& retired) {
  host::Runtime& runtime = work.runtime;
  Arena& scratch = work.scratch();
  const std::size_t n = table.count;
  const std::size_t sets = table.sets;
  Arena::Scope scope(scratch);

  // Two planar regions per set, for the lower and the upper hull; each has all points of the set.
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
  runtime.map(n, kernels::doubled_lists{.set_of_id = table.set_of_id,
                                        .offsets = table.set_offsets,
                                        .ids = planar.x_list,
                                        .regions = planar.point_regions});
  runtime.map(sets, kernels::set_ends{.offsets = table.set_offsets,
                                      .points = table.points,
                                      .axis = planar.axis,
                                      .cut = planar.cut,
                                      .first_end = planar.first_end,
                                      .last_end = planar.last_end});
  work.add_depth(Component::hull, log2_ceiling(n));
  runtime.map(sets, kernels::doubled_offsets{.offsets = table.set_offsets, .doubled = planar.point_offsets});
  LevelStatistics ignored;
  project(work, table, planar);
  const Paths paths = hulls(work, table, planar, ignored);

  const Pruned on{2 * n, scratch.allocate<cl_uchar>(2 * n), scratch.allocate<cl_int>(2 * n),
                  scratch.allocate<cl_double>(0)};
  prune(work, table, planar, paths, true, on);
  const auto counts = scratch.allocate<cl_uint>(2 * n + 1);
  host::count_flags(runtime, on.flags, 2 * n, 1, counts);
  host::exclusive_scan(runtime, counts, 2 * n, counts);

  const auto hull_sizes = scratch.allocate<cl_uint>(sets + 1);
  const auto collinear = scratch.allocate<cl_int>(sets);
  const auto child_points = scratch.allocate<cl_int>(sets);
  const auto child_corners = scratch.allocate<cl_int>(sets);
  runtime.map(sets, kernels::border_sizes{.offsets = table.set_offsets,
                                          .scanned = counts,
                                          .hull_size = hull_sizes,
                                          .collinear = collinear,
                                          .child_points = child_points,
                                          .child_corners = child_corners});
  host::exclusive_scan(runtime, hull_sizes, sets, hull_sizes);

  Borders borders;
  std::vector<cl_uint> offsets(sets + 1);
  std::vector<cl_int> flat(sets), ids(sets + 1);
  const host::Runtime::Settled settled(runtime);
  runtime.read_later(hull_sizes, 0, sets + 1, offsets.data());
  runtime.read_later(collinear, 0, sets, flat.data());
  runtime.read(table.set_offsets, 0, sets + 1, ids.data());
  borders.hull_offsets.assign(offsets.begin(), offsets.end());
  borders.size = offsets.back();
  for (std::size_t s = 0; s < sets; ++s) {
    const std::size_t count = static_cast<std::size_t>(ids[s + 1] - ids[s]);
    borders.largest_set = std::max(borders.largest_set, count);
    if (!flat[s]) borders.triangles += 2 * count - 2 - (offsets[s + 1] - offsets[s]);
  }

  borders.hull = work.persistent.allocate<cl_int>(borders.size);
  runtime.map(2 * n, kernels::border_write{.ids = planar.x_list,
                                           .regions = planar.point_regions,
                                           .offsets = table.set_offsets,
                                           .scanned = counts,
                                           .collinear = collinear,
                                           .hull_offsets = hull_sizes,
                                           .hull = borders.hull,
                                           .side = table.side});
  const Children children = place_sets(work, sets, child_points, child_corners, level, retired);
  runtime.map(borders.size, kernels::border_corners{.hull = borders.hull,
                                                    .hull_offsets = hull_sizes,
                                                    .set_of_id = table.set_of_id,
                                                    .collinear = collinear,
                                                    .children = children.list(level, retired)});

  // The lists of level 0: internal points in the order of ids, which is that of x, and in the order of y.
  for (const bool by_y : {false, true}) {
    Buffer<cl_int> list = table.y_order;
    if (!by_y) {
      list = scratch.allocate<cl_int>(n);
      runtime.map(n, kernels::all_ids{.ids = list});
    }
    first_list(work, table, list, children, by_y ? level.y_list : level.x_list, level.point_regions);
  }
  return borders;
}

}  // namespace flaunay::flattened
