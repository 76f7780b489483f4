#include "flattened/stages.hpp"

namespace flaunay::flattened {

void cut(Workspace& work, const PointTable& table, Level& level, int depth, int alternate_axis) {
  Arena& scratch = work.scratch();
  level.axis = scratch.allocate<cl_int>(level.regions);
  level.cut = scratch.allocate<cl_double>(level.regions);
  level.first_end = scratch.allocate<cl_int>(level.regions);
  level.last_end = scratch.allocate<cl_int>(level.regions);
  work.runtime.map("cut", "cut_regions", level.regions, cl_int{alternate_axis}, cl_int{depth},
                   level.point_offsets, level.x_list, level.y_list, table.points, level.axis, level.cut,
                   level.first_end, level.last_end, work.largest);
  work.add_depth(Component::cut, alternate_axis < 0 ? 3 : 0);
  work.add_depth(Component::hull, log2_ceiling(level.corners));
  for (const cl_int direction : {1, -1}) {
    host::segmented_arg_reduce(work.runtime, "prune", "extreme_vertices", level.corner_regions, level.corners,
                               direction > 0 ? level.first_end : level.last_end, direction, level.corner_ids,
                               level.axis, level.cut, table.points);
  }
}

}  // namespace flaunay::flattened
