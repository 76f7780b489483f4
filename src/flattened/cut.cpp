#include "flattened/stages.hpp"
#include "launchers/flattened/cut.cl.hpp"

namespace flaunay::flattened {

void cut(Workspace& work, const PointTable& table, Level& level, int depth, int alternate_axis) {
  Arena& scratch = work.scratch();
  level.axis = scratch.allocate<cl_int>(level.regions);
  level.cut = scratch.allocate<cl_double>(level.regions);
  level.first_end = scratch.allocate<cl_int>(level.regions);
  level.last_end = scratch.allocate<cl_int>(level.regions);
  work.runtime.map(level.regions, kernels::cut_regions{.alternate_axis = alternate_axis,
                                                       .level = depth,
                                                       .point_offsets = level.point_offsets,
                                                       .x_list = level.x_list,
                                                       .y_list = level.y_list,
                                                       .points = table.points,
                                                       .axis = level.axis,
                                                       .cut = level.cut,
                                                       .first_end = level.first_end,
                                                       .last_end = level.last_end,
                                                       .largest = work.largest});
  work.add_depth(Component::cut, alternate_axis < 0 ? 3 : 0);
  work.add_depth(Component::hull, log2_ceiling(level.corners));
  for (const cl_int direction : {1, -1}) {
    host::segmented_arg_reduce(
        work.runtime, level.corners,
        kernels::extreme_vertices{.segment = level.corner_regions,
                                  .result = direction > 0 ? level.first_end : level.last_end,
                                  .direction = direction,
                                  .corners = level.corner_ids,
                                  .axis = level.axis,
                                  .cut = level.cut,
                                  .points = table.points});
  }
}

}  // namespace flaunay::flattened
