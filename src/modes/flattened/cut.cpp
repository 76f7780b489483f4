#include "launchers/flattened/cut.cl.hpp"
#include "modes/flattened/stages.hpp"

namespace flaunay::flattened {
using namespace statistics;

void cut(Workspace& work, const PointTable& table, Level& level, int depth, int alternate_axis) {
  Arena& scratch = work.scratch();
  level.axis = scratch.allocate<cl_int>(level.regions);
  level.cut = scratch.allocate<cl_double>(level.regions);
  level.first_end = scratch.allocate<cl_int>(level.regions);
  level.last_end = scratch.allocate<cl_int>(level.regions);
  work.runtime.map(level.regions, kernels::cut_regions{.alternate_axis = alternate_axis,
                                                       .level = depth,
                                                       .point_offsets = level.point_offsets,
                                                       .lists = level,
                                                       .points = table.points,
                                                       .axis = level.axis,
                                                       .cut = level.cut,
                                                       .largest = work.largest});
  if (level.is_small) return;
  work.add_depth(Component::cut, alternate_axis < 0 ? 3 : 0);
  work.add_depth(Component::hull, log2_ceiling(level.corners));
  const std::size_t group = region_group(work, level.corners / level.regions);
  work.runtime.note_elements(1 + level.corners / level.regions / group);
  work.runtime.launch(level.regions * group, group,
                      kernels::find_ends{.regions = level.regions,
                                         .corner_offsets = level.corner_offsets,
                                         .corners = level.corner_ids,
                                         .cuts = level.cuts(table),
                                         .first_end = level.first_end,
                                         .last_end = level.last_end});
}

}  // namespace flaunay::flattened
